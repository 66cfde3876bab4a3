#version 330 core
//DSPACE::Defines
// The pixels of a picture through a lens that lie in one source view (ViewLens.h). The source
// decodes sRGB, the target encodes.
uniform sampler2D source;
uniform sampler2D places; // ViewLens::Place, rows from the top
uniform int number;       // of the source
layout(location = 0) out vec4 fragColor;

const int MOST_TAPS = 5; // a side of a footprint

vec3 between(vec2 place, ivec2 size)
{
  place = clamp(place, vec2(0.0), vec2(size) - 1.001);
  ivec2 first = ivec2(place);
  vec2 part = place - vec2(first);
  ivec2 corner = ivec2(first.x, size.y - 1 - first.y);
  vec3 top = mix(texelFetch(source, corner, 0).rgb, texelFetch(source, corner + ivec2(1, 0), 0).rgb,
                 part.x);
  corner.y -= 1;
  vec3 bottom = mix(texelFetch(source, corner, 0).rgb,
                    texelFetch(source, corner + ivec2(1, 0), 0).rgb, part.x);
  return mix(top, bottom, part.y);
}

void main()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  vec4 place = texelFetch(places, ivec2(pixel.x, textureSize(places, 0).y - 1 - pixel.y), 0);
  if (int(place.z) != number)
  {
    discard;
  }
  ivec2 size = textureSize(source, 0);
  int taps = clamp(int(place.w + 0.5), 1, MOST_TAPS);
  float reach = taps == 1 ? 0.0 : place.w;
  vec3 sum = vec3(0.0);
  for (int y = 0; y < taps; ++y)
  {
    for (int x = 0; x < taps; ++x)
    {
      vec2 offset = ((vec2(x, y) + 0.5) / float(taps) - 0.5) * reach; // evenly over the footprint
      sum += between(place.xy + offset, size);
    }
  }
  fragColor = vec4(sum / float(taps * taps), 1.0);
}
