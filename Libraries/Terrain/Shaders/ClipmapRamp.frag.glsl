// Colours by height or slope (DSPACE_RAMP alone), by aspect, or by the normal.
#ifdef DSPACE_RAMP
uniform sampler2D rampTexture;
uniform vec4 ramp; // value of its left edge, 1 / range, opacity, 0: by height, 1: by slope
#endif
#ifdef DSPACE_FACING
in vec3 facingAt;

// The unit normal: local east, north, up.
vec3 facingHere()
{
#ifdef DSPACE_POLE
  vec3 up = normalize(poleDirection);
  vec3 east = normalize(poleSign * vec3(-up.y, up.x, 0.0));
  return normalize(vec3(dot(facingAt, east), dot(facingAt, cross(up, east)), dot(facingAt, up)));
#else
  return normalize(facingAt);
#endif
}
#endif
#ifdef DSPACE_RAMP
vec3 withRamp(vec3 color)
{
#if defined(DSPACE_BY_NORMAL)
  return mix(color, linearFromSrgb(0.5 + 0.5 * facingHere()), ramp.z);
#elif defined(DSPACE_BY_ASPECT)
  // Level ground has none. Not a smaller image of the ramp where 360 degrees become 0.
  vec3 facing = facingHere();
  float aspect = degrees(atan(facing.x, facing.y));
  aspect += aspect < 0.0 ? 360.0 : 0.0;
  return mix(color, textureLod(rampTexture, vec2((aspect - ramp.x) * ramp.y, 0.5), 0.0).rgb,
    dot(facing.xy, facing.xy) > 1e-12 ? ramp.z : 0.0);
#else
  float value = ramp.w == 0.0 ? styleAt.x : styleAt.y;
  return mix(color, texture(rampTexture, vec2((value - ramp.x) * ramp.y, 0.5)).rgb, ramp.z);
#endif
}
#endif
