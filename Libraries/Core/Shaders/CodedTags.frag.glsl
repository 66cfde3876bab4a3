// What stands at the tags of Coded.frag where no replacement says otherwise. A section begins with the
// tag that ends it in the program. The tags' names are those of VTK 9.1 (vtkOpenGLPolyDataMapper.cxx).
//VTK::System::Dec
#define varying in
#define texelFetchBuffer texelFetch
#define texture1D texture
#define texture2D texture
#define texture3D texture
//VTK::PositionVC::Dec
in vec4 vertexVCVSOutput;
//VTK::Color::Dec
#ifdef DSPACE_VERTEX_COLOR
in vec4 vertexColorVSOutput;
#endif
//VTK::Normal::Dec
#ifdef DSPACE_NORMALS
in vec3 normalVCVSOutput;
#endif
//VTK::TCoord::Dec
in vec2 tcoordVCVSOutput;
//VTK::PositionVC::Impl
  vec4 vertexVC = vertexVCVSOutput;
//VTK::UniformFlow::Impl
#ifdef DSPACE_FLAT
  vec3 fdx = dFdx(vertexVC.xyz);
  vec3 fdy = dFdy(vertexVC.xyz);
#endif
//VTK::Color::Impl
  vec3 specularColor = specularIntensity * specularColorUniform;
  float specularPower = specularPowerUniform;
  vec3 ambientColor = ambientIntensity * ambientColorUniform;
  vec3 diffuseColor = diffuseIntensity * diffuseColorUniform;
  float opacity = opacityUniform;
//VTK::Normal::Impl
#ifdef DSPACE_NORMALS
  vec3 normalVCVSOutput = normalize(normalVCVSOutput);
  if (gl_FrontFacing != (dspaceSurface.z > 0.0)) { normalVCVSOutput = -normalVCVSOutput; }
#elif defined(DSPACE_FLAT)
  vec3 normalVCVSOutput = normalize(cross(fdx, fdy));
  if (cameraParallel == 1 && normalVCVSOutput.z < 0.0) { normalVCVSOutput = -normalVCVSOutput; }
  if (cameraParallel == 0 && dot(normalVCVSOutput, vertexVC.xyz) > 0.0) { normalVCVSOutput = -normalVCVSOutput; }
#else
  vec3 normalVCVSOutput = vec3(0.0, 0.0, 1.0);
#endif
//VTK::Light::Impl
#ifdef DSPACE_LIT
#ifdef DSPACE_ANGLES
  dspaceAngles = photometricAngles(normalVCVSOutput, vertexVC.xyz, cameraParallel);
#endif
  fragOutput0 = vec4(dspaceDisplay(linearFromSrgb(ambientColor) +
    shaded(linearFromSrgb(diffuseColor), normalVCVSOutput, vertexVC.xyz, dspaceSurface.xy)), opacity);
#else
  fragOutput0 = vec4(dspaceDisplay(linearFromSrgb(ambientColor) + linearFromSrgb(diffuseColor)), opacity);
#endif
