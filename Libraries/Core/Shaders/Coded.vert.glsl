#version 330 core
//DSPACE::Defines
// Instance.vert in the terms of VTK's polydata mapper, for objects with shader code of their own:
// code written for a vtkActor finds the tags, variables and matrices that it knows. What is ours
// begins with "dspace". CodedTags.vert states what stands at each tag without replacements.
layout(location = 0) in vec3 dspaceVertex;
layout(location = 1) in vec3 dspaceNormal;
layout(location = 2) in vec2 dspaceTCoord;
layout(location = 3) in vec4 dspaceScalarColor;
layout(location = 4) in vec4 dspaceRow0; // of the matrix from MC to VC
layout(location = 5) in vec4 dspaceRow1;
layout(location = 6) in vec4 dspaceRow2;
layout(location = 7) in vec4 dspaceColor; // linear light, and opacity
layout(location = 8) in vec2 dspaceMetallicRoughness;
layout(location = 9) in uint dspaceInstanceLabel;
layout(location = 10) in float dspaceMirrored; // -1 where the matrix mirrors, else 1
layout(location = 11) in vec3 dspaceInstanceEmissive; // linear light

uniform mat4 VCDCMatrix;

flat out vec4 dspaceBaseColor;
flat out vec3 dspaceEmissive;
flat out vec3 dspaceSurface; // metallic, roughness, mirrored
flat out uint dspaceLabel;

// Attributes and uniforms of VTK. Code may change them.
vec4 vertexMC;
vec3 normalMC;
vec2 tcoord;
vec4 scalarColor;
mat4 MCVCMatrix;
mat4 MCDCMatrix;
mat3 normalMatrix;

//VTK::System::Dec
//VTK::CustomUniforms::Dec
//VTK::PositionVC::Dec
//VTK::Normal::Dec
//VTK::Light::Dec
//VTK::TCoord::Dec
//VTK::Color::Dec
//VTK::Clip::Dec
//VTK::Camera::Dec
//VTK::PrimID::Dec
//VTK::ValuePass::Dec
//VTK::Picking::Dec

void main()
{
  dspaceBaseColor = dspaceColor;
  dspaceEmissive = dspaceInstanceEmissive;
  dspaceSurface = vec3(dspaceMetallicRoughness, dspaceMirrored);
  dspaceLabel = dspaceInstanceLabel;
  vertexMC = vec4(dspaceVertex, 1.0);
  normalMC = dspaceNormal;
  tcoord = dspaceTCoord;
  scalarColor = dspaceScalarColor;
  MCVCMatrix = transpose(mat4(dspaceRow0, dspaceRow1, dspaceRow2, vec4(0.0, 0.0, 0.0, 1.0)));
  MCDCMatrix = VCDCMatrix * MCVCMatrix;
  normalMatrix = transpose(inverse(mat3(MCVCMatrix)));

  //VTK::CustomBegin::Impl
  //VTK::Color::Impl
  //VTK::Normal::Impl
  //VTK::TCoord::Impl
  //VTK::Clip::Impl
  //VTK::PrimID::Impl
  //VTK::PositionVC::Impl
  //VTK::ValuePass::Impl
  //VTK::Light::Impl
  //VTK::Picking::Impl
  //VTK::CustomEnd::Impl
}
