// Linear light as a picture shows it, before sRGB encodes it; ViewLook.h has the rules.
vec3 tonedLight(vec3 light, float exposure, bool filmic)
{
  vec3 x = clamp(light * exposure, 0.0, 1e6);
  // K. Narkowicz, "ACES Filmic Tone Mapping Curve" (2015).
  return filmic ? (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14) : x;
}
