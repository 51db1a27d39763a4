# What the library stands on. Found here, the targets are made visible everywhere, so that a project that takes cncplan by
# add_subdirectory can link it; targets that the outer project already has are taken as they are.
if(NOT TARGET Eigen3::Eigen)
  find_package(Eigen3 3.4 REQUIRED NO_MODULE)
  set_target_properties(Eigen3::Eigen PROPERTIES IMPORTED_GLOBAL TRUE)
endif()
if(NOT TARGET tl::expected)
  find_package(tl-expected 1.0 REQUIRED)
  set_target_properties(tl::expected PROPERTIES IMPORTED_GLOBAL TRUE)
endif()
