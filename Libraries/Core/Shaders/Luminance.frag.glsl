#version 330 core
//DSPACE::Defines
// Luminance (ITU-R BT.709) at the middles of blocks of a picture in linear light; below 0 where
// no lit surface is: stars are exposed, with an alpha of nearly 0.
uniform sampler2D source;
layout(location = 0) out vec4 fragColor;

void main()
{
  ivec2 size = textureSize(source, 0);
  ivec2 grid = min(size, ivec2(DSPACE_GRID));
  ivec2 texel = ((2 * ivec2(gl_FragCoord.xy) + 1) * size) / (2 * grid);
  vec4 light = texelFetch(source, texel, 0);
  float luminance = dot(light.rgb, vec3(0.2126, 0.7152, 0.0722));
  fragColor = vec4(light.a > 0.5 ? luminance : -1.0, 0.0, 0.0, 1.0);
}
