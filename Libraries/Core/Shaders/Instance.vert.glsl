//DSPACE::Version
// Places one instance of a mesh: MC (mesh) to VC (view, camera at the origin) to DC (clip).
// Everything that differs between instances is read from a buffer texture, six texels each
// (DrawInstance in dspace/render/DrawList.h).
layout(location = 0) in vec3 vertexMC;
layout(location = 1) in vec3 normalMC;
layout(location = 2) in vec2 tcoordMC;
layout(location = 3) in vec4 colorMC;

uniform usamplerBuffer instances;
uniform int firstInstance;
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
#ifdef DSPACE_EMISSIVE
flat out vec3 emissive;
#endif
#ifdef DSPACE_TEXTURE
out vec2 tcoord;
#endif
#ifdef DSPACE_VERTEX_COLOR
out vec4 vertexColor;
#endif

void main()
{
  int base = (firstInstance + gl_InstanceID) * 6;
  vec4 row0 = uintBitsToFloat(texelFetch(instances, base));
  vec4 row1 = uintBitsToFloat(texelFetch(instances, base + 1));
  vec4 row2 = uintBitsToFloat(texelFetch(instances, base + 2));
#ifdef DSPACE_LABEL
  label = texelFetch(instances, base + 4).z;
#else
  baseColor = uintBitsToFloat(texelFetch(instances, base + 3));
#endif
#ifdef DSPACE_EMISSIVE
  emissive = uintBitsToFloat(texelFetch(instances, base + 5)).xyz;
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
  surface = uintBitsToFloat(texelFetch(instances, base + 4)).xyw;
  // The cofactor matrix carries normals through any affine map; mirroring turns them inside out.
  normalVC = surface.z *
    vec3(dot(cross(row1.xyz, row2.xyz), normalMC), dot(cross(row2.xyz, row0.xyz), normalMC),
      dot(cross(row0.xyz, row1.xyz), normalMC));
#endif
#ifdef DSPACE_TEXTURE
  tcoord = tcoordMC;
#endif
#ifdef DSPACE_VERTEX_COLOR
  vertexColor = colorMC;
#endif
}
