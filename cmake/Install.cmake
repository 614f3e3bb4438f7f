include(CMakePackageConfigHelpers)

install(TARGETS supple EXPORT suppleTargets
  ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
install(DIRECTORY ${PROJECT_SOURCE_DIR}/include/supple DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
install(EXPORT suppleTargets NAMESPACE supple:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/supple)
# Its own file of targets, read only on request: who links the library alone needs no Assimp.
if(TARGET supple_formats)
  install(TARGETS supple_formats EXPORT suppleFormatsTargets
    ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR})
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/formats/include/supple DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
  install(EXPORT suppleFormatsTargets NAMESPACE supple:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/supple)
endif()
configure_package_config_file(${PROJECT_SOURCE_DIR}/cmake/suppleConfig.cmake.in
  ${PROJECT_BINARY_DIR}/suppleConfig.cmake INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/supple)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/suppleConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/suppleConfig.cmake ${PROJECT_BINARY_DIR}/suppleConfigVersion.cmake
  DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/supple)
