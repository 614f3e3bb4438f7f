# Builds and runs projects that use only what LIBRARY, a build folder, installs.
function(run)
  execute_process(COMMAND ${ARGN} COMMAND_ECHO STDOUT COMMAND_ERROR_IS_FATAL ANY)
endfunction()

file(REMOVE_RECURSE ${WORK}/prefix ${WORK}/consumer ${WORK}/recording_consumer ${WORK}/viewer_consumer)
run(${CMAKE_COMMAND} --install ${LIBRARY} --prefix ${WORK}/prefix)
function(build_and_run name expected)
  run(${CMAKE_COMMAND} -S ${SOURCE}/${name} -B ${WORK}/${name} -G ${GENERATOR} -DCMAKE_CXX_COMPILER=${CXX_COMPILER}
    -DCMAKE_PREFIX_PATH=${WORK}/prefix)
  run(${CMAKE_COMMAND} --build ${WORK}/${name})
  execute_process(COMMAND ${WORK}/${name}/${name} WORKING_DIRECTORY ${WORK}/${name} OUTPUT_VARIABLE output
    COMMAND_ERROR_IS_FATAL ANY)
  if(NOT output MATCHES "${expected}")
    message(FATAL_ERROR "${name} printed: ${output}")
  endif()
endfunction()

build_and_run(consumer "^supple ${VERSION}: [1-9][0-9]* contacts\n$")
build_and_run(recording_consumer "^supple ${VERSION}: frame at 0.5 s\n$")
file(GLOB_RECURSE viewer ${WORK}/prefix/supple_viewer_targets.cmake)
if(viewer)
  build_and_run(viewer_consumer "^supple ${VERSION}: (1 step|attach: the library was built without the page)")
endif()
