#version 330 core
//DSPACE::Defines
// A trajectory that does not follow the scene's time, opaque.
in vec4 pointColor;
uniform vec4 look; // linear light, and opacity
uniform float alpha; // 0: a display value in a picture that is exposed later
layout(location = 0) out vec4 fragColor;

void main()
{
  fragColor = vec4(pointColor.rgb * look.rgb, alpha);
}
