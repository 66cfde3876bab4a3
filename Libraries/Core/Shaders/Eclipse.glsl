// How much of the Sun's disc other bodies leave (dspace/scene/bodies/SunDisc.h is the reference).
#ifdef DSPACE_ECLIPSES
uniform int eclipsingCount;
uniform vec3 eclipsingPlace[DSPACE_ECLIPSES]; // in the axes of the places that are asked for [m]
// Three rows a body: from these axes to those in which it is a unit sphere.
uniform vec3 eclipsingUnit[3 * DSPACE_ECLIPSES];
uniform vec4 sunDisc; // the Sun's place in these axes, and its radius [m]
#ifndef DSPACE_ECLIPSE_PLACE
#define DSPACE_ECLIPSE_PLACE positionVC
#endif

// A segment of a unit circle that spans the half angle alpha, without loss of digits.
float circleSegment(float alpha)
{
  return alpha < 0.1 ? alpha * alpha * alpha * 0.66666667 * (1.0 - 0.2 * alpha * alpha)
    : alpha - sin(alpha) * cos(alpha);
}

// The part of a disc of radius a that one of radius b leaves, at the distance d.
float discLeft(float a, float b, float d)
{
  if (d >= a + b)
  {
    return 1.0;
  }
  if (d <= b - a)
  {
    return 0.0;
  }
  if (d <= a - b)
  {
    return 1.0 - b * b / (a * a);
  }
  float x = clamp(((d - b) * (d + b) + a * a) / (2.0 * d), -a, a);
  float halfChord = sqrt(max((a - x) * (a + x), 0.0));
  float beta = atan(halfChord, d - x);
  float hidden = circleSegment(acos(clamp(x / a, -1.0, 1.0))) + b * b / (a * a) * circleSegment(beta);
  return clamp(1.0 - hidden / 3.14159265, 0.0, 1.0);
}

float sunSeen(vec3 place)
{
  float seen = 1.0;
  for (int i = 0; i < eclipsingCount; ++i)
  {
    mat3 columns = mat3(eclipsingUnit[3 * i], eclipsingUnit[3 * i + 1], eclipsingUnit[3 * i + 2]);
    vec3 body = (eclipsingPlace[i] - place) * columns;
    vec3 toSun = (sunDisc.xyz - place) * columns;
    float away = length(toSun);
    vec3 s = toSun / away;
    float along = dot(body, s);
    float square = dot(body, body);
    if (square < 1.0201 || along <= 0.0 || along >= away)
    {
      continue;
    }
    vec3 aside = body - along * s;
    float sine = length(aside);
    vec3 other = abs(s.x) < 0.7 ? vec3(1.0, 0.0, 0.0) : vec3(0.0, 1.0, 0.0);
    vec3 u = sine > 1e-6 ? aside / sine : normalize(cross(s, other));
    float a = sunDisc.w * length(columns * u) / away;
    seen *= discLeft(a, asin(inversesqrt(square)), atan(sine, along));
  }
  return seen;
}
#endif
