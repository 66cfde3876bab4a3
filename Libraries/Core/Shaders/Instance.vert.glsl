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

out vec3 positionVC;
out vec3 normalVC;
out vec2 tcoord;
out vec4 vertexColor;
flat out vec4 baseColor;
flat out vec4 surface; // metallic, roughness, mirrored, unused
flat out vec3 emissive;
flat out uint label;

void main()
{
  int base = (firstInstance + gl_InstanceID) * 6;
  vec4 row0 = uintBitsToFloat(texelFetch(instances, base));
  vec4 row1 = uintBitsToFloat(texelFetch(instances, base + 1));
  vec4 row2 = uintBitsToFloat(texelFetch(instances, base + 2));
  baseColor = uintBitsToFloat(texelFetch(instances, base + 3));
  uvec4 look = texelFetch(instances, base + 4);
  surface = vec4(uintBitsToFloat(look.x), uintBitsToFloat(look.y), uintBitsToFloat(look.w), 0.0);
  label = look.z;
  emissive = uintBitsToFloat(texelFetch(instances, base + 5)).xyz;

#ifdef DSPACE_BILLBOARD
  positionVC = vec3(row0.w, row1.w, row2.w);
  vec4 positionDC = VCDCMatrix * vec4(positionVC, 1.0);
  positionDC.xy += vertexMC.xy * pixelNDC * positionDC.w;
  gl_Position = positionDC;
#else
  vec4 p = vec4(vertexMC, 1.0);
  positionVC = vec3(dot(row0, p), dot(row1, p), dot(row2, p));
  gl_Position = VCDCMatrix * vec4(positionVC, 1.0);
#endif

#ifdef DSPACE_LIT
  // The cofactor matrix carries normals through any affine map; mirroring turns them inside out.
  vec3 n = vec3(dot(cross(row1.xyz, row2.xyz), normalMC), dot(cross(row2.xyz, row0.xyz), normalMC),
    dot(cross(row0.xyz, row1.xyz), normalMC));
  normalVC = n * surface.z;
#else
  normalVC = vec3(0.0, 0.0, 1.0);
#endif
  tcoord = tcoordMC;
  vertexColor = colorMC;
}
