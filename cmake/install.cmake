# Installation: the headers, the compiled library, the tools library and the programs where they were built, the CMake package
# (find_package(cncplan)) and the pkg-config files. Nothing holds the prefix: the installed tree can be moved.
include(CMakePackageConfigHelpers)
set(package_dir ${CMAKE_INSTALL_LIBDIR}/cmake/cncplan)
set(pkgconfig_dir ${CMAKE_INSTALL_LIBDIR}/pkgconfig)

install(DIRECTORY include/cncplan DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.hpp)
install(FILES LICENSE DESTINATION ${CMAKE_INSTALL_DOCDIR})
install(TARGETS cncplan EXPORT cncplan)
install(EXPORT cncplan FILE cncplan-targets.cmake NAMESPACE cncplan:: DESTINATION ${package_dir})
install(TARGETS cncplan_compiled EXPORT cncplan-compiled ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} OPTIONAL)
install(EXPORT cncplan-compiled FILE cncplan-compiled-targets.cmake NAMESPACE cncplan:: DESTINATION ${package_dir})
if(TARGET cncplan_tools)
  install(DIRECTORY include/cncplan_tools DESTINATION ${CMAKE_INSTALL_INCLUDEDIR} FILES_MATCHING PATTERN *.hpp)
  install(TARGETS cncplan_tools EXPORT cncplan-tools ARCHIVE DESTINATION ${CMAKE_INSTALL_LIBDIR} OPTIONAL)
  install(EXPORT cncplan-tools FILE cncplan-tools-targets.cmake NAMESPACE cncplan:: DESTINATION ${package_dir})
endif()
foreach(program cncplan_simulate cncplan_tire_mold cncplan_generate)
  if(TARGET ${program})
    install(TARGETS ${program} RUNTIME DESTINATION ${CMAKE_INSTALL_BINDIR} COMPONENT programs OPTIONAL)
  endif()
endforeach()

file(RELATIVE_PATH library_from_package ${CMAKE_INSTALL_PREFIX}/${package_dir}
  ${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/${CMAKE_STATIC_LIBRARY_PREFIX}cncplan${CMAKE_STATIC_LIBRARY_SUFFIX})
file(RELATIVE_PATH tools_from_package ${CMAKE_INSTALL_PREFIX}/${package_dir}
  ${CMAKE_INSTALL_PREFIX}/${CMAKE_INSTALL_LIBDIR}/${CMAKE_STATIC_LIBRARY_PREFIX}cncplan_tools${CMAKE_STATIC_LIBRARY_SUFFIX})
configure_package_config_file(cmake/cncplan-config.cmake.in cncplan-config.cmake
  INSTALL_DESTINATION ${package_dir} NO_SET_AND_CHECK_MACRO)
write_basic_package_version_file(cncplan-config-version.cmake COMPATIBILITY SameMinorVersion)
install(FILES ${CMAKE_CURRENT_BINARY_DIR}/cncplan-config.cmake ${CMAKE_CURRENT_BINARY_DIR}/cncplan-config-version.cmake
  DESTINATION ${package_dir})

# tl-expected has no pkg-config file of its own: its folder is named unless compilers look there anyway.
get_target_property(expected_dirs tl::expected INTERFACE_INCLUDE_DIRECTORIES)
list(REMOVE_ITEM expected_dirs ${CMAKE_CXX_IMPLICIT_INCLUDE_DIRECTORIES})
list(TRANSFORM expected_dirs PREPEND -I)
list(JOIN expected_dirs " " expected_cflags)
file(RELATIVE_PATH prefix_from_pkgconfig ${CMAKE_INSTALL_PREFIX}/${pkgconfig_dir} ${CMAKE_INSTALL_PREFIX})
foreach(name cncplan cncplan-compiled)
  configure_file(cmake/${name}.pc.in ${name}.pc @ONLY)
  install(FILES ${CMAKE_CURRENT_BINARY_DIR}/${name}.pc DESTINATION ${pkgconfig_dir})
endforeach()
