// How much of the Sun's disc is seen from a place, by the shadow maps (dspace/render/ShadowMaps.h).
// Lengths are metres along the light's axes: U, V across its rays, S towards the Sun.
#if DSPACE_CASCADES > 0 || defined(DSPACE_HORIZON) || defined(DSPACE_LIT_MASK)
#define DSPACE_SHADOWED
#endif
#if DSPACE_CASCADES > 0
uniform sampler2DArray shadowMaps; // heights along S, 0 to 1
uniform sampler2DArray shadowTops; // dspace/render/shadows/CasterTiles.h
uniform mat3 sunAxesVC; // view axes to light axes
uniform vec4 shadowPlace[DSPACE_CASCADES]; // centre; half its side; depth of the view where it ends
uniform vec2 shadowRange[DSPACE_CASCADES]; // the height that is 0; the height of 1 above it
// Of blockers above a receiver: CascadeFit::Reach(), Beginning(); the depth down to which the map
// before it reaches.
uniform vec3 shadowReaches[DSPACE_CASCADES];
uniform int shadowSize; // texels a side of each map
uniform int groundSize; // of the maps of ground
#if DSPACE_GROUNDS > 0
uniform int ownGround; // its maps are not those of this receiver; -1: none
#endif
uniform int cascadeColors; // 1: each map's part of the view in a colour of its own
uniform float sunRadius; // tangent of the disc's angular radius

// A receiver: its place, and how its plane rises along U and V.
struct ShadowReceiver
{
  vec3 place;
  vec2 slope;
};

// One map, of objects or of the ground.
struct ShadowMap
{
  vec4 place; // shadowPlace
  vec2 range;
  int size;
  ivec3 corner; // its first texel, and its layer
  vec2 heights; // of the blockers that it takes, above the receiver's plane
  bool ground;
};

const float shadowReach = 7.0; // texels: half the widest penumbra that one map resolves

// Of the 2 x 2 texels from a first one on, in the order of textureGather: how far their surfaces are
// above the receiver's plane. `aside`: from the place to the middle of the first, in texels.
vec4 shadowHeights(ShadowMap map, ShadowReceiver at, vec2 aside, float texel, ivec2 first)
{
  first = clamp(first, ivec2(0), ivec2(map.size - 2));
  vec2 middle = vec2(map.corner.xy + first + 1) / float(shadowSize);
  vec4 stored = textureGather(shadowMaps, vec3(middle, float(map.corner.z)));
  // Nothing is there at 0.
  vec4 heights = mix(map.range.x + map.range.y * stored, vec4(-3e38), equal(stored, vec4(0.0)));
  vec2 slope = at.slope * texel;
  return heights - at.place.z - dot(slope, aside) - vec4(slope.y, slope.x + slope.y, slope.x, 0.0);
}

// The direction of point i + 1 of a spiral from that of point i: the golden angle fills a disc evenly
// (Vogel 1979).
vec2 nextTurn(vec2 turn)
{
  return vec2(-0.73736888 * turn.x - 0.67549029 * turn.y, 0.67549029 * turn.x - 0.73736888 * turn.y);
}

// The lit fraction by one map alone. One loop, whose length depends on the place: renderers without a
// GPU run all branches, but leave a loop that is over for all of their pixels.
float mapLit(ShadowMap map, ShadowReceiver at)
{
  float texel = 2.0 * map.place.z / float(map.size);
  vec2 position = ((at.place.xy - map.place.xy) / map.place.z * 0.5 + 0.5) * float(map.size); // texels
  vec2 part = fract(position - 0.5);
  float rise = texel / max(sunRadius, 1e-9); // of the edge of the disc, a texel aside
  float wide = shadowReach; // half the penumbra, in texels
  float sharp = 0.0; // hidden by the four texels about the place
  float sum = 0.0; // of the heights of blockers
  float blockers = 0.0;
  float hidden = 0.0; // of the points in the penumbra
  vec2 turn = vec2(1.0, 0.0);
  // Squares of four texels: about the place, 5 over the widest penumbra, and 12 over the real one.
  int last = map.heights.x < map.heights.y ? 6 : 0;
  for (int i = 0; i < last; ++i)
  {
    bool filtering = i >= 6;
    float share = filtering ? (float(i) - 5.5) / 12.0 : i == 0 ? 0.0 : (float(i) - 0.5) / 5.0;
    vec2 point = position - 0.5 + wide * sqrt(share) * turn;
    turn = i == 0 || i == 5 ? vec2(1.0, 0.0) : nextTurn(turn);
    vec2 first = floor(point);
    vec2 aside = first + 0.5 - position;
    vec4 heights = shadowHeights(map, at, aside, texel, ivec2(first));
    // Only what stands before the disc: the ground beside a place rises above its plane, too.
    vec4 u = aside.x + vec4(0.0, 1.0, 1.0, 0.0);
    vec4 v = aside.y + vec4(1.0, 1.0, 0.0, 0.0);
    vec4 from = max(vec4(map.heights.x), i == 0 ? vec4(0.0) : (sqrt(u * u + v * v) - 1.7) * rise);
    vec4 blocked = vec4(greaterThan(heights, from)) * vec4(lessThanEqual(heights, vec4(map.heights.y)));
    float count = dot(blocked, vec4(1.0));
    vec4 weight = vec4(1.0 - part.x, part.x, part.x, 1.0 - part.x) * vec4(part.y, part.y, 1.0 - part.y, 1.0 - part.y);
    sharp += i == 0 ? dot(blocked, weight) : 0.0;
    sum += filtering ? 0.0 : dot(blocked, mix(vec4(0.0), heights, greaterThan(blocked, vec4(0.0))));
    blockers += filtering ? 0.0 : count;
    hidden += filtering ? count : 0.0;
    if (i == 5)
    {
      wide = min(sunRadius * sum / max(blockers, 1.0) / texel, shadowReach);
      last = blockers > 0.0 && wide >= 1.0 ? 18 : 6;
    }
  }
  // Ground beside the foot of a wall is above the wall's plane a texel further down: where the place's own
  // texel is free, its neighbours alone do not darken it.
  sharp = map.ground ? max(2.0 * sharp - 1.0, 0.0) : sharp;
  return 1.0 - (last > 6 ? hidden / 48.0 : sharp);
}

