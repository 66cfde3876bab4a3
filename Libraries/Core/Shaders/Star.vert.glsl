#version 330 core
//DSPACE::Defines
// A star as a point, infinitely far away: only its direction counts.
layout(location = 0) in vec3 direction; // unit, in the object's axes
layout(location = 1) in vec4 light;     // linear light of the star's colour, and of its irradiance
uniform mat3 viewFromObject;
uniform mat4 clipFromView;
uniform vec2 pictureSize; // [samples]
uniform vec2 guard;       // picture / (picture with its margins)
uniform float spread;     // standard deviation [samples]
uniform float peak;       // share of a star's light that its brightest sample gets
uniform float brightness; // of irradiance 1 on a sample at the picture's centre
uniform float faintest;   // light that makes no difference; 0: a share of the star's own
uniform float largest;    // diameter of a point [samples]
flat out vec2 center; // window coordinates
flat out vec3 color; // of the whole star, as the centre's samples see it

void main()
{
  vec3 view = viewFromObject * direction;
  vec4 clip = clipFromView * vec4(view, 0.0);
  vec2 ndc = clip.xy / clip.w;
  center = (0.5 * ndc + 0.5) * pictureSize;
  // Samples away from the centre see less of the sky.
  float cosine = -view.z;
  color = light.rgb * light.a * brightness;
  float all = light.a * brightness / (cosine * cosine * cosine);
  float threshold = faintest > 0.0 ? faintest : 1e-4 * all * peak;
  float reach = all * peak / threshold;
  bool seen = clip.w > 0.0 && reach > 1.0;
  gl_Position = seen ? vec4(clip.xy * guard, 0.0, clip.w) : vec4(2.0, 2.0, 2.0, 1.0);
  gl_PointSize = min(2.0 * (spread * sqrt(2.0 * log(max(reach, 1.0))) + 1.0), largest);
}
