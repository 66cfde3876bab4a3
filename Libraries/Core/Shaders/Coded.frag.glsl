#version 330 core
//DSPACE::Defines
// Surface.frag in the terms of VTK's polydata mapper, for objects with shader code of their own.
// Colours between the tags are display values, as in VTK; light is computed in linear light. What
// is ours begins with "dspace". CodedTags.frag states what stands at each tag without
// replacements. Labels run the same code, so that what it discards is in no plane.
flat in vec4 dspaceBaseColor; // linear light, and opacity
flat in vec3 dspaceEmissive;
flat in vec3 dspaceSurface; // metallic, roughness, mirrored
flat in uint dspaceLabel;

#ifdef DSPACE_TEXTURE
uniform sampler2D colorTexture;
#define actortexture colorTexture
#endif
//DSPACE::Peeling

// Lights, and how a surface reflects them.
//DSPACE::Lighting

vec3 dspaceDisplay(vec3 linear)
{
  return mix(linear * 12.92, 1.055 * pow(max(linear, vec3(0.0)), vec3(1.0 / 2.4)) - 0.055,
    greaterThan(linear, vec3(0.0031308)));
}

// Uniforms of VTK.
const int PrimitiveIDOffset = 0;
float ambientIntensity;
float diffuseIntensity;
float specularIntensity;
vec3 ambientColorUniform;
vec3 diffuseColorUniform;
vec3 specularColorUniform;
float specularPowerUniform;
float opacityUniform;

#ifdef DSPACE_LABEL
layout(location = 0) out uint dspaceFragment;
#else
layout(location = 0) out vec4 dspaceFragment;
#endif
vec4 fragOutput0; // display value and opacity
#ifdef DSPACE_ANGLES
vec4 dspaceAngles = vec4(0.0); // where code of the object does the lighting
#endif

//VTK::System::Dec
//VTK::CustomUniforms::Dec
//VTK::PositionVC::Dec
//VTK::Camera::Dec
//VTK::Color::Dec
//VTK::Normal::Dec
//VTK::Light::Dec
//VTK::TMap::Dec
//VTK::TCoord::Dec
//VTK::Picking::Dec
//VTK::DepthPeeling::Dec
//VTK::Clip::Dec
//VTK::Output::Dec
//VTK::PrimID::Dec
//VTK::Coincident::Dec
//VTK::ValuePass::Dec
//VTK::Edges::Dec

void main()
{
#ifdef DSPACE_PEEL
  if (dspacePeeled())
  {
    discard;
  }
#endif
  vec4 dspaceBase = dspaceBaseColor;
#ifdef DSPACE_VERTEX_COLOR
  dspaceBase *= vec4(linearFromSrgb(vertexColorVSOutput.rgb), vertexColorVSOutput.a);
#endif
#ifdef DSPACE_TEXTURE
  dspaceBase *= texture(colorTexture, tcoordVCVSOutput);
#endif
  ambientIntensity = 1.0;
  diffuseIntensity = 1.0;
  specularIntensity = 0.0;
  ambientColorUniform = dspaceDisplay(dspaceEmissive);
  diffuseColorUniform = dspaceDisplay(dspaceBase.rgb);
  specularColorUniform = vec3(1.0);
  specularPowerUniform = 1.0;
  opacityUniform = dspaceBase.a;

  //VTK::CustomBegin::Impl
  //VTK::PositionVC::Impl
  //VTK::UniformFlow::Impl
  //VTK::Depth::Impl
  //VTK::DepthPeeling::PreColor
  //VTK::PrimID::Impl
  //VTK::Clip::Impl
  //VTK::ValuePass::Impl
  //VTK::Color::Impl
  //VTK::Edges::Impl
  //VTK::Normal::Impl
  //VTK::Light::Impl
  //VTK::TCoord::Impl
  if (fragOutput0.a <= 0.0)
  {
    discard;
  }
  //VTK::DepthPeeling::Impl
  //VTK::Picking::Impl
  //VTK::Coincident::Impl
  //VTK::CustomEnd::Impl

#ifdef DSPACE_LABEL
  dspaceFragment = dspaceLabel;
#elif defined(DSPACE_ANGLES)
  dspaceFragment = dspaceAngles;
#elif defined(DSPACE_PEEL)
  dspaceFragment = vec4(linearFromSrgb(fragOutput0.rgb) * fragOutput0.a, fragOutput0.a);
#elif defined(DSPACE_DISPLAY_COLOR)
  dspaceFragment = vec4(linearFromSrgb(fragOutput0.rgb), 0.0); // not exposed
#else
  dspaceFragment = vec4(linearFromSrgb(fragOutput0.rgb), 1.0);
#endif
}
