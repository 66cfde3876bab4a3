// Where a post stands. One of ClipmapPlane, ClipmapSphere and ClipmapPole follows, each with
//   Standing standingAt(vec2 place, vec4 here, float above)
// of a place in the window's posts, the ground there, and its height above the camera.
uniform vec3 upVC;
uniform vec3 upNormalVC;

struct Standing
{
  vec3 positionVC;
  vec3 normalVC; // any length, as all that follows
  float cosSlope;
  vec3 facing; // the normal: local east, north, up; of a pole's chart in its axes
};
