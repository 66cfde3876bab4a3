// Posts of a pole's chart, in its stereographic plane.
// In twice the radius: the camera; the window's first post less the camera, and a post's step.
uniform vec2 cameraPlane;
uniform vec2 originPlane;
uniform vec2 stepPlane;
uniform float planeBase; // a level-0 post
uniform float radius; // [m]
uniform vec3 poleXVC; // axes: Z out of the pole
uniform vec3 poleYVC;
uniform vec3 poleZVC;
#ifdef DSPACE_MIXED
out vec3 poleDirection;
#endif

Standing standingAt(vec2 place, vec4 here, float above)
{
  // The difference of two inverse projections without their difference.
  vec2 d = originPlane + place * stepPlane;
  vec2 u = cameraPlane + d;
  float here1 = 1.0 + dot(cameraPlane, cameraPlane);
  float more = 2.0 * dot(cameraPlane, d) + dot(d, d);
  float there1 = here1 + more;
  vec3 apart = vec3(2.0 * (d * here1 - cameraPlane * more), -2.0 * more) / (here1 * there1);
#ifdef DSPACE_ELLIPSOID
  float side = dot(poleZVC, axisVC) < 0.0 ? -1.0 : 1.0;
  float rise = side * apart.z;
  Curvature curvature = curvatureAt(rise);
  float distance = curvature.east + here.x;
#else
  float distance = radius + here.x;
#endif
  Standing standing;
  standing.positionVC = distance * (apart.x * poleXVC + apart.y * poleYVC + apart.z * poleZVC) +
    above * upVC;
#ifdef DSPACE_ELLIPSOID
  standing.positionVC += flattening(curvature, rise);
#endif

  vec3 vertical = vec3(2.0 * u, 1.0 - dot(u, u)) / there1;
  vec3 alongX = vec3(1.0 - 2.0 * u.x * u.x / there1, -2.0 * u.x * u.y / there1, -2.0 * u.x / there1);
  vec3 alongY = vec3(-2.0 * u.x * u.y / there1, 1.0 - 2.0 * u.y * u.y / there1, -2.0 * u.y / there1);
  float metres = distance * 2.0 * planeBase / there1; // of ground, a level-0 post
#ifdef DSPACE_ELLIPSOID
  vec3 fall = here.y / metres * alongX - here.z / metres * alongY;
  // A degree along the meridian is another length than one along the parallel.
  vec2 outward = u / max(length(u), 1e-12);
  vec3 meridian = outward.x * alongX + outward.y * alongY;
  fall += (distance / (curvature.north + here.x) - 1.0) * dot(fall, meridian) * meridian;
  vec3 n = vertical - fall;
#else
  vec3 n = vertical - here.y / metres * alongX + here.z / metres * alongY;
#endif
  standing.normalVC = n.x * poleXVC + n.y * poleYVC + n.z * poleZVC;
  standing.cosSlope = dot(n, vertical) / length(n);
  standing.facing = n;
#ifdef DSPACE_MIXED
  poleDirection = vertical;
#endif
#if defined(DSPACE_HORIZON) && defined(DSPACE_ANGLES)
  mat3 axes = mat3(poleXVC, poleYVC, poleZVC);
  standing.verticalVC = axes * vertical;
  standing.acrossVC = distance * 2.0 * stepPlane.x / there1 * (axes * alongX);
  standing.downVC = distance * 2.0 * stepPlane.y / there1 * (axes * alongY);
#endif
#ifdef DSPACE_LAYER_NORMALS
  standing.axesVC = mat3(poleXVC, poleYVC, poleZVC) * mat3(alongX, alongY, vertical);
#endif
  return standing;
}
