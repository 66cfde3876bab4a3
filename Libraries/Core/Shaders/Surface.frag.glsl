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
#if defined(DSPACE_TEXTURE) || defined(DSPACE_NORMAL_MAP) || defined(DSPACE_OBJECT_NORMALS)
in vec2 tcoord;
#endif
#ifdef DSPACE_VERTEX_COLOR
in vec4 vertexColor;
#endif
#ifdef DSPACE_HOLES
in float hole; // 0 in what is to be seen
#endif

layout(location = 0) out vec4 fragColor;

#ifdef DSPACE_TEXTURE
uniform sampler2D colorTexture;
#endif

//DSPACE::Peeling

// Lights, and how a surface reflects them.
//DSPACE::Lighting

// Functions of a geometry's own, mixedColor() and layeredNormal() among them.
//DSPACE::Functions

#ifdef DSPACE_UNSHADED
// The factor, and 1 for the filmic curve, by which light becomes a display value; 0, 0: not known
// before the picture is drawn, or the lights have it.
uniform vec2 lightExposure;

//DSPACE::Tone
#endif

#ifdef DSPACE_NORMAL_MAP
uniform sampler2D normalTexture; // tangent space: 0.5 + 0.5 n, X along u, Y along v
uniform float normalScale;

// N turned by the texture, in axes along which u and v grow, from the changes of position and
// texture coordinate across the pixel (C. Schueler, "Normal Mapping without Precomputed Tangents",
// ShaderX5, 2006). N looks to the camera.
vec3 mappedNormal(vec3 N)
{
  vec3 p1 = dFdx(positionVC);
  vec3 p2 = dFdy(positionVC);
  vec2 t1 = dFdx(tcoord);
  vec2 t2 = dFdy(tcoord);
  vec3 across2 = cross(p2, N);
  vec3 across1 = cross(N, p1);
  vec3 T = across2 * t1.x + across1 * t2.x;
  vec3 B = across2 * t1.y + across1 * t2.y;
  float lengthT = length(T);
  float lengthB = length(B);
  vec3 n = texture(normalTexture, tcoord).xyz * 2.0 - 1.0; // here all pixels take the same way
  if (lengthT <= 0.0 || lengthB <= 0.0)
  {
    return N; // texture coordinates that stand still
  }
  n.xy *= normalScale;
  return normalize(mat3(T / lengthT, B / lengthB, N) * n);
}
#endif

#ifdef DSPACE_OBJECT_NORMALS
uniform sampler2D normalTexture; // opacity times the normal (0 is 128 / 255), opacity
flat in mat3 normalsVC;

// N, unit, is the mesh's own.
vec3 objectNormal(vec3 N)
{
  vec4 texel = texture(normalTexture, tcoord);
  vec3 n = (texel.xyz * 255.0 - 128.0) / 127.0;
  if (dot(n, n) < 1e-4) // nothing, or rounding
  {
    return N;
  }
  return normalize(mix(N, normalize(normalsVC * n), texel.a));
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
  if (dspacePeeled())
  {
    discard;
  }
#endif
#ifdef DSPACE_ANGLES
#ifdef DSPACE_TEXTURE
  if (texture(colorTexture, tcoord).a <= 0.0) // as labels have it
  {
    discard;
  }
#endif
  vec4 color = vec4(0.0);
#else
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
#endif

#ifdef DSPACE_LIT
  vec3 N = normalize(normalVC);
#ifdef DSPACE_LAYER_NORMALS
  N = layeredNormal(N);
#endif
#ifdef DSPACE_OBJECT_NORMALS
  N = objectNormal(N);
#endif
  if (gl_FrontFacing != (surface.z > 0.0))
  {
    N = -N;
  }
#ifdef DSPACE_NORMAL_MAP
  N = mappedNormal(N);
#endif
#ifdef DSPACE_ANGLES
  color = photometricAngles(N, positionVC, cameraParallel);
#else
  color.rgb = shaded(color.rgb, N, positionVC, surface.xy);
#endif
#endif
#ifdef DSPACE_EMISSIVE
  color.rgb += emissive;
#endif
  float exposed = 1.0;
#if defined(DSPACE_UNSHADED) && defined(DSPACE_MIXED) && !defined(DSPACE_ANGLES)
  vec4 style = unshadedStyle();
  exposed = step(1e-6, style.a);
#ifndef DSPACE_DISPLAY_COLOR
  if (lightExposure.x > 0.0 && style.a < 1.0)
  {
    color.rgb = tonedLight(color.rgb, lightExposure.x, lightExposure.y > 0.0);
    exposed = 0.0; // is done
  }
#endif
  color.rgb = color.rgb * style.a + style.rgb;
#endif

#ifdef DSPACE_PEEL
  if (color.a <= 0.0)
  {
    discard;
  }
  fragColor = vec4(color.rgb * color.a, color.a);
#elif defined(DSPACE_ANGLES)
  fragColor = color;
#elif defined(DSPACE_DISPLAY_COLOR)
  fragColor = vec4(color.rgb, 0.0); // not exposed
#else
  fragColor = vec4(color.rgb, exposed);
#endif
}
