#!/usr/bin/env bash
# Brings the sources of ufbx, which reads FBX files, to build/ufbx. The crate `ufbx` of crates.io contains them;
# cargo downloads it. Without cargo or without a network, prints a note and succeeds: the build then reads FBX
# through Assimp, unless CMake gets the sources by SUPPLE_UFBX_DIR. Returns at once when they are there.
set -euo pipefail
cd "$(dirname "$0")/.."

version=0.11.5
folder=build/ufbx
checksums="4a956c26a708e40d82ecb0aeaee54da709d5ba7c144c9642174970059bda7e1d  ufbx.c
f787be529af577efc04f3e3e735844a08556718dbb613d1211c2b313d72895dc  ufbx.h"

is_complete() { (cd "$1" 2>/dev/null && sha256sum --check --quiet - <<<"$checksums" >/dev/null 2>&1); }
if is_complete "$folder"; then exit 0; fi

give_up() {
  echo "get_ufbx: note: $1; FBX files are read through Assimp, which reads many animations wrongly. docs/formats.md says how to get ufbx" >&2
  exit 0
}
command -v cargo >/dev/null || give_up "there is no cargo, which downloads the sources of ufbx"

work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
mkdir -p "$work/src" "$work/cc/src"
touch "$work/src/lib.rs" "$work/cc/src/lib.rs"
# Nothing of the crate is built, so an empty package takes the place of the one that would build it.
printf '[package]\nname = "cc"\nversion = "1.99.0"\n' >"$work/cc/Cargo.toml"
printf '[package]\nname = "get-ufbx"\nversion = "0.0.0"\n[dependencies]\nufbx = "=%s"\n[patch.crates-io]\ncc = { path = "cc" }\n' \
  "$version" >"$work/Cargo.toml"
# Cargo before 1.68 would load the index of all packages.
options=()
case "$(cargo --version)" in
  "cargo 1.6"[0-7].* | "cargo 0."*) export RUSTC_BOOTSTRAP=1; options=(-Z sparse-registry) ;;
esac
(cd "$work" && timeout 300 cargo "${options[@]}" vendor --quiet vendor >/dev/null 2>errors) ||
  give_up "cargo cannot download ufbx ($(tail -n 1 "$work/errors"))"
is_complete "$work/vendor/ufbx/ufbx" || give_up "the downloaded sources of ufbx have other checksums"
mkdir -p "$folder"
cp "$work"/vendor/ufbx/ufbx/ufbx.[ch] "$folder/"
