#version 330 core
//DSPACE::Defines
// Which object a trajectory's pixel belongs to.
in float elapsed; // from the scene's time [s]
uniform vec2 window; // how much before and after the scene's time is drawn [s]
uniform int label;
layout(location = 0) out uint fragLabel;

void main()
{
  if (elapsed < -window.x || elapsed > window.y)
  {
    discard;
  }
  fragLabel = uint(label);
}
