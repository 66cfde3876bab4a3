#version 330 core
//DSPACE::Defines
// The least that draws a line.
layout(location = 0) in vec3 position;
uniform mat4 clipFromObject;

void main()
{
  gl_Position = clipFromObject * vec4(position, 1.0);
}
