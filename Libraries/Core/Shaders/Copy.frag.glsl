#version 330 core
//DSPACE::Defines
// Hands a texture's texel on, for the blend function to add it.
uniform sampler2D source;
layout(location = 0) out vec4 fragColor;

void main()
{
  fragColor = texelFetch(source, ivec2(gl_FragCoord.xy), 0);
}
