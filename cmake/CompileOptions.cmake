# Options of every target of this project. They do not apply to users of the installed library.
add_library(supple_compile_options INTERFACE)
target_compile_features(supple_compile_options INTERFACE cxx_std_20)
target_compile_options(supple_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  # Results must be equal on all machines, so the compiler must not fuse multiplications and additions.
  -ffp-contract=off
  # From -O2 on, g++ 12 turns two neighbouring conversions of double to float and back into copies of the doubles.
  # Volumes are computed from numbers as rounded to float, so they would not enclose their vertices.
  $<$<CXX_COMPILER_ID:GNU>:-fno-tree-slp-vectorize>)
if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
  # Kernels are compiled once per instruction set. SSSE3 is left out to save time: processors since 2008 have
  # SSE4, and older ones run portable code. Sanitized builds have SSE4 and AVX2.
  set(disabled_targets HWY_SSSE3)
  if(SUPPLE_SANITIZE)
    set(disabled_targets "(HWY_AVX3|HWY_AVX3_DL)")
  endif()
  target_compile_definitions(supple_compile_options INTERFACE "HWY_DISABLED_TARGETS=${disabled_targets}")
  # Without this definition, Highway 1.0.3 refuses compilers that may use all of AVX-512, as -march=native
  # allows on recent processors.
  include(CheckCXXSourceCompiles)
  check_cxx_source_compiles("#include <hwy/detect_targets.h>\nint main() {}" supple_highway_accepts_flags)
  if(NOT supple_highway_accepts_flags)
    target_compile_definitions(supple_compile_options INTERFACE HWY_WANT_AVX3_DL)
  endif()
else()
  # Kernels store vectors in structures, which SVE and RVV do not allow.
  target_compile_definitions(supple_compile_options INTERFACE
    "HWY_DISABLED_TARGETS=(HWY_SVE|HWY_SVE2|HWY_SVE_256|HWY_SVE2_128|HWY_RVV)")
  if(CMAKE_SYSTEM_PROCESSOR STREQUAL "wasm32")
    # Highway 1.0 has no vectors of doubles for WebAssembly. Its portable vectors take three times as long to
    # compile as scalar kernels, and are slower there.
    target_compile_definitions(supple_compile_options INTERFACE HWY_COMPILE_ONLY_SCALAR)
  endif()
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "aarch64|arm64")
    # All these processors have NEON. This definition switches off the choice of instructions at run time.
    target_compile_definitions(supple_compile_options INTERFACE TOOLCHAIN_MISS_SYS_AUXV_H)
  endif()
endif()
if(SUPPLE_WARNINGS_AS_ERRORS)
  target_compile_options(supple_compile_options INTERFACE -Werror)
endif()
if(SUPPLE_SANITIZE)
  # These options also apply to targets that link the library: a sanitizer needs them in the whole program.
  add_compile_definitions(SUPPLE_SANITIZED)
  add_compile_options(-fsanitize=${SUPPLE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SUPPLE_SANITIZE})
  if(CMAKE_CXX_COMPILER_ID MATCHES "Clang")
    add_compile_options(-fsanitize-ignorelist=${CMAKE_CURRENT_LIST_DIR}/SanitizerIgnoreList.txt)
    if(SUPPLE_SANITIZE MATCHES "undefined")
      # They take up to a quarter of the time to compile, and the address sanitizer finds most of what they find.
      add_compile_options(-fno-sanitize=null,object-size,vptr)
    endif()
    if(SUPPLE_LIBFUZZER)
      # libFuzzer follows which branches an input reaches.
      add_compile_options(-fsanitize=fuzzer-no-link)
    endif()
  endif()
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    # SSE4 is the least instruction set then: clang needs minutes for the portable kernels with sanitizers.
    add_compile_options(-march=x86-64-v2 -maes -mpclmul)
  endif()
endif()

if(SUPPLE_COVERAGE)
  add_compile_options(-fprofile-instr-generate -fcoverage-mapping)
  add_link_options(-fprofile-instr-generate)
  # Each kernel is counted once, so it must be compiled for one instruction set only.
  add_compile_definitions(HWY_COMPILE_ONLY_STATIC)
  if(CMAKE_SYSTEM_PROCESSOR MATCHES "x86_64|AMD64")
    add_compile_options(-march=x86-64-v3 -maes -mpclmul)
  endif()
endif()

cmake_path(SET supple_core_header NORMALIZE ${CMAKE_CURRENT_LIST_DIR}/../include/supple/supple.hpp)
# Makes the sources of a target compile in less time, and does nothing in the debug preset, which finds sources
# that miss an include.
#
# The headers that most sources include compile once instead of once for each source. A compiler cache does not
# store the results of such compilations, so builds with a cache do without. Up to twelve sources of a folder
# compile together. Highway's sources compile alone, because each includes itself once for each instruction set.
#
#   supple_compile_together(TARGET HEADER...)                with its own precompiled headers
#   supple_compile_together(TARGET REUSE_FROM OTHER_TARGET)  with those of a target with the same options
function(supple_compile_together target)
  if(CMAKE_DISABLE_PRECOMPILE_HEADERS)
    return()
  endif()
  cmake_parse_arguments(PARSE_ARGV 1 given "" REUSE_FROM "")
  if(given_REUSE_FROM AND NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} REUSE_FROM ${given_REUSE_FROM})
  elseif(NOT CMAKE_CXX_COMPILER_LAUNCHER)
    target_precompile_headers(${target} PRIVATE <algorithm> <array> <atomic> <bit> <cmath> <cstdint> <filesystem>
      <functional> <limits> <map> <memory> <optional> <set> <span> <sstream> <string> <tuple> <utility> <variant>
      <vector> ${supple_core_header} ${ARGN})
  endif()
  get_target_property(sources ${target} SOURCES)
  foreach(source IN LISTS sources)
    cmake_path(ABSOLUTE_PATH source OUTPUT_VARIABLE path)
    if(NOT path MATCHES "[.]cpp$" OR NOT EXISTS ${path})
      continue()
    endif()
    file(STRINGS ${path} includes_itself REGEX "hwy/foreach_target" LIMIT_COUNT 1)
    if(includes_itself)
      continue()
    endif()
    cmake_path(GET path PARENT_PATH folder)
    cmake_path(RELATIVE_PATH folder BASE_DIRECTORY ${CMAKE_CURRENT_FUNCTION_LIST_DIR}/..)
    string(MAKE_C_IDENTIFIER "${folder}" folder)
    math(EXPR group "${count_${folder}} + 0")
    math(EXPR count_${folder} "${group} + 1")
    math(EXPR group "${group} / 12")
    set_property(SOURCE ${source} PROPERTY UNITY_GROUP ${folder}_${group})
  endforeach()
  set_target_properties(${target} PROPERTIES UNITY_BUILD ON UNITY_BUILD_MODE GROUP)
  if(CMAKE_CXX_COMPILER_ID STREQUAL "GNU")
    # It warns of classes with members from unnamed namespaces in all sources but the first one.
    target_compile_options(${target} PRIVATE -Wno-subobject-linkage)
  endif()
endfunction()
