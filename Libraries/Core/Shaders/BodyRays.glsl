// Rays of the window's places about a body (dspace/render/bodies/BodyView.h), which is a unit sphere in
// axes of its own.
uniform vec2 pivot;
uniform mat3 viewOrigin;    // times (1, x, y) of the window from the pivot: of the ray, view axes [m]
uniform mat3 viewDirection; // likewise
uniform mat3 rayOrigin;     // likewise, in the sphere's axes
uniform mat3 rayDirection;
uniform float gap; // above -1: the same origin's squared distance from the centre, less 1
uniform vec2 depthRows[2]; // of the clip matrix: depth and w, by the view's -z and 1
uniform sampler2D opaqueDepth;

float depthOf(float z)
{
  return (depthRows[0].x * -z + depthRows[0].y) / (depthRows[1].x * -z + depthRows[1].y);
}

// Where along the ray of this sample what is opaque stands.
float opaqueLength(vec3 from)
{
  float stored = texelFetch(opaqueDepth, ivec2(gl_FragCoord.xy), 0).r;
  float below = stored * depthRows[1].x - depthRows[0].x;
  float depth = below > 0.0 ? (depthRows[0].y - stored * depthRows[1].y) / below : 3e38;
  if (depthRows[1].x == 0.0) // parallel
  {
    depth = stored > 0.0 ? (stored - depthRows[0].y) / depthRows[0].x : 3e38;
  }
  return depth + (viewOrigin * from).z;
}
