// The heights of one clipmap level: posts are fetched, and near the level's outline turned into the
// next coarser level's (Losasso and Hoppe 2004).
#ifdef DSPACE_HORIZON
uniform sampler2DArray horizons; // ClipmapHorizon's texels, as `posts`
#endif
uniform ivec2 coarseTexel; // of the window's first post in the coarser level
uniform vec2 endPost; // where the lattice ends: nowhere around a body

struct Ground
{
  vec4 here; // as in `posts`
  bool missing;
#ifdef DSPACE_HORIZON
  vec2 horizon;
#endif
};

#ifdef DSPACE_HORIZON
vec2 horizonOf(ivec2 texel, int layer)
{
  return texelFetch(horizons, ivec3(texel & texelMask, layer), 0).rg;
}
#endif

// At a post of the window.
Ground groundAt(vec2 at)
{
  ivec2 post = ivec2(at);
  Ground ground;
  ground.here = postAt(windowTexel + post, level);
  ground.missing = ground.here.w > 0.75;
#ifdef DSPACE_HORIZON
  ground.horizon = horizonOf(windowTexel + post, level);
#endif
  float coarser = coarserShare(at);
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
      ground.here = mix(ground.here, 0.5 * (there0 + there1), coarser);
      ground.missing = ground.missing && coarser < 1.0;
#ifdef DSPACE_HORIZON
      ground.horizon = mix(ground.horizon, 0.5 * (horizonOf(coarseTexel + before, level + 1) +
        horizonOf(coarseTexel + after, level + 1)), coarser);
#endif
    }
  }
  return ground;
}
