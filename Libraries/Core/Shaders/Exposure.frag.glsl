#version 330 core
//DSPACE::Defines
// A picture in linear light to one that is shown: exposed where its alpha is above 0, then through
// the curve. The target encodes sRGB.
uniform sampler2D source;
uniform sampler2D depths;
uniform float exposure;
uniform int filmic; // 1: the filmic curve
layout(location = 0) out vec4 fragColor;

//DSPACE::Tone

void main()
{
  ivec2 texel = ivec2(gl_FragCoord.xy);
  vec4 light = texelFetch(source, texel, 0);
  if (light.a > 0.0)
  {
    light.rgb = tonedLight(light.rgb, exposure, filmic != 0);
  }
  fragColor = vec4(light.rgb, 1.0);
  gl_FragDepth = texelFetch(depths, texel, 0).r;
}
