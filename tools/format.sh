#!/usr/bin/env bash
# Formats every C++ file of the repository in place. With --check it only lists files that differ, and fails.
set -euo pipefail
cd "$(dirname "$0")/.."

mode=(-i)
[ "${1:-}" = "--check" ] && mode=(--dry-run --Werror)
find include src libs models simulation distributed bindings cli experiments formats recording viewer examples benchmarks tests fuzz -name node_modules -prune -o -name '*.?pp' -print0 2>/dev/null |
  xargs -0 "${CLANG_FORMAT:-clang-format-14}" "${mode[@]}"
