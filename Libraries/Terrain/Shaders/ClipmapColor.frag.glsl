// What lies over a terrain's own colour, from the ground up: the parts before this one say how.
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
#ifdef DSPACE_RAMP
  color.rgb = withRamp(color.rgb);
#endif
#ifdef DSPACE_LEVELS
  color.rgb = withLevels(color.rgb);
#endif
#ifdef DSPACE_CONTOURS
  color.rgb = withContours(color.rgb);
#endif
#ifdef DSPACE_GRID
  color.rgb = withGrid(color.rgb);
#endif
#ifdef DSPACE_MARKS
  color.rgb = layered(color.rgb, DSPACE_MARKS);
#endif
  return color;
}
