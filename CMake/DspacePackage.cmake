# What find_package(Dspace) reads in an installed tree. vtk_module_build installs the targets where
# there are VTK modules, together with the plain libraries.
include(CMakePackageConfigHelpers)

set(cmake_destination "${CMAKE_INSTALL_LIBDIR}/cmake/Dspace")
configure_package_config_file(
  "${CMAKE_CURRENT_LIST_DIR}/DspaceConfig.cmake.in" "${CMAKE_BINARY_DIR}/CMake/DspaceConfig.cmake"
  INSTALL_DESTINATION "${cmake_destination}")
write_basic_package_version_file("${CMAKE_BINARY_DIR}/CMake/DspaceConfigVersion.cmake"
  COMPATIBILITY SameMinorVersion)
install(
  FILES "${CMAKE_BINARY_DIR}/CMake/DspaceConfig.cmake"
    "${CMAKE_BINARY_DIR}/CMake/DspaceConfigVersion.cmake"
  DESTINATION "${cmake_destination}")
if(NOT DSPACE_GRAPHICS)
  install(EXPORT Dspace NAMESPACE Dspace:: FILE Dspace-targets.cmake
    DESTINATION "${cmake_destination}")
endif()
