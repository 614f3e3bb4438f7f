#!/usr/bin/env bash
# Installs the Debian 12 packages for a build, the tests and the demo. --ci adds the packages of the checks,
# clang and the sanitizers; --bench adds the libraries that benchmarks compare with; --coverage adds what
# tools/coverage.py needs; --determinism adds the compilers and emulators of tools/check_determinism.py;
# --python adds what builds and tests the Python package; --without-viewer leaves out npm and the compiler for
# WebAssembly.
# Returns quickly when everything is installed. At the end, tools/get_ufbx.sh brings the sources of ufbx.
set -euo pipefail
folder=$(cd "$(dirname "$0")" && pwd)
trap '"$folder"/get_ufbx.sh' EXIT

packages=(
  cmake ninja-build g++ python3
  libtbb-dev libhwy-dev libboost-dev libeigen3-dev
  libassimp-dev zlib1g-dev  # Debian's Assimp names zlib's file for linking, but does not depend on it
  libmeshoptimizer-dev libdraco-dev libzip-dev libpugixml-dev
  libhdf5-dev
  libcli11-dev libtomlplusplus-dev rapidjson-dev libfmt-dev
  python3-matplotlib  # draws the plots of experiments and benchmarks
  python3-scipy       # intervals of experiments
  libgtest-dev nlohmann-json3-dev libssl-dev libbenchmark-dev
)
if [ "${1:-}" != "--without-viewer" ]; then
  packages+=(clang-19 lld-19 wasi-libc libc++-19-dev-wasm32 libc++abi-19-dev-wasm32 libclang-rt-19-dev-wasm32)
  # Node.js from another source has its own npm, which conflicts with Debian's.
  command -v npm >/dev/null || packages+=(nodejs npm)
fi
if [ "${1:-}" = "--ci" ]; then
  packages+=(git libclang-rt-19-dev clang-format python3-clang-19 python3-h5py python3-jinja2 chromium chromium-headless-shell firefox-esr xvfb xauth libgl1-mesa-dri libpci3 libopenmpi-dev libtrilinos-zoltan-dev)
fi
if [ "${1:-}" = "--ci" ] || [ "${1:-}" = "--python" ]; then
  packages+=(python3-venv python3-dev openmpi-bin)
fi
if [ "${1:-}" = "--bench" ]; then
  packages+=(git pkg-config libembree-dev libcgal-dev libfcl-dev libbullet-dev libode-dev)
fi

if [ "${1:-}" = "--coverage" ]; then
  packages+=(llvm-19 python3-h5py)
fi
if [ "${1:-}" = "--determinism" ]; then
  packages+=(g++-aarch64-linux-gnu g++-riscv64-linux-gnu qemu-user clang-14 libc++-19-dev libc++abi-19-dev)
fi

# It downloads ufbx, which reads FBX files.
command -v cargo >/dev/null || [ -f "$folder/../build/ufbx/ufbx.c" ] || packages+=(cargo)

if ! command -v dpkg-query >/dev/null; then
  echo "install_dependencies: not a Debian system; if the build misses something, install your system's equivalents of: ${packages[*]}" >&2
  exit 0
fi

missing=()
for package in "${packages[@]}"; do
  dpkg -s "$package" 2>/dev/null | grep -q '^Status: install ok installed$' || missing+=("$package")
done
[ ${#missing[@]} -gt 0 ] || exit 0

as_root=()
if [ "$(id -u)" -ne 0 ]; then
  command -v sudo >/dev/null && as_root=(sudo)
fi
if ! command -v apt-get >/dev/null || { [ "$(id -u)" -ne 0 ] && [ ${#as_root[@]} -eq 0 ]; }; then
  echo "install_dependencies: neither root nor sudo; ask an administrator to run: apt-get install ${missing[*]}" >&2
  exit 1
fi

echo "Installing: ${missing[*]}"
"${as_root[@]}" apt-get update -qq
"${as_root[@]}" env DEBIAN_FRONTEND=noninteractive apt-get install -y -qq --no-install-recommends "${missing[@]}"
