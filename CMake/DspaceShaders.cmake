# dspace_shaders(OUT FILES...): each NAME.glsl becomes a C string NAME (dots as underscores) in a
# header NAME.h under the build folder, which is added to the include path by the caller.
include("${VTK_DIR}/vtkEncodeString.cmake")

function(dspace_shaders out_sources)
  set(sources)
  foreach(file IN LISTS ARGN)
    get_filename_component(name "${file}" NAME)
    string(REPLACE ".glsl" "" name "${name}")
    string(REPLACE "." "_" name "${name}")
    vtk_encode_string(INPUT "${CMAKE_CURRENT_SOURCE_DIR}/${file}" NAME "${name}"
      HEADER_OUTPUT header SOURCE_OUTPUT source)
    list(APPEND sources "${source}" "${header}")
  endforeach()
  set(${out_sources} "${sources}" PARENT_SCOPE)
endfunction()
