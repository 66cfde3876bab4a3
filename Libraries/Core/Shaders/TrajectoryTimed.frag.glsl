#version 330 core
//DSPACE::Defines
// A trajectory of which a window of time is seen, or that fades.
in vec4 pointColor;
in float elapsed; // from the scene's time [s]
uniform vec4 look;   // linear light, and opacity
uniform float alpha; // 0: a display value in a picture that is exposed later
uniform vec2 window; // how much before and after the scene's time is drawn [s]
uniform vec2 fading; // how long before and after it opacity is 0 [s]; 0: no fading
uniform float ahead; // factor on the opacity of what is later
uniform int dithered; // 1: opacity is the share of samples that are drawn
layout(location = 0) out vec4 fragColor;

// B. Bayer's matrix of 4 x 4.
const float thresholds[16] = float[16](0.5, 8.5, 2.5, 10.5, 12.5, 4.5, 14.5, 6.5, 3.5, 11.5, 1.5, 9.5, 15.5, 7.5, 13.5, 5.5);

void main()
{
  if (elapsed < -window.x || elapsed > window.y)
  {
    discard;
  }
  float opacity = look.a * pointColor.a;
  float length = elapsed > 0.0 ? fading.y : fading.x;
  if (length > 0.0)
  {
    opacity *= clamp(1.0 - abs(elapsed) / length, 0.0, 1.0);
  }
  if (elapsed > 0.0)
  {
    opacity *= ahead;
  }
  if (dithered == 1)
  {
    ivec2 cell = ivec2(gl_FragCoord.xy) & 3;
    if (16.0 * opacity < thresholds[4 * cell.y + cell.x])
    {
      discard;
    }
    fragColor = vec4(pointColor.rgb * look.rgb, alpha);
  }
  else
  {
    fragColor = vec4(pointColor.rgb * look.rgb, opacity);
  }
}
