#version 330 core
//DSPACE::Defines
// A point of a trajectory. Positions and times are pairs of floats, whose sum has the digits of doubles: their
// differences from the camera and from the scene's time are exact where they are small.
layout(location = 0) in vec3 high; // in the object's frame [m]
layout(location = 1) in vec3 low;
layout(location = 2) in vec2 time; // high and low [s]
layout(location = 3) in vec4 color; // sRGB and opacity
uniform vec3 eyeHigh; // the camera in the object's frame [m]
uniform vec3 eyeLow;
uniform vec2 now; // high and low [s]
uniform mat3 viewFromObject;
uniform mat4 clipFromView;
uniform float pointSize; // [samples]
out vec4 pointColor; // linear light, and opacity
out float elapsed;   // from the scene's time [s]

vec3 linear(vec3 c)
{
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// What a compiler does not move additions across: it may add eyeHigh and eyeLow first, which loses eyeLow.
vec3 kept(vec3 difference)
{
  return clamp(difference, -1e30, 1e30);
}

void main()
{
  vec3 p = kept(high - eyeHigh) + kept(low - eyeLow);
  gl_Position = clipFromView * vec4(viewFromObject * p, 1.0);
  gl_PointSize = pointSize;
  vec2 since = kept(vec3(time - now, 0.0)).xy;
  elapsed = since.x + since.y;
  pointColor = vec4(linear(color.rgb), color.a);
}