// Each map takes the blockers whose penumbra it resolves, and the last one all: from x to y above the
// receiver's plane. steep: the length of its slope. coarser: how much larger texels are.
vec2 cascadeHeights(int k, float coarser, float depth, float steep)
{
  vec3 reaches = shadowReaches[k] * vec3(coarser, coarser, 1.0);
  float texel = 2.0 * shadowPlace[k].z / float(shadowSize) * coarser;
  return vec2(max(depth <= reaches.z ? reaches.y : 0.0, texel * (0.5 + 0.25 * min(steep, 8.0))),
    k == DSPACE_CASCADES - 1 ? 3e38 : reaches.x);
}

// What the colours of a place are multiplied by.
vec3 cascadeTint(vec3 positionVC)
{
  vec3 tint = vec3(1.0);
  for (int k = cascadeColors == 1 ? DSPACE_CASCADES - 1 : -1; k >= 0; --k)
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
  float steep = length(at.slope);
  float grounds = float(shadowSize) / float(groundSize);
  int maps = 0; // bits: those that may hold blockers, of objects and then of each ground
  int count = 0;
  for (int k = 0; k < DSPACE_CASCADES; ++k)
  {
    vec4 place = shadowPlace[k];
    ivec2 tile = ivec2(floor((at.place.xy - place.xy) * (32.0 / place.z) + 32.0)); // of 64 x 64
    float above = at.place.z - steep * 3.0 * place.z / float(shadowSize); // the texels about the place
    bool any = depth <= place.w
      && texelFetch(shadowTops, ivec3(tile, k), 0).r > above + cascadeHeights(k, 1.0, depth, steep).x;
    maps |= any ? 1 << k : 0;
    count += any ? 1 : 0;
#if DSPACE_GROUNDS > 0
    above = at.place.z - steep * 3.0 * place.z / float(groundSize);
    for (int g = 0; g < DSPACE_GROUNDS; ++g)
    {
      int layer = k + DSPACE_CASCADES * (1 + g);
      any = g != ownGround && depth <= place.w && texelFetch(shadowTops, ivec3(tile, layer), 0).r
        > above + cascadeHeights(k, grounds, depth, steep).x;
      maps |= any ? 1 << layer : 0;
      count += any ? 1 : 0;
    }
#endif
  }
  float lit = 1.0;
  for (int i = 0; i < count; ++i)
  {
    // The last of them. Constant indices: renderers without a GPU are slow with others.
    ShadowMap map;
    int bit = 0;
    for (int k = 0; k < DSPACE_CASCADES; ++k)
    {
#if DSPACE_GROUNDS > 0
      for (int g = 0; g < DSPACE_GROUNDS; ++g)
      {
        int layer = k + DSPACE_CASCADES * (1 + g);
        if ((maps >> layer & 1) == 1)
        {
          bit = 1 << layer;
          map = ShadowMap(shadowPlace[k], shadowRange[k], groundSize,
            ivec3(k % 4 * groundSize, k / 4 * groundSize, DSPACE_CASCADES + g),
            cascadeHeights(k, grounds, depth, steep), true);
        }
      }
#endif
      if ((maps >> k & 1) == 1)
      {
        bit = 1 << k;
        map = ShadowMap(shadowPlace[k], shadowRange[k], shadowSize, ivec3(0, 0, k),
          cascadeHeights(k, 1.0, depth, steep), false);
      }
    }
    maps &= ~bit;
    lit = min(lit, mapLit(map, at));
  }
  return lit;
}
#endif

#ifdef DSPACE_LIT_MASK
uniform sampler2D litMask; // SunMask.frag
#endif
#ifdef DSPACE_HORIZON
float discLit(float above); // of the terrain's own page, ClipmapHorizon.frag
float horizonLit();
#endif
#ifdef DSPACE_SHADOWED
uniform int litColors; // 1: the lit fraction in false colours, in place of light

// Linear light of a lit fraction.
vec3 litColor(float lit)
{
  return mix(mix(vec3(0.01, 0.02, 0.25), vec3(0.02, 0.4, 0.2), min(2.0 * lit, 1.0)), vec3(1.0, 0.75, 0.05),
    max(2.0 * lit - 1.0, 0.0));
}

// Ground that knows its horizon takes from the maps what other things and other ground throw on it.
float sunLit(vec3 positionVC, vec3 planeVC)
{
  float lit = 1.0;
#if DSPACE_CASCADES > 0
  lit = cascadesLit(positionVC, planeVC);
#endif
#ifdef DSPACE_LIT_MASK
  lit = texelFetch(litMask, ivec2(gl_FragCoord.xy), 0).r;
#endif
#ifdef DSPACE_HORIZON
  lit = min(lit, horizonLit());
#endif
  return lit;
}
#endif
