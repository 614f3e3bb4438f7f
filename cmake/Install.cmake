include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/supple)

install(TARGETS supple EXPORT suppleTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/supple DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT suppleTargets NAMESPACE supple:: DESTINATION ${package_dir})

# Its own file of targets, read only on request: who links the library alone needs no Assimp.
if(TARGET supple_formats)
  install(TARGETS supple_formats EXPORT suppleFormatsTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/formats/include/supple DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT suppleFormatsTargets NAMESPACE supple:: DESTINATION ${package_dir})
endif()

# Likewise without HDF5.
if(TARGET supple_recording)
  install(TARGETS supple_recording EXPORT suppleRecordingTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/recording/include/supple DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT suppleRecordingTargets NAMESPACE supple:: DESTINATION ${package_dir})
endif()

configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/suppleConfig.cmake.in
  ${PROJECT_BINARY_DIR}/suppleConfig.cmake INSTALL_DESTINATION ${package_dir})
write_basic_package_version_file(${PROJECT_BINARY_DIR}/suppleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/suppleConfig.cmake ${PROJECT_BINARY_DIR}/suppleConfigVersion.cmake
  DESTINATION ${package_dir})

if(TARGET supple_cli)
  install(TARGETS supple_cli RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/scenes DESTINATION ${CMAKE_INSTALL_DATADIR}/supple)
  install(FILES ${PROJECT_SOURCE_DIR}/docs/supple.1 DESTINATION ${CMAKE_INSTALL_MANDIR}/man1)
endif()
