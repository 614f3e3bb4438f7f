# Adds a test to CTest for each suite of a GoogleTest program, because a process for each of 3,000 tests takes
# longer than most of them. Tests that match the patterns WITHOUT or the regular expression LEFT_OUT are not in
# it. Writes the file OUTPUT, which CTest includes.
#
#   cmake -DPROGRAM=program -DWITHOUT=a:b -DLEFT_OUT=regex -DOUTPUT=file -P discover_suites.cmake
execute_process(COMMAND ${PROGRAM} --gtest_list_tests --gtest_filter=-${WITHOUT}
  OUTPUT_VARIABLE listed COMMAND_ERROR_IS_FATAL ANY)
string(REGEX REPLACE " *#[^\n]*" "" listed "${listed}")
string(REPLACE "\n" ";" listed "${listed}")

set(suites "")
foreach(line IN LISTS listed)
  if(line MATCHES "^([^ ]+[.])$")
    set(suite "${CMAKE_MATCH_1}")
    list(APPEND suites "${suite}")
    set(runs_${suite} 0)
    set(without_${suite} "")
  elseif(line MATCHES "^  ([^ ]+)$")
    set(test "${suite}${CMAKE_MATCH_1}")
    if(NOT LEFT_OUT STREQUAL "" AND test MATCHES "${LEFT_OUT}")
      string(APPEND without_${suite} ":${test}")
    else()
      math(EXPR runs_${suite} "${runs_${suite}} + 1")
    endif()
  endif()
endforeach()

set(tests "")
foreach(suite IN LISTS suites)
  if(runs_${suite} GREATER 0)
    string(REGEX REPLACE "[.]$" "" name "${suite}")
    string(APPEND tests "add_test([==[${name}]==] [==[${PROGRAM}]==] [==[--gtest_filter=${suite}*-${WITHOUT}${without_${suite}}]==])\n"
      "set_tests_properties([==[${name}]==] PROPERTIES SKIP_RETURN_CODE 77)\n")
  endif()
endforeach()
file(WRITE ${OUTPUT} "${tests}")
