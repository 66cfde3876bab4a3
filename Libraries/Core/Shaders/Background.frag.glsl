#version 330 core
//DSPACE::Defines
// A vertical gradient between two colours given in sRGB display values, as a picture shows them.
uniform vec3 bottomColor;
uniform vec3 topColor;
uniform float height;
layout(location = 0) out vec4 fragColor;

void main()
{
  vec3 c = mix(bottomColor, topColor, (gl_FragCoord.y) / height);
  c = mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
  fragColor = vec4(c, DSPACE_ALPHA);
}
