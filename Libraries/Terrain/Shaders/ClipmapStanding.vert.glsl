// Where a post stands. One of ClipmapPlane, ClipmapSphere and ClipmapPole follows, each with
//   Standing standingAt(vec2 place, vec4 here, float above)
// of a place in the window's posts, the ground there, and its height above the camera.
uniform vec3 upVC;
uniform vec3 upNormalVC;

#ifdef DSPACE_ELLIPSOID
uniform vec3 ellipsoid; // equatorial radius [m], eccentricity squared, sine of the camera's latitude
uniform vec3 axisVC; // to the north pole

struct Curvature
{
  float east; // radii where a vertical is [m]
  float north;
  float more; // the radius east, less that below the camera
};

// `rise`: the sine of its latitude less that of the camera's.
Curvature curvatureAt(float rise)
{
  float sine = ellipsoid.z + rise;
  float w = 1.0 - ellipsoid.y * sine * sine;
  float root = sqrt(w);
  float w0 = 1.0 - ellipsoid.y * ellipsoid.z * ellipsoid.z;
  float root0 = sqrt(w0);
  Curvature curvature;
  curvature.east = ellipsoid.x / root;
  curvature.north = curvature.east * (1.0 - ellipsoid.y) / w;
  curvature.more = ellipsoid.x * ellipsoid.y * rise * (sine + ellipsoid.z) /
    (root * root0 * (root + root0));
  return curvature;
}

// What an ellipsoid's place is from that of a sphere with the radius east.
vec3 flattening(Curvature curvature, float rise)
{
  return curvature.more * upVC -
    ellipsoid.y * (curvature.east * rise + curvature.more * ellipsoid.z) * axisVC;
}
#endif

struct Standing
{
  vec3 positionVC;
  vec3 normalVC; // any length, as all that follows
  float cosSlope;
  vec3 facing; // the normal: local east, north, up; of a pole's chart in its axes
#if defined(DSPACE_HORIZON) && defined(DSPACE_ANGLES)
  vec3 verticalVC; // any length
  vec3 acrossVC; // [m] a column of the level along level ground, and a row
  vec3 downVC;
#endif
#ifdef DSPACE_LAYER_NORMALS
  mat3 axesVC; // takes normals in the chart's axes, the third up, to the view's
#endif
};
