# Installation: the headers, the CMake package (find_package(cncplan)) and the pkg-config file. Nothing depends on the
# machine's architecture and nothing holds the prefix: the installed tree can be moved.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_DATADIR}/cmake/cncplan)
set(pkgconfig_dir ${CMAKE_INSTALL_DATADIR}/pkgconfig)

install(DIRECTORY include/cncplan DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.hpp)
install(TARGETS cncplan EXPORT cncplan)
install(EXPORT cncplan FILE cncplan-targets.cmake NAMESPACE cncplan:: DESTINATION ${package_dir})
configure_package_config_file(cmake/cncplan-config.cmake.in cncplan-config.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(cncplan-config-version.cmake COMPATIBILITY SameMinorVersion ARCH_INDEPENDENT)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cncplan-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/cncplan-config-version.cmake
  DESTINATION ${package_dir})

# tl-expected has no pkg-config file of its own: its folder is named unless compilers look there anyway.
get_target_property(expected_dirs tl::expected INTERFACE_INCLUDE_DIRECTORIES)
list(REMOVE_ITEM expected_dirs ${CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES})
list(TRANSFORM expected_dirs PREPEND -I)
list(JOIN expected_dirs " " expected_cflags)
file(RELATIVE_PATH prefix_from_pkgconfig ${CMAKE_INSTALL_PREFIX}/${pkgconfig_dir} ${CMAKE_INSTALL_PREFIX})
configure_file(cmake/cncplan.pc.in cncplan.pc @ONLY)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cncplan.pc DESTINATION ${pkgconfig_dir})
