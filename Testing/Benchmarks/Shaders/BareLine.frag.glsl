#version 330 core
//DSPACE::Defines
uniform vec4 color; // linear light
layout(location = 0) out vec4 fragColor;

void main()
{
  fragColor = color;
}
