# Options of every target of this project; none of them reaches a user of the installed library.
add_library(supple_compile_options INTERFACE)
target_compile_features(supple_compile_options INTERFACE cxx_std_20)
target_compile_options(supple_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  # One result on every machine: no multiply-add that the source does not spell out.
  -ffp-contract=off)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # Each instruction set compiles the kernels once more. Processors since 2008 have SSE4, and older ones run portable code.
  target_compile_definitions(supple_compile_options INTERFACE HWY_DISABLED_TARGETS=HWY_SSSE3)
  # Without this definition, Highway 1.0.3 refuses compilers that may use all of AVX-512, as -march=native
  # allows on recent processors.
  include(CheckCXXSourceCompiles)
  check_cxx_source_compiles("#include <hwy/detect_targets.h>\nint main() {}" supple_highway_accepts_flags)
  if(NOT supple_highway_accepts_flags)
    target_compile_definitions(supple_compile_options INTERFACE HWY_WANT_AVX3_DL)
  endif()
else()
  # Kernels keep vectors in structures, which SVE's and RVV's cannot be in. Highway 1.0 has no vectors of doubles for
  # WebAssembly: there its portable ones are taken, which the compiler turns into the same instructions.
  target_compile_definitions(supple_compile_options INTERFACE
    "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV|HWY_WASM|HWY_WASM_EMU256)")
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
    # All of these have NEON: nothing is left to be chosen at run time, which this name switches off.
    target_compile_definitions(supple_compile_options INTERFACE TOOLCHAIN_MISS_SYS_AUXV_H)
  endif()
endif()
if(SUPPLE_WARNINGS_AS_ERRORS)
  target_compile_options(supple_compile_options INTERFACE -Werror)
endif()
if(SUPPLE_SANITIZE)
  # Reaches the targets that link the library as well: a sanitizer works only when all of a program has it.
  add_compile_options(-fsanitize=${SUPPLE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SUPPLE_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    add_compile_options(-fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/SanitizerIgnoreList.txt)
  endif()
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    # Kernels for SSE4, AVX2 and AVX-512 alone: clang takes minutes to compile the portable ones with sanitizers.
    add_compile_options(-march=x86-64-v2 -maes -mpclmul)
  endif()
endif()

# Compiles the headers that most sources of a target include once instead of once for each source. A compiler
# cache does not store the results of such compilations, so builds with a cache do not use it. The debug preset
# does not use it either, which finds sources that miss an include. With the thread sanitizer and precompiled
# headers, GCC 12 gives false warnings about strings.
function(supple_precompile_headers target)
  if(NOT CMAKE_CXX_COMPILER_LAUNCHER AND NOT SUPPLE_SANITIZE MATCHES "thread")
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <cmath> <cstdint> <filesystem> <functional> <limits>
      <map> <memory> <optional> <span> <string> <utility> <vector> ${ARGN})
  endif()
endfunction()
