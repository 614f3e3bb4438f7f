#!/usr/bin/env bash
# Writes docs/cli.md, the tables of options, records and statistics in other documents (between lines
# `<!-- begin NAME -->` and `<!-- end NAME -->`), and for the page the sections of the viewer's messages and the
# members of view files, from the program's own definitions.
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

fresh=$(mktemp -d) tables=$(mktemp)
trap 'rm -rf "$fresh" "$tables"' EXIT
mkdir -p "$fresh/docs" "$fresh/viewer/page/src/protocol"
"$program" --generate markdown >"$fresh/docs/cli.md"
"$program" --generate sections >"$fresh/viewer/page/src/protocol/sections.ts"
"$program" --generate view-members >"$fresh/viewer/page/src/protocol/view_members.ts"
"$program" --generate tables >"$tables"
# Prints a document with the lines of each table replaced by the new ones.
fill='
  FILENAME == tables { if ($1 == "<!--" && $2 == "begin") name = $3; table[name] = table[name] $0 "\n"; next }
  $1 == "<!--" && $2 == "begin" {
    if (!($3 in table)) { print FILENAME ": there is no table " $3 > "/dev/stderr"; exit 1 }
    printf "%s", table[$3]; inside = 1
  }
  !inside { print }
  $1 == "<!--" && $2 == "end" { inside = 0 }
'
for document in $(grep -ls '^<!-- begin ' docs/*.md viewer/*.md); do
  awk -v tables="$tables" "$fill" "$tables" "$document" >"$fresh/$document"
done
for document in $(cd "$fresh" && find . -type f | sort | cut -c3-); do
  if ! $check; then
    cp "$fresh/$document" "$document"
  elif ! diff -u "$document" "$fresh/$document" >&2; then
    echo "$document: differs from the program's definitions; run: make docs" >&2
    exit 1
  fi
done
