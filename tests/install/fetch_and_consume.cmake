# Builds and runs a project that gets the library by FetchContent. PROJECT stands for the address in the project.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

# The test checks only that the project builds, so it uses the fastest build.
run(${CMAKE_COMMAND} -S ${SOURCE}/fetching_consumer -B ${WORK} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
  -DFETCHCONTENT_SOURCE_DIR_SUPPLE=${PROJECT} -DCMAKE_BUILD_TYPE= -DBUILD_SHARED_LIBS=ON -DSUPPLE_BUILD_RECORDING=ON -DSUPPLE_INSTALL=ON
  "-DCMAKE_CXX_FLAGS=-O0 -DHWY_COMPILE_ONLY_STATIC")
run(${CMAKE_COMMAND} --build ${WORK})
execute_process(COMMAND ${WORK}/consumer OUTPUT_VARIABLE output COMMAND_ERROR_IS_FATAL ANY)
if(NOT output MATCHES "^supple ${VERSION}: [1-9][0-9]* contacts\n$")
  message(FATAL_ERROR "the consumer printed: ${output}")
endif()
