#!/usr/bin/env bash
# Writes docs/cli.md, the tables of options, records and statistics in other documents, and for the page the
# sections of the viewer's messages and the members of view files, from the program's own definitions.
#
# usage: generate_docs.sh [--check] PROGRAM
#
# With --check it writes nothing and fails when a document is out of date.
set -euo pipefail
check=false
if [ "${1:-}" = "--check" ]; then
  check=true
  shift
fi
program=$(realpath "$1")
cd "$(dirname "$0")/.."

fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
"$program" --describe | tools/make_documents.py "$fresh"
for document in $(cd "$fresh" && find . -type f | sort | cut -c3-); do
  if ! $check; then
    cp "$fresh/$document" "$document"
  elif ! diff -u "$document" "$fresh/$document" >&2; then
    echo "$document: differs from the program's definitions; run: make docs" >&2
    exit 1
  fi
done
