#version 330 core
//DSPACE::Defines
// Puts what was drawn into a depth texture under one label.
uniform sampler2D depths;
uniform int label;
layout(location = 0) out uint fragLabel;

void main()
{
  float d = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
  if (d <= 0.0)
  {
    discard; // nothing was drawn here
  }
  gl_FragDepth = d;
  fragLabel = uint(label);
}
