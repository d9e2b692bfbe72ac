# Install: headers below include/tenon (include root = root of the project), targets as tenon::<room>, a version file.
include(CMakePackageConfigHelpers)
foreach(room fem reduction titop assembly)
  install(DIRECTORY ${PROJECT_SOURCE_DIR}/${room} DESTINATION ${CMAKE_INSTALL_INCLUDEDIR}/tenon
          FILES_MATCHING PATTERN "*.hpp")
endforeach()
install(EXPORT tenon-targets NAMESPACE tenon:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/tenon)
configure_package_config_file(cmake/tenon-config.cmake.in ${PROJECT_BINARY_DIR}/tenon-config.cmake
                              INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/tenon)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/tenon-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/tenon-config.cmake ${PROJECT_BINARY_DIR}/tenon-config-version.cmake
              cmake/FindSparseSolvers.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/tenon)
