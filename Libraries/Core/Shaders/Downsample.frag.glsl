//DSPACE::Version
// Mean of samples x samples texels, in linear light (the source decodes sRGB, the target encodes).
uniform sampler2D source;
uniform int samples;
layout(location = 0) out vec4 fragColor;

void main()
{
  ivec2 corner = ivec2(gl_FragCoord.xy) * samples;
  vec4 sum = vec4(0.0);
  for (int y = 0; y < samples; ++y)
  {
    for (int x = 0; x < samples; ++x)
    {
      sum += texelFetch(source, corner + ivec2(x, y), 0);
    }
  }
  fragColor = vec4(sum.rgb / float(samples * samples), 1.0);
}
