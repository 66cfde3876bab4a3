#version 330 core
//DSPACE::Defines
// Places one instance of a mesh: MC (mesh) to VC (view, camera at the origin) to DC (clip).
// Everything that differs between instances is an attribute that advances with them
// (DrawInstance in dspace/render/DrawList.h; laid out by GpuStore).
layout(location = 0) in vec3 vertexMC;
layout(location = 1) in vec3 normalMC;
layout(location = 2) in vec2 tcoordMC;
layout(location = 3) in vec4 colorMC;
layout(location = 4) in vec4 row0; // of the matrix from MC to VC
layout(location = 5) in vec4 row1;
layout(location = 6) in vec4 row2;
layout(location = 7) in vec4 instanceColor; // linear light, and opacity
layout(location = 8) in vec2 metallicRoughness;
layout(location = 9) in uint instanceLabel;
layout(location = 10) in float mirrored; // -1 where the matrix mirrors, else 1
layout(location = 11) in vec3 instanceEmissive; // linear light

uniform mat4 VCDCMatrix;
uniform vec2 pixelNDC; // size of one pixel of the picture in normalised device coordinates

// Each output costs a software renderer time at every vertex: only what is needed is there.
#ifdef DSPACE_LABEL
flat out uint label;
#else
flat out vec4 baseColor;
#endif
#ifdef DSPACE_LIT
out vec3 positionVC;
out vec3 normalVC;
flat out vec3 surface; // metallic, roughness, mirrored
#endif
#ifdef DSPACE_OBJECT_NORMALS
flat out mat3 normalsVC; // takes normals of the mesh's own axes to the view's
#endif
#ifdef DSPACE_EMISSIVE
flat out vec3 emissive;
#endif
#if defined(DSPACE_TEXTURE) || defined(DSPACE_NORMAL_MAP) || defined(DSPACE_OBJECT_NORMALS)
out vec2 tcoord;
#endif
#ifdef DSPACE_VERTEX_COLOR
out vec4 vertexColor;
#endif

void main()
{
#ifdef DSPACE_LABEL
  label = instanceLabel;
#else
  baseColor = instanceColor;
#endif
#ifdef DSPACE_EMISSIVE
  emissive = instanceEmissive;
#endif

#ifdef DSPACE_BILLBOARD
  vec4 positionDC = VCDCMatrix * vec4(row0.w, row1.w, row2.w, 1.0);
  positionDC.xy += vertexMC.xy * pixelNDC * positionDC.w;
  gl_Position = positionDC;
#else
  vec4 p = vec4(vertexMC, 1.0);
  vec3 placedVC = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
  gl_Position = VCDCMatrix * vec4(placedVC, 1.0);
#endif

#ifdef DSPACE_LIT
  positionVC = placedVC;
  surface = vec3(metallicRoughness, mirrored);
  // The cofactor matrix carries normals through any affine map; mirroring turns them inside out.
  vec3 cofactor0 = cross(row1.xyz, row2.xyz);
  vec3 cofactor1 = cross(row2.xyz, row0.xyz);
  vec3 cofactor2 = cross(row0.xyz, row1.xyz);
  normalVC = surface.z *
    vec3(dot(cofactor0, normalMC), dot(cofactor1, normalMC), dot(cofactor2, normalMC));
#ifdef DSPACE_OBJECT_NORMALS
  normalsVC = surface.z * transpose(mat3(cofactor0, cofactor1, cofactor2));
#endif
#endif
#if defined(DSPACE_TEXTURE) || defined(DSPACE_NORMAL_MAP) || defined(DSPACE_OBJECT_NORMALS)
  tcoord = tcoordMC;
#endif
#ifdef DSPACE_VERTEX_COLOR
  vertexColor = colorMC;
#endif
}
