// Posts of a body's degree grid, by differences from the place below the camera, which are small
// where the ground is near.
// Longitude and latitude of the window's first post less the camera's, and their steps [rad].
uniform vec2 originAngles;
uniform vec2 stepAngles;
uniform vec2 stepBase; // of level 0
uniform vec2 cameraLatitude; // sine, cosine
uniform float cameraLatitudeAngle;
uniform float radius; // [m]
uniform vec3 eastVC; // of the place below the camera
uniform vec3 northVC;

Standing standingAt(vec2 place, vec4 here, float above)
{
  vec2 d = originAngles + place * stepAngles;
  float latitude = cameraLatitudeAngle + d.y;
  float cosLatitude = cos(latitude);
  float halfEast = sin(0.5 * d.x);
  float halfNorth = sin(0.5 * d.y);
  float fall = 2.0 * cosLatitude * halfEast * halfEast;
  vec3 direction = vec3(cosLatitude * sin(d.x), sin(d.y) + fall * cameraLatitude.x,
    -2.0 * halfNorth * halfNorth - fall * cameraLatitude.y); // less the camera's vertical
#ifdef DSPACE_ELLIPSOID
  float rise = direction.y * cameraLatitude.y + direction.z * cameraLatitude.x;
  Curvature curvature = curvatureAt(rise);
  float distance = curvature.east + here.x;
  float along = curvature.north + here.x;
#else
  float distance = radius + here.x;
  float along = distance;
#endif
  Standing standing;
  standing.positionVC = distance * (direction.x * eastVC + direction.y * northVC + direction.z * upVC) +
    above * upVC;
#ifdef DSPACE_ELLIPSOID
  standing.positionVC += flattening(curvature, rise);
#endif

  float sinEast = sin(d.x);
  float cosEast = cos(d.x);
  float sinLatitude = sin(latitude);
  vec3 east = vec3(cosEast, cameraLatitude.x * sinEast, -cameraLatitude.y * sinEast);
  vec3 north = vec3(-sinLatitude * sinEast,
    cosLatitude * cameraLatitude.y + sinLatitude * cameraLatitude.x * cosEast,
    cosLatitude * cameraLatitude.x - sinLatitude * cameraLatitude.y * cosEast);
  vec3 n = direction + vec3(0.0, 0.0, 1.0) -
    here.y / (distance * max(cosLatitude, 1e-6) * stepBase.x) * east -
    here.z / (along * stepBase.y) * north;
  standing.normalVC = n.x * eastVC + n.y * northVC + n.z * upVC;
  standing.cosSlope = dot(n, direction + vec3(0.0, 0.0, 1.0)) / length(n);
  standing.facing = vec3(-here.y / (distance * max(cosLatitude, 1e-6) * stepBase.x),
    -here.z / (along * stepBase.y), 1.0);
#if defined(DSPACE_HORIZON) && defined(DSPACE_ANGLES)
  mat3 axes = mat3(eastVC, northVC, upVC);
  standing.verticalVC = axes * (direction + vec3(0.0, 0.0, 1.0));
  standing.acrossVC = distance * cosLatitude * stepAngles.x * (axes * east);
  standing.downVC = along * stepAngles.y * (axes * north);
#endif
#ifdef DSPACE_LAYER_NORMALS
  standing.axesVC = mat3(eastVC, northVC, upVC) *
    mat3(east, north, direction + vec3(0.0, 0.0, 1.0));
#endif
  return standing;
}
