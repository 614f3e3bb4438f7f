# supple_add_component(NAME SOURCE...) adds the library supple::NAME, which links supple::supple. The library
# has its own folder, with public headers in include/. Components may use internal headers of the core and of the
# libraries in libs/ that they link.
function(supple_add_component name)
  add_library(supple_${name} ${ARGN})
  add_library(supple::${name} ALIAS supple_${name})
  target_include_directories(supple_${name}
    PUBLIC $<BUILD_INTERFACE:${CMAKE_CURRENT_SOURCE_DIR}/include> $<INSTALL_INTERFACE:${CMAKE_INSTALL_INCLUDEDIR}>
    PRIVATE ${CMAKE_CURRENT_SOURCE_DIR}/src ${PROJECT_SOURCE_DIR}/src/supple ${PROJECT_SOURCE_DIR}/libs)
  target_link_libraries(supple_${name} PUBLIC supple PRIVATE $<BUILD_INTERFACE:supple_compile_options>)
  # Some have other options, and where a component enables C, CMake names the files of that compiler.
  if(name MATCHES "^(files|formats|recording|viewer)$")
    supple_compile_together(supple_${name})
  else()
    supple_compile_together(supple_${name} REUSE_FROM supple_files)
  endif()
  set_target_properties(supple_${name} PROPERTIES
    EXPORT_NAME ${name} POSITION_INDEPENDENT_CODE ON VERSION ${PROJECT_VERSION} SOVERSION 0
    # A shared component finds the core beside it.
    INSTALL_RPATH "$ORIGIN")
endfunction()
