# Writes a source with the commit of the folder SOURCE to OUTPUT, unless it has this content already.
execute_process(COMMAND git describe --always --dirty --exclude=* WORKING_DIRECTORY ${SOURCE}
  OUTPUT_VARIABLE commit OUTPUT_STRIP_TRAILING_WHITESPACE ERROR_QUIET)
if(NOT commit)
  set(commit unknown)
endif()
file(CONFIGURE OUTPUT ${OUTPUT} @ONLY CONTENT [[
#include "results.hpp"

const char* supple::experiments::commit() {
  return "@commit@";
}
]])
