# Installs the packages of FOLDER/package-lock.json with NPM, unless they are already installed.
set(installed ${FOLDER}/node_modules/.package-lock.json)
if(EXISTS ${installed} AND NOT ${FOLDER}/package-lock.json IS_NEWER_THAN ${installed})
  return()
endif()
execute_process(COMMAND ${NPM} ci --no-audit --no-fund --loglevel=error WORKING_DIRECTORY ${FOLDER}
  OUTPUT_QUIET ERROR_VARIABLE complaint RESULT_VARIABLE status)
if(NOT status EQUAL 0)
  message(FATAL_ERROR "npm cannot get the packages of the viewer's page; is there a way to the npm registry? Without one "
    "configure with -DSUPPLE_BUILD_VIEWER=OFF.\n${complaint}")
endif()
# npm does not update the time of this file when nothing changed.
file(TOUCH ${installed})
