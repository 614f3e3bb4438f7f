include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/supple)

install(TARGETS supple EXPORT suppleTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/supple DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT suppleTargets NAMESPACE supple:: DESTINATION ${package_dir})

# Each component has its own targets file, which find_package reads only on request. So a program that links
# only the core needs none of Assimp, libzip, pugixml and HDF5.
foreach(component IN ITEMS files describe verify inspect comparison manifold models simulation formats recording distributed viewer)
  if(TARGET supple_${component})
    set(targets supple_${component})
    if(component STREQUAL "viewer")
      list(APPEND targets supple_viewer_session)
    endif()
    install(TARGETS ${targets} EXPORT supple_${component}_targets
      ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
    get_target_property(folder supple_${component} SOURCE_DIR)
    install(DIRECTORY ${folder}/include/supple DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
    install(EXPORT supple_${component}_targets NAMESPACE supple:: DESTINATION ${package_dir})
  endif()
endforeach()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/suppleConfig.cmake.in
  ${PROJECT_BINARY_DIR}/suppleConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/suppleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/suppleConfig.cmake ${PROJECT_BINARY_DIR}/suppleConfigVersion.cmake
  DESTINATION ${package_dir})
if(TARGET supple_distributed)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/FindZoltan.cmake DESTINATION ${package_dir})
endif()
if(TARGET supple_formats)
  install(FILES ${PROJECT_SOURCE_DIR}/cmake/FindLIBZIP.cmake DESTINATION ${package_dir})
endif()

if(TARGET supple_cli)
  install(TARGETS supple_cli supple_experiment RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/supple)
  find_package(Python3 REQUIRED COMPONENTS Interpreter)
  if(NOT CMAKE_CROSSCOMPILING)  # the program of experiments has all options
    install(CODE "execute_process(COMMAND \"$<TARGET_FILE:supple_experiment>\" --describe
      COMMAND \"${Python3_EXECUTABLE}\" \"${PROJECT_SOURCE_DIR}/tools/make_documents.py\" --man
      OUTPUT_FILE \"${PROJECT_BINARY_DIR}/supple.1\" COMMAND_ERROR_IS_FATAL ANY)")
    install(FILES ${PROJECT_BINARY_DIR}/supple.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
  endif()
endif()
