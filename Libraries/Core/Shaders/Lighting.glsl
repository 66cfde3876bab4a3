#if DSPACE_LIGHT_COUNT > 0
uniform int lightKind[DSPACE_LIGHT_COUNT]; // 0 directional, 1 point, 2 spot, 3 head
uniform vec3 lightColor[DSPACE_LIGHT_COUNT];
uniform vec3 lightDirectionVC[DSPACE_LIGHT_COUNT]; // the way the light travels
uniform vec3 lightPositionVC[DSPACE_LIGHT_COUNT];
uniform vec3 lightAttenuation[DSPACE_LIGHT_COUNT];
uniform float lightCosCone[DSPACE_LIGHT_COUNT];
#ifdef DSPACE_DISC_LIGHTS
uniform vec2 lightDisc[DSPACE_LIGHT_COUNT]; // sine of the disc's radius, 0 for a point; its cotangent
#endif
#endif
#ifdef DSPACE_SUN_PLACE
uniform vec3 sunPlaceVC; // of the first light [m]
#endif
uniform vec3 ambientLight;
uniform int cameraParallel;

// sRGB display value to linear light (IEC 61966-2-1).
vec3 linearFromSrgb(vec3 c)
{
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

#ifdef DSPACE_SPECULAR
// What comes back of light from L: Trowbridge-Reitz distribution with Smith's height-correlated
// visibility over a Lambertian base; times pi, so that intensity 1 means "white paper shows 1".
vec3 reflected(vec3 L, vec3 N, vec3 V, float NdL, float NdV, vec3 albedo, vec3 F0, float a2)
{
  vec3 H = normalize(L + V);
  float NdH = clamp(dot(N, H), 0.0, 1.0);
  float m = 1.0 - clamp(dot(H, V), 0.0, 1.0);
  float m2 = m * m;
  vec3 F = F0 + (1.0 - F0) * (m2 * m2 * m);
  float d = NdH * NdH * (a2 - 1.0) + 1.0;
  float D = a2 / max(d * d, 1e-7);
  float vis = 0.5 /
    max(NdL * sqrt(NdV * NdV * (1.0 - a2) + a2) + NdV * sqrt(NdL * NdL * (1.0 - a2) + a2), 1e-5);
  return (1.0 - F) * albedo + D * vis * F;
}
#endif

#ifdef DSPACE_DISC_LIGHTS
// Irradiance by a disc of even radiance, against that of a surface that faces its centre; c: cosine
// of the angle between normal and centre. The surface's own plane hides a part of a low disc.
// J. Snyder, "Area Light Sources for Real-Time Graphics", Microsoft Research MSR-TR-96-11 (1996).
float discCosine(float c, vec2 disc)
{
  if (disc.x <= 0.0 || c >= disc.x)
  {
    return max(c, 0.0);
  }
  float s = sqrt(max(1.0 - c * c, 1e-12));
  float y = clamp(-disc.y * c / s, -1.0, 1.0);
  float q = sqrt(max(1.0 - y * y, 0.0));
  float inside = (c * acos(y) - disc.y * s * q + atan(s * q, disc.y) / (disc.x * disc.x)) / 3.14159265;
  return c <= -disc.x ? 0.0 : max(inside, 0.0);
}
#endif

#if defined(DSPACE_SHADOWED) && !defined(DSPACE_HORIZON)
// Triangles hide the light that smooth normals let in, each as a whole or in stripes of the shadow maps.
// Light falls to nothing where it grazes the triangle; above 12 degrees it stays as it is. The cosines
// are those of the smooth normal N and of the triangle's, planeN, with the light.
// M. Chiang, Y. K. Li, B. Burley, "Taming the Shadow Terminator", SIGGRAPH Talks (2019).
float terminator(vec3 N, vec3 planeN, float smoothCosine, float planeCosine)
{
  float g = clamp(planeCosine / max(smoothCosine * dot(N, planeN), 1e-5), 0.0, 1.0);
  return mix(g * (1.0 + g - g * g), 1.0, smoothstep(0.05, 0.2, planeCosine));
}
#endif

#ifdef DSPACE_LIT
// The light that a surface of this colour sends to the camera, linear. N: unit, view axes.
// surface: metallic, roughness.
vec3 shaded(vec3 color, vec3 N, vec3 positionVC, vec2 surface)
{
  vec3 light = ambientLight * color;
#ifdef DSPACE_SHADOWED
  vec3 planeVC = cross(dFdx(positionVC), dFdy(positionVC)); // here, where all pixels come by
  float litBySun = 0.0;
#endif
#if defined(DSPACE_SPECULAR) || defined(DSPACE_PLACED_LIGHTS) || defined(DSPACE_REFLECTANCE)
  vec3 V = cameraParallel == 1 ? vec3(0.0, 0.0, 1.0) : normalize(-positionVC);
#endif
#ifdef DSPACE_SPECULAR
  float NdV = max(dot(N, V), 1e-4);
  float alpha = max(surface.y * surface.y, 0.002);
  vec3 F0 = mix(vec3(0.04), color, surface.x);
  vec3 albedo = color * (1.0 - surface.x);
#endif
#if DSPACE_LIGHT_COUNT > 0
  for (int i = 0; i < DSPACE_LIGHT_COUNT; ++i)
  {
    vec3 L = -lightDirectionVC[i];
    vec3 radiance = lightColor[i];
#ifdef DSPACE_SUN_PLACE
    if (i == 0)
    {
      vec3 toSun = (sunPlaceVC - positionVC) / 1.495978707e11; // [au]
      float square = dot(toSun, toSun);
      L = toSun * inversesqrt(square);
      radiance /= square;
    }
#endif
#ifdef DSPACE_PLACED_LIGHTS
    if (lightKind[i] == 1 || lightKind[i] == 2)
    {
      vec3 toLight = lightPositionVC[i] - positionVC;
      float distance = length(toLight);
      L = toLight / distance;
      radiance /= dot(lightAttenuation[i], vec3(1.0, distance, distance * distance));
      if (lightKind[i] == 2 && dot(-L, lightDirectionVC[i]) < lightCosCone[i])
      {
        radiance = vec3(0.0);
      }
    }
    else if (lightKind[i] == 3)
    {
      L = V;
    }
#endif
#ifdef DSPACE_DISC_LIGHTS
    float NdL = discCosine(dot(N, L), lightDisc[i]);
#else
    float NdL = max(dot(N, L), 0.0);
#endif
#ifdef DSPACE_SHADOWED
    if (i == 0 && NdL > 0.0) // the Sun stands first
    {
      litBySun = sunLit(positionVC, planeVC);
      radiance *= litBySun;
#ifndef DSPACE_HORIZON
      vec3 planeN = normalize(planeVC);
      planeN = dot(planeN, N) < 0.0 ? -planeN : planeN;
#ifdef DSPACE_DISC_LIGHTS
      radiance *= terminator(N, planeN, NdL, discCosine(dot(planeN, L), lightDisc[i]));
#else
      radiance *= terminator(N, planeN, NdL, max(dot(planeN, L), 0.0));
#endif
#endif
    }
#endif
#ifdef DSPACE_ECLIPSES
    if (i == 0 && NdL > 0.0)
    {
      radiance *= sunSeen(DSPACE_ECLIPSE_PLACE);
    }
#endif
#ifdef DSPACE_SPECULAR
    light += radiance * NdL * reflected(L, N, V, NdL, NdV, albedo, F0, alpha * alpha);
#elif defined(DSPACE_REFLECTANCE)
    if (NdL > 0.0)
    {
      light += radiance * color * radianceFactor(L, N, V, NdL, max(dot(N, V), 0.0));
    }
#else
    light += radiance * NdL * color;
#endif
  }
#endif
#if DSPACE_CASCADES > 0
  light *= cascadeTint(positionVC);
#endif
#ifdef DSPACE_SHADOWED
  light = litColors == 1 ? litColor(litBySun) : light;
#endif
  return light;
}
#endif
