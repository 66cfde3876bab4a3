#version 330 core
//DSPACE::Defines
// Rings in the plane of a body's equator, over what is behind them. Their particles scatter light once:
// a slab of even density after Lommel and Seeliger (S. Chandrasekhar, "Radiative Transfer", 1950), whose
// colour is the radiance factor of an opaque one that faces Sun and camera.
//DSPACE::Functions
vec3 bodyPlace = vec3(0.0); // in the body's axes [m]
#define DSPACE_ECLIPSE_PLACE bodyPlace
//DSPACE::Lighting

layout(location = 0) out vec4 fragColor;

uniform vec3 bodyRadii; // [m]
uniform int ringCount;
uniform vec3 ringBand[DSPACE_RINGS]; // inner and outer radius [m], optical depth
uniform vec3 ringColor[DSPACE_RINGS];
uniform vec3 sunRay;    // towards the Sun: in the sphere's axes
uniform vec3 sunBody;   // unit, in the body's axes
uniform vec3 sunLight;  // its irradiance, as light has it

void main()
{
  vec3 from = vec3(1.0, gl_FragCoord.xy - pivot);
  vec3 o = rayOrigin * from;
  vec3 d = rayDirection * from;
  float t = -o.z / d.z;
  vec3 unit = o + t * d;
  bodyPlace = unit * bodyRadii;
  float radius = length(bodyPlace.xy);
  float width = max(fwidth(radius), 1e-3);
  if (!(abs(t) < 1e30) || t >= opaqueLength(from) || (viewOrigin * from + t * (viewDirection * from)).z >= 0.0)
  {
    discard;
  }
  float mu = max(abs(normalize(d * bodyRadii).z), 1e-4);
  float mu0 = max(abs(sunBody.z), 1e-4);
  bool lit = -d.z * sunBody.z > 0.0; // the side that the camera sees
#ifdef DSPACE_ECLIPSES
  float sun = sunSeen(bodyPlace);
#else
  float toward = dot(unit, sunRay);
  float sun = toward < 0.0 && dot(unit, unit) - toward * toward / dot(sunRay, sunRay) < 1.0 ? 0.0 : 1.0;
#endif
  vec4 sum = vec4(0.0);
  for (int i = 0; i < ringCount; ++i)
  {
    // The share of the pixel that the band covers.
    float share = clamp((min(radius + 0.5 * width, ringBand[i].y) - max(radius - 0.5 * width, ringBand[i].x)) / width,
      0.0, 1.0);
    float depth = ringBand[i].z;
    float opacity = 1.0 - exp(-depth / mu);
    float factor = lit ? 2.0 * mu0 / (mu0 + mu) * (1.0 - exp(-depth * (1.0 / mu + 1.0 / mu0)))
      : abs(mu - mu0) < 1e-3 ? 2.0 * depth / mu * exp(-depth / mu)
      : 2.0 * mu0 / (mu - mu0) * (exp(-depth / mu) - exp(-depth / mu0));
    sum += share * vec4(ringColor[i] * factor * sun * sunLight, opacity);
  }
  if (sum.a <= 0.0)
  {
    discard;
  }
  fragColor = sum;
}
