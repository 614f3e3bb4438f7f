#!/usr/bin/env bash
# Compiles the kernels once per instruction set, with all warnings as errors, and runs them on the difficult
# scenes: scalar, SSE4, AVX2 and AVX-512 natively, NEON under qemu, WebAssembly under node. All must give the
# results in tests/support/golden_scenes.hpp. A target without a compiler on this machine is skipped with a
# message; tools/install_dependencies.sh --instruction-sets installs all of them on Debian 12.
#
#   tools/check_instruction_sets.sh [x86_64] [aarch64] [wasm32]    all when none is named
set -euo pipefail
cd "$(dirname "$0")/.."
jobs=${JOBS:-$(nproc)}
chosen=" ${*:-x86_64 aarch64 wasm32} "

# check MACHINE "TOOLS" "SETS" "RUNNER" CMAKE-OPTION...
check() {
  local machine=$1 tools=$2 sets=$3 runner=$4 folder=build/instruction_sets/$1 tool set status
  shift 4
  [[ $chosen == *" $machine "* ]] || return 0
  for tool in $tools; do
    command -v "$tool" >/dev/null || { echo "$machine: skipped, for there is no $tool"; return; }
  done
  # Low optimisation for the exact arithmetic: compile time matters more here.
  cmake -G Ninja -S tests/instruction_sets -B "$folder" -DCMAKE_BUILD_TYPE=Release -DCMAKE_CXX_FLAGS_RELEASE=-O1 \
    -DCMAKE_SYSTEM_PROCESSOR="$machine" "$@" >"$folder.log" 2>&1 || { cat "$folder.log"; return 1; }
  cmake --build "$folder" -j "$jobs" >"$folder.log" 2>&1 || { cat "$folder.log"; return 1; }
  for set in $sets; do
    status=0
    $runner "$folder/$set" || status=$?
    [ $status -eq 0 ] || [ $status -eq 77 ] || return 1
  done
}

mkdir -p build/instruction_sets
if [ "$(uname -m)" = x86_64 ]; then
  check x86_64 "" "scalar sse4 avx2 avx512" ""
fi
check aarch64 "aarch64-linux-gnu-g++ qemu-aarch64" neon "qemu-aarch64 -L /usr/aarch64-linux-gnu" \
  -DCMAKE_SYSTEM_NAME=Linux -DCMAKE_CXX_COMPILER=aarch64-linux-gnu-g++
# Older versions of Boost use a class that libc++ has removed, unless this macro is set.
check wasm32 "clang++-19 wasm-ld-19 node" simd128 "node --no-warnings tests/instruction_sets/run_wasm.mjs" \
  -DCMAKE_SYSTEM_NAME=Generic -DCMAKE_CXX_COMPILER=clang++-19 -DCMAKE_CXX_COMPILER_TARGET=wasm32-wasi \
  -DCMAKE_CXX_FLAGS="-fignore-exceptions -DBOOST_NO_CXX98_FUNCTION_BASE" \
  -DCMAKE_EXE_LINKER_FLAGS=-Wl,-z,stack-size=8388608
