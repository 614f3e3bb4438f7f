#!/usr/bin/env bash
# Writes docs/supple.1, docs/cli.md, the tables of options, records and statistics in other documents (between
# lines `<!-- begin NAME -->` and `<!-- end NAME -->`), and for the page the sections of the viewer's messages and
# the members of view files, from the program's own definitions.
#
# usage: generate_docs.sh [--check] PROGRAM
#
# With --check it writes nothing and fails when a document is out of date.
set -euo pipefail
root="$(cd "$(dirname "$0")/.." && pwd)"
docs=$root/docs

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
"$program" --generate tables >"$fresh/tables"
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
for document in $(grep -l '^<!-- begin ' "$docs"/*.md | xargs -r -n1 basename); do
  awk -v tables="$fresh/tables" "$fill" "$fresh/tables" "$docs/$document" >"$fresh/$document"
done
rm "$fresh/tables"
"$program" --generate sections >"$fresh/sections.ts"
"$program" --generate view-members >"$fresh/view_members.ts"
for document in $(ls "$fresh"); do
  place=docs/$document
  case $document in *.ts) place=viewer/page/src/protocol/$document ;; esac
  if ! $check; then
    cp "$fresh/$document" "$root/$place"
  elif ! diff -u "$root/$place" "$fresh/$document" >&2; then
    echo "$place: differs from the program's definitions; run: make docs" >&2
    exit 1
  fi
done
