// What lies over a terrain's own colour, from the ground up: the parts before this one say how.

// A colour under the false colour and what lies over that.
vec3 withStyle(vec3 color)
{
#ifdef DSPACE_RAMP
  color = withRamp(color);
#endif
#ifdef DSPACE_LEVELS
  color = withLevels(color);
#endif
#ifdef DSPACE_CONTOURS
  color = withContours(color);
#endif
#ifdef DSPACE_GRID
  color = withGrid(color);
#endif
#ifdef DSPACE_MARKS
  color = layered(color, DSPACE_MARKS);
#endif
  return color;
}

#ifdef DSPACE_UNSHADED
// What the style adds to a shaded colour, and how much of that is seen: each part mixes the colour
// below with its own.
vec4 unshadedStyle()
{
  vec3 over = withStyle(vec3(0.0));
  return vec4(over, withStyle(vec3(1.0)).x - over.x);
}
#endif

vec4 mixedColor(vec4 color)
{
#ifdef DSPACE_POLE_TEXTURE
  color *= poleTexture();
#endif
#ifdef DSPACE_PAINT
  color.rgb = layered(color.rgb, DSPACE_PAINT);
#endif
#ifdef DSPACE_DETAILS
  color.rgb = withDetails(color.rgb);
#endif
#ifdef DSPACE_TRACKS
  color.rgb = mix(color.rgb, trackColor.rgb, trackColor.a * clamp(trackAt, 0.0, 1.0));
#endif
#ifdef DSPACE_BRIGHTNESS
  color.rgb *= groundBrightness;
#endif
#ifndef DSPACE_UNSHADED
  color.rgb = withStyle(color.rgb);
#endif
  return color;
}
