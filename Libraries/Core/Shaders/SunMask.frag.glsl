#version 330 core
//DSPACE::Defines
// By the shadow maps, how much of the Sun's disc is seen from what Plane.frag has drawn. Renderers
// without a GPU run a surface's program for whole blocks of pixels at each of its triangles, however
// small they are: here each pixel comes by once.
uniform sampler2D planes;
uniform mat4 VCDCMatrix;
uniform vec2 viewSize; // pixels
uniform int cameraParallel;

layout(location = 0) out float lit;

//DSPACE::Shadow

void main()
{
  vec4 plane = texelFetch(planes, ivec2(gl_FragCoord.xy), 0);
  if (plane.w == 0.0)
  {
    discard; // nothing was drawn here
  }
  float w = cameraParallel == 1 ? 1.0 : -plane.w;
  vec2 place = (gl_FragCoord.xy / viewSize * 2.0 - 1.0) * w;
  vec2 xy = (place - VCDCMatrix[2].xy * plane.w - VCDCMatrix[3].xy)
    / vec2(VCDCMatrix[0].x, VCDCMatrix[1].y);
  lit = cascadesLit(vec3(xy, plane.w), plane.xyz);
}
