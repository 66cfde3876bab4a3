#version 330 core
//DSPACE::Defines
// Light that air scatters once on its way to the camera, over what is behind it
// (dspace/scene/bodies/Atmosphere.h). Lengths are radii of the equator, in axes in which the body is a
// unit sphere; those along rays are metres.
//DSPACE::Functions
vec3 bodyPlace = vec3(0.0); // in the body's axes [m]
#define DSPACE_ECLIPSE_PLACE bodyPlace
//DSPACE::Lighting

layout(location = 0, index = 0) out vec4 scattered;
layout(location = 0, index = 1) out vec4 transmitted;

uniform vec3 bodyRadii;   // [m]
uniform float airTop;     // height of the top
uniform vec3 airRayleigh; // [1/m]
uniform vec3 airMie;      // scattering [1/m]
uniform vec3 airMieExtinction;
uniform vec3 airHeights;  // scale heights of both; g
uniform vec3 sunRay;      // towards the Sun: unit, in the sphere's axes
uniform vec3 sunVC;       // likewise, view axes
uniform vec3 sunLight;    // pi times its irradiance, as light has it
uniform sampler2D airTable; // AirTable

// What of the Sun's light reaches a place at the distance r from the centre.
vec3 sunThrough(float r, float mu)
{
  float top = 1.0 + airTop;
  float most = sqrt(airTop * (2.0 + airTop));
  float rho = sqrt(max((r - 1.0) * (r + 1.0), 0.0));
  if (mu < 0.0 && r * mu < -rho)
  {
    return vec3(0.0); // night
  }
  float d = -r * mu + sqrt(max(r * r * (mu * mu - 1.0) + top * top, 0.0));
  float least = top - r;
  vec2 at = vec2((d - least) / max(rho + most - least, 1e-9), rho / most);
  vec2 size = vec2(textureSize(airTable, 0));
  return texture(airTable, (clamp(at, 0.0, 1.0) * (size - 1.0) + 0.5) / size).rgb;
}

void main()
{
  vec3 from = vec3(1.0, gl_FragCoord.xy - pivot);
  vec3 o = rayOrigin * from;
  vec3 d = rayDirection * from;
  vec3 along = viewDirection * from;
  float metres = length(along);
  float a = dot(d, d);
  float b = dot(o, d);
  float c = (gap > -1.0 ? gap : dot(o, o) - 1.0) - airTop * (2.0 + airTop);
  float square = b * b - a * c;
  if (square <= 0.0)
  {
    discard;
  }
  float root = sqrt(square);
  float first = gap > -1.0 ? max((-b - root) / a, 0.0) : (-b - root) / a;
  float last = min((-b + root) / a, opaqueLength(from));
  if (last <= first)
  {
    discard;
  }
  // From the lowest place both ways, with steps that grow: air is dense below.
  float low = clamp(-b / a, first, last);
  int before = low - first < 1e-3 * (last - first) ? 0
    : last - low < 1e-3 * (last - first) ? DSPACE_AIR_STEPS : DSPACE_AIR_STEPS / 2;
  low = before == 0 ? first : before == DSPACE_AIR_STEPS ? last : low;
  float cosine = dot(along / metres, sunVC);
  float g = airHeights.z;
  float haze = 1.0 + g * g - 2.0 * g * cosine;
  vec2 phase = vec2(0.0596831037 * (1.0 + cosine * cosine),
    0.0795774715 * (1.0 - g * g) / (haze * sqrt(haze)));
  vec3 sum = vec3(0.0);
  vec3 passed = vec3(1.0);
  for (int i = 0; i < DSPACE_AIR_STEPS; ++i)
  {
    bool falling = i < before;
    float count = float(falling ? before : DSPACE_AIR_STEPS - before);
    float u0 = falling ? 1.0 - float(i) / count : float(i - before) / count;
    float u1 = falling ? 1.0 - float(i + 1) / count : float(i + 1 - before) / count;
    float reach = falling ? first - low : last - low;
    float middle = 0.5 * (u0 + u1);
    float t = low + reach * middle * middle;
    float width = abs(reach * (u1 * u1 - u0 * u0)) * metres;
    vec3 p = o + t * d;
    // The height without the loss of digits of 1 + height.
    float high = (gap > -1.0 ? gap + t * (2.0 * b + t * a) : dot(p, p) - 1.0);
    float r = sqrt(1.0 + max(high, -0.1));
    float height = high / (r + 1.0) * bodyRadii.x;
    vec2 density = exp(-max(height, -1e4) / airHeights.xy);
    vec3 extinction = airRayleigh * density.x + airMieExtinction * density.y;
    vec3 source = airRayleigh * (density.x * phase.x) + airMie * (density.y * phase.y);
    vec3 sun = sunThrough(max(r, 1.0), dot(p, sunRay) / r);
#ifdef DSPACE_ECLIPSES
    bodyPlace = p * bodyRadii;
    sun *= sunSeen(bodyPlace);
#endif
    vec3 depth = extinction * width;
    vec3 gone = exp(-depth);
    // Of an even piece of the ray.
    vec3 mean = mix((1.0 - gone) / max(depth, 1e-6), 1.0 - 0.5 * depth, lessThan(depth, vec3(1e-3)));
    sum += passed * mean * sun * source * width;
    passed *= gone;
  }
  scattered = vec4(sum * sunLight, 1.0 / 65536.0);
  transmitted = vec4(passed, 1.0);
}
