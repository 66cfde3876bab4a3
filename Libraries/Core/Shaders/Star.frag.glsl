#version 330 core
//DSPACE::Defines
// The share of a star's light that falls on this sample: a Gaussian, integrated over its square.
flat in vec2 center;
flat in vec3 color; // of the whole star, as the centre's samples see it
uniform float spread;  // standard deviation [samples]
uniform vec4 slopes;   // x, y of a direction with depth 1, of a window coordinate: slope, then offset
layout(location = 0) out vec4 fragColor;

// Above 0, so that it is exposed; below a half, since no automatic exposure follows stars.
const float exposed = 1.0 / 65536.0;

// M. Abramowitz, I. Stegun, "Handbook of Mathematical Functions", 7.1.26: to 1.5e-7.
vec2 errorFunction(vec2 x)
{
  vec2 a = abs(x);
  vec2 t = 1.0 / (1.0 + 0.3275911 * a);
  vec2 p = ((((1.061405429 * t - 1.453152027) * t + 1.421413741) * t - 0.284496736) * t + 0.254829592) * t;
  return sign(x) * (1.0 - p * exp(-a * a));
}

void main()
{
  vec2 d = gl_FragCoord.xy - center;
  float scale = 0.70710678 / spread;
  vec2 share = 0.5 * (errorFunction((d + 0.5) * scale) - errorFunction((d - 0.5) * scale));
  vec2 slope = slopes.xy * gl_FragCoord.xy + slopes.zw;
  float further = 1.0 + dot(slope, slope); // this sample sees less of the sky: its cosine, cubed
  fragColor = vec4(color * (share.x * share.y * further * sqrt(further)), exposed);
}
