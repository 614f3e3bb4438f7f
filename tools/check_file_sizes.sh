#!/usr/bin/env bash
# Fails when git tracks a file of more than 300 kB (300,000 bytes) that is not an image of the documents.
# Large files stay in the history of a repository for ever, also after they are deleted.
set -euo pipefail
cd "$(git rev-parse --show-toplevel)"

limit=300000
status=0
while IFS= read -r -d '' file; do
  [ -f "$file" ] && [ ! -L "$file" ] || continue
  size=$(wc -c <"$file")
  if [ "$size" -gt "$limit" ]; then
    echo "$file: $size bytes; tracked files have at most $limit, except docs/images; compress it or generate it" >&2
    status=1
  fi
done < <(git ls-files -z -- ':!docs/images/*.png' ':!docs/images/*.svg' ':!docs/images/*.webp')
exit $status
