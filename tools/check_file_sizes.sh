#!/usr/bin/env bash
# Fails when git tracks a file of more than 300 kB (300,000 bytes) that is not an image of the documents.
# Large files stay in the history of a repository for ever, also after they are deleted.
set -euo pipefail
cd "$(git rev-parse --show-toplevel)"

# A file that is deleted but not yet committed makes find fail; it is not large.
large=$(git ls-files -z -- ':!docs/images/*.png' ':!docs/images/*.svg' ':!docs/images/*.webp' |
  xargs -0 -r sh -c 'find "$@" -maxdepth 0 -type f -size +300000c -printf "%p: %s bytes; tracked files have at most 300000, except docs/images; compress it or generate it\n" 2>/dev/null || true' -)
if [ -n "$large" ]; then
  echo "$large" >&2
  exit 1
fi
