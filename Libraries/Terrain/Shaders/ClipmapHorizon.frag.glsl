// How much of the Sun's disc stands above the horizon of the ground.
#ifdef DSPACE_HORIZON
in vec2 horizonAt; // [rad] from the horizon up to the Sun's centre: of all ground, of distant ground
uniform float horizonRadius; // [rad] of the disc

// 0 to 1, a circular segment (dspace/horizon/LitFraction.h). `above` [rad]: of the disc's centre over a
// straight line.
float discLit(float above)
{
  float x = above / max(horizonRadius, 1e-7);
  if (abs(x) >= 1.0)
  {
    return x > 0.0 ? 1.0 : 0.0;
  }
  // asin() may be off by 1e-4 (the specification of GLSL).
  return clamp(0.5 + (x * sqrt(1.0 - x * x) + asin(x)) * 0.31830989, 0.0, 1.0);
}

#ifdef DSPACE_ANGLES
// Planes of numbers: between the posts the horizon of near ground is no straight line, so the
// triangles about a pixel are followed, and only that of distant ground is taken from the posts.
in vec2 postPlace; // in the window's posts
in vec3 verticalVC;
in vec3 acrossVC; // [m] a column, a row, along level ground
in vec3 downVC;
uniform float nearPosts; // HorizonOptions::near
uniform float bend; // [1/m] half the curvature of the body, 0 of a plane

float heightOf(vec2 post)
{
  vec4 here = postAt(windowTexel + ivec2(post), level);
  return here.w > 0.75 ? -1e9 : here.x; // a hole hides nothing
}

// Of the ground at an edge that the line of sight crosses after s metres, above height.
float tangentOf(vec2 first, vec2 second, float share, float height, float s)
{
  float there = min(heightOf(first), heightOf(second)) < -1e8
    ? -1e9 : mix(heightOf(first), heightOf(second), share);
  return (there - height) / s - s * bend;
}

// The tangent of the horizon that the triangles up to `reach` metres away make, in a direction in
// posts a metre. The pixel's own triangle is left to its plane.
float nearTangent(float height, vec2 way, float reach)
{
  float most = -1e6;
  float least = 0.02 / length(way);
  vec2 p = postPlace;
  vec2 ahead = mix(ceil(p) - 1.0, floor(p) + 1.0, greaterThan(way, vec2(0.0)));
  vec2 go = sign(way);
  for (float x = ahead.x; go.x != 0.0; x += go.x)
  {
    float s = (x - p.x) / way.x;
    if (s > reach)
    {
      break;
    }
    float y = p.y + s * way.y;
    float row = floor(y);
    most = s < least ? most
      : max(most, tangentOf(vec2(x, row), vec2(x, row + 1.0), y - row, height, s));
  }
  for (float y = ahead.y; go.y != 0.0; y += go.y)
  {
    float s = (y - p.y) / way.y;
    if (s > reach)
    {
      break;
    }
    float x = p.x + s * way.x;
    float column = floor(x);
    most = s < least ? most
      : max(most, tangentOf(vec2(column, y), vec2(column + 1.0, y), x - column, height, s));
  }
  float from = p.x - p.y; // whole on a diagonal
  float turn = way.x - way.y;
  float next = sign(turn);
  for (float d = turn > 0.0 ? floor(from) + 1.0 : ceil(from) - 1.0; next != 0.0; d += next)
  {
    float s = (d - from) / turn;
    if (s > reach)
    {
      break;
    }
    float x = p.x + s * way.x;
    float column = floor(x);
    most = s < least ? most
      : max(most, tangentOf(vec2(column, column - d), vec2(column + 1.0, column - d + 1.0),
          x - column, height, s));
  }
  return most;
}

// Of the triangle below the pixel, which the diagonal from the first to the last of four posts cuts.
float heightBelow()
{
  vec2 cell = min(floor(postPlace), lastPost - 1.0);
  vec2 part = postPlace - cell;
  vec2 corner = part.x >= part.y ? vec2(1.0, 0.0) : vec2(0.0, 1.0);
  float most = max(part.x, part.y);
  float least = min(part.x, part.y);
  return (1.0 - most) * heightOf(cell) + (most - least) * heightOf(cell + corner) +
    least * heightOf(cell + 1.0);
}

// In posts a metre.
vec2 wayOf(vec3 way)
{
  float cc = dot(acrossVC, acrossVC);
  float cr = dot(acrossVC, downVC);
  float rr = dot(downVC, downVC);
  vec2 b = vec2(dot(way, acrossVC), dot(way, downVC));
  return vec2(rr * b.x - cr * b.y, cc * b.y - cr * b.x) / (cc * rr - cr * cr);
}

float horizonLit()
{
  const float Apart = 0.005; // [rad] of the two azimuths between which the horizon is straight
  float lit = discLit(horizonAt.x);
  vec3 up = normalize(verticalVC);
  vec3 ahead = towardsSunVC - dot(towardsSunVC, up) * up;
  float levelPart = length(ahead);
  float across = length(acrossVC);
  float down = length(downVC);
  // Below a Sun near the zenith, and in levels of posts so large that the ground is not flat about
  // one, the posts' horizon stands.
  if (levelPart < 0.02 || max(across, down) > 4.0 * min(across, down) ||
    nearPosts * max(across, down) * bend > 0.01)
  {
    return lit;
  }
  ahead /= levelPart;
  vec3 aside = 0.5 * Apart * cross(up, ahead);
  vec2 way0 = wayOf(ahead - aside);
  vec2 way1 = wayOf(ahead + aside);
  // Where the level is blended with the coarser one, distant ground begins later: at its posts.
  float reach = (coarserShare(postPlace) > 0.0 ? 2.0 : 1.0) * nearPosts / length(way0);
  vec2 last0 = postPlace + reach * way0;
  vec2 last1 = postPlace + reach * way1;
  bool within = all(greaterThanEqual(min(last0, last1), firstPost + 1.0)) &&
    all(lessThanEqual(max(last0, last1), lastPost - 1.0));
  if (!within) // or no numbers
  {
    return lit;
  }
  float height = heightBelow();
  float horizon0 = atan(nearTangent(height, way0, reach));
  float horizon1 = atan(nearTangent(height, way1, reach));
  float slope = (horizon1 - horizon0) / (Apart * levelPart);
  float above = atan(dot(towardsSunVC, up), levelPart) - 0.5 * (horizon0 + horizon1);
  return min(discLit(horizonAt.y), discLit(above / sqrt(1.0 + slope * slope)));
}
#else
float horizonLit()
{
  return discLit(horizonAt.x);
}
#endif
#endif
