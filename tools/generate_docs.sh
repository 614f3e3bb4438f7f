#!/usr/bin/env bash
# Generates docs/supple.1 and docs/cli.md from the option definitions of the program.
#
# usage: generate_docs.sh [--check] PROGRAM
#
# With --check it writes nothing and fails when a document is out of date.
set -euo pipefail
docs="$(cd "$(dirname "$0")/.." && pwd)/docs"

check=false
if [ "${1:-}" = "--check" ]; then
  check=true
  shift
fi
program=$1

fresh=$(mktemp -d)
trap 'rm -rf "$fresh"' EXIT
"$program" --generate man >"$fresh/supple.1"
"$program" --generate markdown >"$fresh/cli.md"
for document in supple.1 cli.md; do
  if ! $check; then
    cp "$fresh/$document" "$docs/$document"
  elif ! diff -u "$docs/$document" "$fresh/$document" >&2; then
    echo "docs/$document: differs from the program's options; run: make docs" >&2
    exit 1
  fi
done
