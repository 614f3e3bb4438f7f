# Options of every target of this project; none of them reaches a user of the installed library.
add_library(supple_compile_options INTERFACE)
target_compile_features(supple_compile_options INTERFACE cxx_std_20)
target_compile_options(supple_compile_options INTERFACE
  -Wall -Wextra -Wpedantic -Wshadow -Wconversion -Wno-sign-conversion -Wnon-virtual-dtor
  # One result on every machine: no multiply-add that the source does not spell out.
  -ffp-contract=off)
if(SUPPLE_WARNINGS_AS_ERRORS)
  target_compile_options(supple_compile_options INTERFACE -Werror)
endif()
if(SUPPLE_SANITIZE)
  # Reaches the targets that link the library as well: a sanitizer works only when all of a program has it.
  add_compile_options(-fsanitize=${SUPPLE_SANITIZE} -fno-omit-frame-pointer -fno-sanitize-recover=all)
  add_link_options(-fsanitize=${SUPPLE_SANITIZE})
endif()
