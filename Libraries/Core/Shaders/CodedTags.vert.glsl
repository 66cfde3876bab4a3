// What stands at the tags of Coded.vert where no replacement says otherwise. A section begins with the
// tag that ends it in the program. The tags' names are those of VTK 9.1 (vtkOpenGLPolyDataMapper.cxx).
//VTK::System::Dec
#define attribute in
#define varying out
//VTK::PositionVC::Dec
out vec4 vertexVCVSOutput;
//VTK::Normal::Dec
#ifdef DSPACE_NORMALS
out vec3 normalVCVSOutput;
#endif
//VTK::TCoord::Dec
out vec2 tcoordVCVSOutput;
//VTK::Color::Dec
#ifdef DSPACE_VERTEX_COLOR
out vec4 vertexColorVSOutput;
#endif
//VTK::Color::Impl
#ifdef DSPACE_VERTEX_COLOR
  vertexColorVSOutput = scalarColor;
#endif
//VTK::Normal::Impl
#ifdef DSPACE_NORMALS
  normalVCVSOutput = normalMatrix * normalMC;
#endif
//VTK::TCoord::Impl
  tcoordVCVSOutput = tcoord;
//VTK::PositionVC::Impl
  vertexVCVSOutput = MCVCMatrix * vertexMC;
  gl_Position = VCDCMatrix * vertexVCVSOutput;
