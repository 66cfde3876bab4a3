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

float horizonLit()
{
  return discLit(horizonAt.x);
}
#endif
