// Photometric models and angles of lit surfaces, as dspace/import/model/Reflectance.h states them.
#ifdef DSPACE_REFLECTANCE
// 2 (Lommel-Seeliger): unused. 3 (lunar-Lambert): coefficients of L, of powers of the phase angle
// in degrees. 4 (Hapke): w, b, c, B0; then h, tan(theta bar), chi, r0.
uniform vec4 reflectanceValues[2];

#if DSPACE_REFLECTANCE == 4
float hapkeLobe(float b, float cosine)
{
  float d = 1.0 - 2.0 * b * cosine + b * b;
  return (1.0 - b * b) / (d * sqrt(d));
}

float hapkeH(float w, float r0, float x)
{
  return 1.0 / (1.0 - w * x * (r0 + 0.5 * (1.0 - 2.0 * r0 * x) * log((1.0 + x) / x)));
}
#endif

// L: to the light, V: to the camera, both unit, as is N. mu0, mu: cosines of incidence, which is
// above 0, and emission.
float radianceFactor(vec3 L, vec3 N, vec3 V, float mu0, float mu)
{
#if DSPACE_REFLECTANCE == 2
  return 2.0 * mu0 / (mu0 + mu);
#elif DSPACE_REFLECTANCE == 3
  float g = degrees(2.0 * atan(length(L - V), length(L + V)));
  vec4 k = reflectanceValues[0];
  float weight = max(k.x + g * (k.y + g * (k.z + g * k.w)), 0.0);
  return weight * 2.0 * mu0 / (mu0 + mu) + (1.0 - weight) * mu0;
#else
  float w = reflectanceValues[0].x;
  float b = reflectanceValues[0].y;
  float c = reflectanceValues[0].z;
  float tangent = reflectanceValues[1].y;
  float chi = reflectanceValues[1].z;
  float r0 = reflectanceValues[1].w;
  // Parts along the surface give sines and azimuth without loss of digits.
  vec3 alongL = L - mu0 * N;
  vec3 alongV = V - dot(N, V) * N;
  float sin0 = max(length(alongL), 1e-6);
  float sin1 = max(length(alongV), 1e-6);
  float cosPsi = clamp(dot(alongL, alongV) / (sin0 * sin1), -1.0, 1.0);
  float psi = atan(length(cross(alongL, alongV)), dot(alongL, alongV) + 1e-12);
  float halfSquare = sin(0.5 * psi) * sin(0.5 * psi);
  float cot0 = mu0 / (sin0 * tangent);
  float cot1 = mu / (sin1 * tangent);
  float first0 = exp(-0.63661977 * cot0);
  float first1 = exp(-0.63661977 * cot1);
  float second0 = exp(-0.31830989 * cot0 * cot0);
  float second1 = exp(-0.31830989 * cot1 * cot1);
  float eta0 = chi * (mu0 + sin0 * tangent * second0 / (2.0 - first0));
  float eta1 = chi * (mu + sin1 * tangent * second1 / (2.0 - first1));
  bool higher = mu0 >= mu; // the light stands higher than the camera
  float turned = psi * 0.31830989;
  float below =
    max(higher ? 2.0 - first1 - turned * first0 : 2.0 - first0 - turned * first1, 1e-6);
  float more0 = higher ? cosPsi * second1 + halfSquare * second0 : second0 - halfSquare * second1;
  float more1 = higher ? second1 - halfSquare * second0 : cosPsi * second0 + halfSquare * second1;
  float rough0 = max(chi * (mu0 + sin0 * tangent * more0 / below), 1e-6);
  float rough1 = max(chi * (mu + sin1 * tangent * more1 / below), 1e-6);
  float ratio = chi * (higher ? mu0 / eta0 : mu / eta1);
  float f = exp(-2.0 * tan(min(0.5 * psi, 1.5707)));
  float shadowing = rough1 / eta1 * mu0 / eta0 * chi / (1.0 - f + f * ratio);
  float cosG = dot(L, V);
  float surge = reflectanceValues[0].w /
    (1.0 + length(L - V) / (max(length(L + V), 1e-6) * reflectanceValues[1].x));
  float phase = 0.5 * ((1.0 + c) * hapkeLobe(b, cosG) + (1.0 - c) * hapkeLobe(b, -cosG));
  return 0.25 * w * rough0 / (rough0 + rough1) *
    ((1.0 + surge) * phase + hapkeH(w, r0, rough0) * hapkeH(w, r0, rough1) - 1.0) * shadowing;
#endif
}
#endif

#ifdef DSPACE_ANGLES
uniform vec3 towardsSunVC; // unit, or 0 without a Sun
uniform int writeNormals; // 1: in place of angles

float degreesBetween(vec3 a, vec3 b)
{
  return degrees(2.0 * atan(length(a - b), length(a + b)));
}

// Incidence, emission, phase; 1, as they are known, and the part of the Sun's disc that lights the
// surface. With writeNormals: the normal and 1.
vec4 photometricAngles(vec3 N, vec3 positionVC, int parallel)
{
  if (writeNormals == 1) {
    return vec4(N, 1.0);
  }
  vec3 V = parallel == 1 ? vec3(0.0, 0.0, 1.0) : normalize(-positionVC);
  float lit = 1.0;
#ifdef DSPACE_SHADOWED
  vec3 across = dFdx(positionVC);
  vec3 down = dFdy(positionVC);
  vec3 planeVC = cross(across, down);
  lit = sunLit(positionVC, planeVC);
#ifdef DSPACE_HORIZON
  // A triangle that turns away from the Sun is dark, as rays have it, although a corner sees the Sun. Colours
  // leave that to the smooth normal: the triangles would show. Where a pixel is as small as single
  // precision rounds positions, its plane is not known.
  if (min(length(across), length(down)) > 1e-4 * length(positionVC))
  {
    lit = min(lit, discLit(dot(normalize(planeVC), towardsSunVC)));
  }
#endif
#endif
#ifdef DSPACE_ECLIPSES
  lit *= sunSeen(DSPACE_ECLIPSE_PLACE);
#endif
  return vec4(degreesBetween(N, towardsSunVC), degreesBetween(N, V),
    degreesBetween(towardsSunVC, V), 1.0 + (dot(N, towardsSunVC) > 0.0 ? lit : 0.0));
}
#endif
