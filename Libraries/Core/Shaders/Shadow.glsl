// How much of the Sun's disc is seen from a place, by the shadow maps (dspace/render/ShadowMaps.h).
// Lengths are metres along the light's axes: U, V across its rays, S towards the Sun.
#if DSPACE_CASCADES > 0
uniform sampler2DArray shadowMaps; // heights along S, 0 to 1
uniform mat3 sunAxesVC; // view axes to light axes
uniform vec4 shadowPlace[DSPACE_CASCADES]; // centre; half its side; depth of the view where it ends
uniform vec2 shadowRange[DSPACE_CASCADES]; // the height that is 0; the height of 1 above it
uniform int cascadeColors; // 1: each map's part of the view in a colour of its own
uniform float sunRadius; // tangent of the disc's angular radius

// A receiver: its place, and how its plane rises along U and V.
struct ShadowReceiver
{
  vec3 place;
  vec2 slope;
};

const float shadowReach = 7.0; // texels: half the widest penumbra that one map resolves

// How far above the receiver's plane a texel's surface is.
float shadowHeight(int k, ShadowReceiver at, vec2 offset, float texel, ivec2 cell)
{
  float stored = texelFetch(shadowMaps, ivec3(cell, k), 0).r;
#if defined(DSPACE_GROUND_MAPS) && !defined(DSPACE_HORIZON)
  stored = max(stored, texelFetch(shadowMaps, ivec3(cell, k + DSPACE_CASCADES), 0).r);
#endif
  // Nothing is there at 0.
  float height = stored > 0.0 ? shadowRange[k].x + shadowRange[k].y * stored : -3e38;
  return height - at.place.z - dot(at.slope, offset * texel);
}

// The share of blockers between two heights above the receiver.
float shadowBlocked(float height, float from, float to)
{
  return height > from && height <= to ? 1.0 : 0.0;
}

// The lit fraction by map k alone, of blockers from `from` to `to` above the receiver.
float cascadeLit(int k, ShadowReceiver at, float from, float to)
{
  int size = textureSize(shadowMaps, 0).x;
  vec4 place = shadowPlace[k];
  float texel = 2.0 * place.z / float(size);
  vec2 position = ((at.place.xy - place.xy) / place.z * 0.5 + 0.5) * float(size); // texels
  vec2 inner = position - 0.5;
  ivec2 base = ivec2(floor(inner));
  vec2 part = inner - vec2(base);
  from = max(from, texel * (0.5 + 0.25 * min(length(at.slope), 8.0)));
  vec4 around; // texels about the place
  float sum = 0.0;
  float blockers = 0.0;
  for (int i = 0; i < 4; ++i)
  {
    ivec2 corner = ivec2(i & 1, i >> 1);
    float height = shadowHeight(k, at, vec2(corner) - part, texel, base + corner);
    around[i] = shadowBlocked(height, from, to);
    sum += around[i] * height;
    blockers += around[i];
  }
  // Blockers over the widest penumbra.
  float rise = texel / max(sunRadius, 1e-9); // of the edge of the disc, a texel aside
  for (int i = 0; i < 12; ++i)
  {
    float angle = 2.39996323 * float(i); // the golden angle: points fill a disc evenly (Vogel 1979)
    vec2 offset = shadowReach * sqrt((float(i) + 0.5) / 12.0) * vec2(cos(angle), sin(angle));
    ivec2 cell = ivec2(floor(position + offset));
    offset = vec2(cell) + 0.5 - position;
    float height = shadowHeight(k, at, offset, texel, cell);
    // Only what stands before the disc: the ground beside a place rises above its plane, too.
    float blocked = shadowBlocked(height, max(from, (length(offset) - 1.0) * rise), to);
    sum += blocked * height;
    blockers += blocked;
  }
  if (blockers == 0.0)
  {
    return 1.0;
  }
  float wide = min(sunRadius * sum / blockers / texel, shadowReach); // half the penumbra, in texels
  if (wide < 1.0)
  {
    return 1.0 - mix(mix(around.x, around.y, part.x), mix(around.z, around.w, part.x), part.y);
  }
  float hidden = 0.0;
  for (int i = 0; i < 32; ++i)
  {
    float angle = 2.39996323 * float(i);
    vec2 offset = wide * sqrt((float(i) + 0.5) / 32.0) * vec2(cos(angle), sin(angle));
    ivec2 cell = ivec2(floor(position + offset));
    offset = vec2(cell) + 0.5 - position;
    hidden += shadowBlocked(shadowHeight(k, at, offset, texel, cell),
      max(from, (length(offset) - 1.0) * rise), to);
  }
  return 1.0 - hidden / 32.0;
}

// What the colours of a place are multiplied by.
vec3 cascadeTint(vec3 positionVC)
{
  vec3 tint = vec3(1.0);
  for (int k = DSPACE_CASCADES - 1; k >= 0 && cascadeColors == 1; --k)
  {
    tint = -positionVC.z > shadowPlace[k].w ? tint
      : vec3(k % 4 != 1 && k % 4 != 2 ? 1.0 : 0.35, k % 4 != 0 && k % 4 != 2 ? 1.0 : 0.35,
          k % 4 > 1 ? (k % 4 == 3 ? 0.35 : 1.0) : 0.35);
  }
  return tint;
}

// Where the view's maps reach. `planeVC`: the normal of the surface as it is drawn, of any length.
float cascadesLit(vec3 positionVC, vec3 planeVC)
{
  ShadowReceiver at;
  at.place = sunAxesVC * positionVC;
  vec3 n = normalize(sunAxesVC * planeVC);
  at.slope = -n.xy / max(abs(n.z), 0.02) * sign(n.z);
  float depth = -positionVC.z;
  float lit = 1.0;
  float from = 0.0;
  for (int k = 0; k < DSPACE_CASCADES; ++k)
  {
    if (depth <= shadowPlace[k].w)
    {
      // Each map takes the blockers whose penumbra it resolves, and the last one all.
      float texel = 2.0 * shadowPlace[k].z / float(textureSize(shadowMaps, 0).x);
      float to = k == DSPACE_CASCADES - 1 ? 3e38 : shadowReach * texel / max(sunRadius, 1e-9);
      lit = min(lit, cascadeLit(k, at, from, to));
      from = to;
    }
  }
  return lit;
}
#endif

#ifdef DSPACE_HORIZON
float horizonLit(); // of the terrain's own page, ClipmapHorizon.frag
#endif
#if DSPACE_CASCADES > 0 || defined(DSPACE_HORIZON)
// Ground that knows its horizon takes from the maps what other things throw on it.
float sunLit(vec3 positionVC, vec3 planeVC)
{
  float lit = 1.0;
#if DSPACE_CASCADES > 0
  lit = cascadesLit(positionVC, planeVC);
#endif
#ifdef DSPACE_HORIZON
  lit = min(lit, horizonLit());
#endif
  return lit;
}
#endif
