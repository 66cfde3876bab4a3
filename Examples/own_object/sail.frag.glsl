// Goes into Dspace's Surface.frag.glsl: the function that Feature::Mixed asks for.
in vec2 sheet;
vec4 mixedColor(vec4 color)
{
  vec2 seam = abs(fract(sheet * 8.0) - 0.5);
  bool dark = max(seam.x, seam.y) > 0.47 || abs(sheet.x - sheet.y) < 0.004 ||
    abs(sheet.x + sheet.y - 1.0) < 0.004;
  return dark ? vec4(0.25 * color.rgb, color.a) : color;
}
