#version 330 core
//DSPACE::Defines
// A picture in linear light to one that is shown: exposed where its alpha is above 0, then through
// the curve. The target encodes sRGB.
uniform sampler2D source;
uniform sampler2D depths;
uniform float exposure;
layout(location = 0) out vec4 fragColor;

// K. Narkowicz, "ACES Filmic Tone Mapping Curve" (2015).
vec3 filmic(vec3 x)
{
  return (x * (2.51 * x + 0.03)) / (x * (2.43 * x + 0.59) + 0.14);
}

void main()
{
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 light = texelFetch(source, texel, 0);
  if (light.a > 0.0)
  {
    light.rgb = clamp(light.rgb * exposure, 0.0, 1e6);
#ifdef DSPACE_FILMIC
    light.rgb = filmic(light.rgb);
#endif
  }
  fragColor = vec4(light.rgb, 1.0);
  gl_FragDepth = texelFetch(depths, texel, 0).r;
}
