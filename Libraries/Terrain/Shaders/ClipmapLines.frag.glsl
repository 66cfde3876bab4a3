// Contours and grid lines, as wide as is asked for in pixels.
// How much of a pixel is a line at whole values of f; lines closer than two pixels fade away.
float lineAt(float f, float halfWidth)
{
  float pixel = max(fwidth(f), 1e-12);
  float away = abs(fract(f - 0.5) - 0.5) / pixel;
  return (1.0 - smoothstep(halfWidth - 0.5, halfWidth + 0.5, away)) *
    clamp(2.0 - 4.0 * pixel, 0.0, 1.0);
}

#ifdef DSPACE_CONTOURS
uniform vec2 contours; // lines a metre, half width [pixels]
uniform vec4 contourColor; // linear light, opacity

vec3 withContours(vec3 color)
{
  return mix(color, contourColor.rgb, contourColor.a * lineAt(styleAt.x * contours.x, contours.y));
}
#endif
#ifdef DSPACE_GRID
uniform float gridWidth; // half [pixels]
uniform vec4 gridColor;
#ifdef DSPACE_POLE
uniform float gridInterval; // [deg]
#endif

vec3 withGrid(vec3 color)
{
#ifdef DSPACE_POLE
  vec3 lines = degreesAt() / gridInterval;
  // Derivatives are undefined where neighbouring pixels take different branches: both lines first.
  float jumping = lineAt(lines.x, gridWidth);
  float other = lineAt(lines.z, gridWidth);
  float meridian = fwidth(lines.x) < fwidth(lines.z) ? jumping : other;
  float line = max(meridian, lineAt(lines.y, gridWidth));
#else
  float line = max(lineAt(styleAt.z, gridWidth), lineAt(styleAt.w, gridWidth));
#endif
  return mix(color, gridColor.rgb, gridColor.a * line);
}
#endif
