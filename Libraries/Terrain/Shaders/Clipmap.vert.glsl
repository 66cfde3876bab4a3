#version 330 core
//DSPACE::Defines
// Places the posts of one clipmap level: heights are fetched, and near the level's outline turned
// into the next coarser level's (Losasso and Hoppe 2004). Everything is relative to the camera.
#if defined(DSPACE_LIT) || defined(DSPACE_MIXED)
#define DSPACE_NORMAL
#endif
layout(location = 0) in vec2 cell; // post of the window, 0 to cells

uniform sampler2DArray posts; // height, slopes a level-0 column and row, 1 in a hole, else tracks
uniform int texelMask;
uniform int level;
uniform ivec2 windowTexel; // texel of the window's first post, here and in the coarser level
uniform ivec2 coarseTexel;
uniform vec2 firstPost; // of the lattice, in the window's posts: those outside collapse into it
uniform vec2 lastPost;
uniform vec2 endPost; // where the lattice ends: nowhere around a body
uniform vec2 lastPlace; // where the last one stands: the lattice may end between two
uniform vec2 cameraPost;
uniform vec3 blend; // distance where blending begins, 1 / its width, the camera's distance [posts]
uniform float heightHigh; // of the camera, as two floats
uniform float heightLow;

#ifdef DSPACE_SPHERE
// Longitude and latitude of the window's first post less the camera's, and their steps [rad].
uniform vec2 originAngles;
uniform vec2 stepAngles;
uniform vec2 stepBase; // of level 0
uniform vec2 cameraLatitude; // sine, cosine
uniform float cameraLatitudeAngle;
uniform float radius; // [m]
uniform vec3 eastVC; // of the place below the camera
uniform vec3 northVC;
#elif defined(DSPACE_POLE)
// In the pole's stereographic plane, in twice the radius: the camera; the window's first post less
// the camera, and a post's step.
uniform vec2 cameraPlane;
uniform vec2 originPlane;
uniform vec2 stepPlane;
uniform float planeBase; // a level-0 post
uniform float radius; // [m]
uniform vec3 poleXVC; // axes: Z out of the pole
uniform vec3 poleYVC;
uniform vec3 poleZVC;
#else
uniform vec3 originVC; // first post, at the camera's height
uniform vec3 columnVC; // a post
uniform vec3 rowVC;
uniform vec3 slopeColumnVC; // what a slope of 1 a level-0 post takes from the normal
uniform vec3 slopeRowVC;
#ifdef DSPACE_FACING
uniform mat2 slopePlane; // slopes east and north of those a level-0 column and row
#endif
#endif
uniform vec3 upVC;
uniform vec3 upNormalVC;
uniform mat4 VCDCMatrix;

#ifdef DSPACE_LABEL
uniform int objectLabel;
flat out uint label;
#else
uniform vec4 objectColor;
flat out vec4 baseColor;
#endif
#ifdef DSPACE_LIT
uniform vec3 objectSurface; // metallic, roughness, mirrored
out vec3 positionVC;
out vec3 normalVC;
flat out vec3 surface;
#endif
#ifdef DSPACE_EMISSIVE
uniform vec3 objectEmissive;
flat out vec3 emissive;
#endif
#ifdef DSPACE_TEXTURE
uniform vec2 originTexture;
uniform mat2 postTexture;
out vec2 tcoord;
#endif
#ifdef DSPACE_LAYERS
uniform vec2 originLayer; // texels of the finest zoom, from a tile's corner near the camera on
uniform vec2 postLayer;
out vec2 layerAt;
#endif
#ifdef DSPACE_HOLES
out float hole;
#endif
#ifdef DSPACE_MIXED
#ifdef DSPACE_POLE
out vec3 poleDirection;
#else
uniform vec2 originGrid; // of the first post, from a line near the camera on; 1 from line to line
uniform mat2 postGrid;
#endif
out vec4 styleAt;
#ifdef DSPACE_LEVELS
out vec2 awayAt; // from the camera [posts]
#endif
#ifdef DSPACE_FACING
out vec3 facingAt; // the normal, any length: local east, north, up; of a pole's chart in its axes
#endif
#ifdef DSPACE_TRACKS
out float trackAt;
#endif
#ifdef DSPACE_DETAILS
uniform vec4 originDetail; // of two textures: tiles from one near the camera on
uniform mat2 postDetail0;
uniform mat2 postDetail1;
out vec4 detailAt;
#endif
#endif

vec4 postAt(ivec2 texel, int layer)
{
  return texelFetch(posts, ivec3(texel & texelMask, layer), 0);
}

