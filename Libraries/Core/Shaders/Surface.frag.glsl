#version 330 core
//DSPACE::Defines
// Colour of a surface in linear light: metallic-roughness material (glTF 2.0, appendix B) under
// the scene's lights; a light of intensity 1 that falls straight on a white matt surface makes 1.
// A surface without DSPACE_SPECULAR is Lambertian. The number of lights and whether all of them are
// directional are known when this is compiled: a software renderer pays for every branch.
flat in vec4 baseColor;
#ifdef DSPACE_LIT
in vec3 positionVC;
in vec3 normalVC;
flat in vec3 surface; // metallic, roughness, mirrored
#endif
#ifdef DSPACE_EMISSIVE
flat in vec3 emissive;
#endif
#ifdef DSPACE_TEXTURE
in vec2 tcoord;
#endif
#ifdef DSPACE_VERTEX_COLOR
in vec4 vertexColor;
#endif
#ifdef DSPACE_HOLES
in float hole; // 0 in what is to be seen
#endif

layout(location = 0) out vec4 fragColor;

#if DSPACE_LIGHT_COUNT > 0
uniform int lightKind[DSPACE_LIGHT_COUNT]; // 0 directional, 1 point, 2 spot, 3 head
uniform vec3 lightColor[DSPACE_LIGHT_COUNT];
uniform vec3 lightDirectionVC[DSPACE_LIGHT_COUNT]; // the way the light travels
uniform vec3 lightPositionVC[DSPACE_LIGHT_COUNT];
uniform vec3 lightAttenuation[DSPACE_LIGHT_COUNT];
uniform float lightCosCone[DSPACE_LIGHT_COUNT];
#endif
uniform vec3 ambientLight;
uniform int cameraParallel;

#ifdef DSPACE_TEXTURE
uniform sampler2D colorTexture;
#endif

#ifdef DSPACE_PEEL
uniform sampler2D opaqueDepth;
uniform sampler2D peeledDepth;
uniform int firstLayer;
#endif

// sRGB display value to linear light (IEC 61966-2-1).
vec3 linearFromSrgb(vec3 c)
{
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

// Functions of a geometry's own, mixedColor() among them.
//DSPACE::Functions

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

void main()
{
#ifdef DSPACE_HOLES
  if (hole > 0.0)
  {
    discard;
  }
#endif
#ifdef DSPACE_PEEL
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  // Reversed depth: larger is nearer.
  if (gl_FragCoord.z < texelFetch(opaqueDepth, pixel, 0).r ||
    (firstLayer == 0 && gl_FragCoord.z >= texelFetch(peeledDepth, pixel, 0).r))
  {
    discard;
  }
#endif
  vec4 color = baseColor;
#ifdef DSPACE_VERTEX_COLOR
  color *= vec4(linearFromSrgb(vertexColor.rgb), vertexColor.a);
#endif
#ifdef DSPACE_TEXTURE
  color *= texture(colorTexture, tcoord);
#endif
#ifdef DSPACE_MIXED
  color = mixedColor(color);
#endif

#ifdef DSPACE_LIT
  vec3 N = normalize(normalVC);
  if (gl_FrontFacing != (surface.z > 0.0))
  {
    N = -N;
  }
  vec3 light = ambientLight * color.rgb;
#if defined(DSPACE_SPECULAR) || defined(DSPACE_PLACED_LIGHTS)
  vec3 V = cameraParallel == 1 ? vec3(0.0, 0.0, 1.0) : normalize(-positionVC);
#endif
#ifdef DSPACE_SPECULAR
  float NdV = max(dot(N, V), 1e-4);
  float alpha = max(surface.y * surface.y, 0.002);
  vec3 F0 = mix(vec3(0.04), color.rgb, surface.x);
  vec3 albedo = color.rgb * (1.0 - surface.x);
#endif
#if DSPACE_LIGHT_COUNT > 0
  for (int i = 0; i < DSPACE_LIGHT_COUNT; ++i)
  {
    vec3 L = -lightDirectionVC[i];
    vec3 radiance = lightColor[i];
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
    float NdL = max(dot(N, L), 0.0);
#ifdef DSPACE_SPECULAR
    light += radiance * NdL * reflected(L, N, V, NdL, NdV, albedo, F0, alpha * alpha);
#else
    light += radiance * NdL * color.rgb;
#endif
  }
#endif
  color.rgb = light;
#endif
#ifdef DSPACE_EMISSIVE
  color.rgb += emissive;
#endif

#ifdef DSPACE_PEEL
  if (color.a <= 0.0)
  {
    discard;
  }
  fragColor = vec4(color.rgb * color.a, color.a);
#else
  fragColor = vec4(color.rgb, 1.0);
#endif
}
