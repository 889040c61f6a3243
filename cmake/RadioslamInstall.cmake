# Installs the programs (radioslam-reproduce and radioslam-agent where they were built), the libraries and headers of all rooms but study, and a CMake package.
include(GNUInstallDirs)
include(CMakePackageConfigHelpers)

get_property(rooms GLOBAL PROPERTY RADIOSLAM_ROOMS)
install(TARGETS radioslam_settings ${rooms} EXPORT radioslamTargets
        LIBRARY DESTINATION ${CMAKE_INSTALL_LIBDIR} ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} INCLUDES DESTINATION ${CMAKE_INSTALL_INCLUDEDIR})
if(TARGET radioslam_program)
  install(TARGETS radioslam_program RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR})
  install(TARGETS radioslam_reproduce radioslam_agent RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} OPTIONAL)
endif()
install(DIRECTORY src/radioslam DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN "*.hpp"
        PATTERN cli EXCLUDE PATTERN study EXCLUDE)
install(EXPORT radioslamTargets NAMESPACE radioslam:: DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/radioslam)
configure_package_config_file(cmake/radioslamConfig.cmake.in ${PROJECT_BINARY_DIR}/radioslamConfig.cmake
  INSTALL_DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/radioslam)
write_basic_package_version_file(${PROJECT_BINARY_DIR}/radioslamConfigVersion.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${PROJECT_BINARY_DIR}/radioslamConfig.cmake ${PROJECT_BINARY_DIR}/radioslamConfigVersion.cmake
              cmake/FindMetis.cmake cmake/FindAmd.cmake cmake/FindZstd.cmake cmake/FindLz4.cmake cmake/FindPcap.cmake DESTINATION ${CMAKE_INSTALL_LIBDIR}/cmake/radioslam)