void main()
{
  vec2 at = clamp(cell, firstPost, lastPost);
  ivec2 post = ivec2(at);
  vec4 here = postAt(windowTexel + post, level);
  bool missing = here.w > 0.75;
  vec2 away = abs(at - cameraPost);
  float coarser = clamp((max(max(away.x, away.y), blend.z) - blend.x) * blend.y, 0.0, 1.0);
  if (coarser > 0.0)
  {
    // The coarser surface at this place: a post of it, or the middle of an edge or a diagonal. The
    // lattice's last post is one of every level.
    ivec2 before = (post + ivec2(equal(at, endPost))) >> 1;
    ivec2 after = (post + 1) >> 1;
    vec4 there0 = postAt(coarseTexel + before, level + 1);
    vec4 there1 = postAt(coarseTexel + after, level + 1);
    if (max(there0.w, there1.w) < 0.75)
    {
      here = mix(here, 0.5 * (there0 + there1), coarser);
      missing = missing && coarser < 1.0;
    }
  }
  vec2 place = min(at, lastPlace);
  float above = (here.x - heightHigh) - heightLow;

#ifdef DSPACE_SPHERE
  // Differences from the place below the camera, small where the ground is near.
  vec2 d = originAngles + place * stepAngles;
  float latitude = cameraLatitudeAngle + d.y;
  float cosLatitude = cos(latitude);
  float halfEast = sin(0.5 * d.x);
  float halfNorth = sin(0.5 * d.y);
  float fall = 2.0 * cosLatitude * halfEast * halfEast;
  vec3 direction = vec3(cosLatitude * sin(d.x), sin(d.y) + fall * cameraLatitude.x,
    -2.0 * halfNorth * halfNorth - fall * cameraLatitude.y); // less the camera's vertical
  float distance = radius + here.x;
  vec3 placedVC = distance * (direction.x * eastVC + direction.y * northVC + direction.z * upVC) +
    above * upVC;
#ifdef DSPACE_NORMAL
  float sinEast = sin(d.x);
  float cosEast = cos(d.x);
  float sinLatitude = sin(latitude);
  vec3 east = vec3(cosEast, cameraLatitude.x * sinEast, -cameraLatitude.y * sinEast);
  vec3 north = vec3(-sinLatitude * sinEast,
    cosLatitude * cameraLatitude.y + sinLatitude * cameraLatitude.x * cosEast,
    cosLatitude * cameraLatitude.x - sinLatitude * cameraLatitude.y * cosEast);
  vec3 n = direction + vec3(0.0, 0.0, 1.0) -
    here.y / (distance * max(cosLatitude, 1e-6) * stepBase.x) * east -
    here.z / (distance * stepBase.y) * north;
  vec3 normal = n.x * eastVC + n.y * northVC + n.z * upVC;
  float cosSlope = dot(n, direction + vec3(0.0, 0.0, 1.0)) / length(n);
#endif
#elif defined(DSPACE_POLE)
  // The difference of two inverse projections without their difference.
  vec2 d = originPlane + place * stepPlane;
  vec2 u = cameraPlane + d;
  float here1 = 1.0 + dot(cameraPlane, cameraPlane);
  float more = 2.0 * dot(cameraPlane, d) + dot(d, d);
  float there1 = here1 + more;
  vec3 apart = vec3(2.0 * (d * here1 - cameraPlane * more), -2.0 * more) / (here1 * there1);
  float distance = radius + here.x;
  vec3 placedVC = distance * (apart.x * poleXVC + apart.y * poleYVC + apart.z * poleZVC) +
    above * upVC;
#ifdef DSPACE_NORMAL
  vec3 vertical = vec3(2.0 * u, 1.0 - dot(u, u)) / there1;
  vec3 alongX = vec3(1.0 - 2.0 * u.x * u.x / there1, -2.0 * u.x * u.y / there1, -2.0 * u.x / there1);
  vec3 alongY = vec3(-2.0 * u.x * u.y / there1, 1.0 - 2.0 * u.y * u.y / there1, -2.0 * u.y / there1);
  float metres = distance * 2.0 * planeBase / there1; // of ground, a level-0 post
  vec3 n = vertical - here.y / metres * alongX + here.z / metres * alongY;
  vec3 normal = n.x * poleXVC + n.y * poleYVC + n.z * poleZVC;
  float cosSlope = dot(n, vertical) / length(n);
#endif
#else
  vec3 placedVC = originVC + place.x * columnVC + place.y * rowVC + above * upVC;
#ifdef DSPACE_NORMAL
  vec3 normal = upNormalVC - here.y * slopeColumnVC - here.z * slopeRowVC;
  float cosSlope = dot(normalize(normal), normalize(upNormalVC));
#endif
#endif
  gl_Position = VCDCMatrix * vec4(placedVC, 1.0);

#ifdef DSPACE_LABEL
  label = uint(objectLabel);
#else
  baseColor = objectColor;
#endif
#ifdef DSPACE_LIT
  positionVC = placedVC;
  normalVC = normal;
  surface = objectSurface;
#endif
#ifdef DSPACE_EMISSIVE
  emissive = objectEmissive;
#endif
#ifdef DSPACE_TEXTURE
  tcoord = originTexture + postTexture * place;
#endif
#ifdef DSPACE_LAYERS
  layerAt = originLayer + postLayer * place;
#endif
#ifdef DSPACE_MIXED
  styleAt = vec4(here.x, degrees(acos(clamp(cosSlope, -1.0, 1.0))), 0.0, 0.0);
#ifdef DSPACE_POLE
  poleDirection = vertical;
#elif defined(DSPACE_GRID)
  styleAt.zw = originGrid + postGrid * place;
#endif
#ifdef DSPACE_LEVELS
  awayAt = at - cameraPost;
#endif
#ifdef DSPACE_FACING
#ifdef DSPACE_SPHERE
  facingAt = vec3(-here.y / (distance * max(cosLatitude, 1e-6) * stepBase.x),
    -here.z / (distance * stepBase.y), 1.0);
#elif defined(DSPACE_POLE)
  facingAt = n;
#else
  facingAt = vec3(-(slopePlane * here.yz), 1.0);
#endif
#endif
#endif
#ifdef DSPACE_TRACKS
  trackAt = missing ? 0.0 : 2.0 * here.w;
#endif
#ifdef DSPACE_DETAILS
  detailAt = originDetail + vec4(postDetail0 * place, postDetail1 * place);
#endif
#ifdef DSPACE_HOLES
  hole = missing ? 1.0 : 0.0;
#endif
}
