#!/usr/bin/env bash
# Builds the compiled module of the Python package in build/BUILD (default: release) and runs the tests of the
# package there, with the Python packages of bindings/python/tests/requirements.txt in a virtual environment.
# Further arguments go to pytest: tools/test_python.sh release -k hypothesis. SUPPLE_TEST_TORCH=1 installs
# PyTorch, without which its tests are skipped.
set -euo pipefail
cd "$(dirname "$0")/.."
build=${1:-release}
[ $# -eq 0 ] || shift

environment=build/python/environment
requirements=bindings/python/tests/requirements.txt
if ! cmp -s "$requirements" "$environment/requirements.txt"; then
  "${PYTHON:-python3}" -m venv --clear "$environment"
  "$environment/bin/pip" install --quiet --disable-pip-version-check -r "$requirements"
  cp "$requirements" "$environment"
fi
# The tests of supple.torch, whose package has gigabytes.
[ -z "${SUPPLE_TEST_TORCH:-}" ] || "$environment/bin/pip" install --quiet --disable-pip-version-check torch
cmake --preset "$build" -DSUPPLE_BUILD_PYTHON=ON "-DPython_EXECUTABLE=$PWD/$environment/bin/python" >/dev/null
cmake --build --preset "$build" -j "$(nproc)" --target supple_python
export PYTHONPATH=$PWD/build/$build/python SUPPLE_PROGRAM=${SUPPLE_PROGRAM:-$PWD/build/release/bin/supple}
# A sanitizer must be loaded before Python; leaks of the interpreter are not ours.
export LD_PRELOAD=${LD_PRELOAD_FOR_TESTS:-} ASAN_OPTIONS=detect_leaks=0
exec "$environment/bin/python" -m pytest -q "$@"
