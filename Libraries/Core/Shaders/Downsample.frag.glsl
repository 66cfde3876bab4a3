#version 330 core
//DSPACE::Defines
// Mean of DSPACE_SAMPLES x DSPACE_SAMPLES texels, in linear light (the source decodes sRGB, the
// target encodes).
uniform sampler2D source;
layout(location = 0) out vec4 fragColor;

void main()
{
  ivec2 corner = ivec2(gl_FragCoord.xy) * DSPACE_SAMPLES;
  vec4 sum = vec4(0.0);
  for (int y = 0; y < DSPACE_SAMPLES; ++y)
  {
    for (int x = 0; x < DSPACE_SAMPLES; ++x)
    {
      sum += texelFetch(source, corner + ivec2(x, y), 0);
    }
  }
  fragColor = vec4(sum.rgb / float(DSPACE_SAMPLES * DSPACE_SAMPLES), 1.0);
}
