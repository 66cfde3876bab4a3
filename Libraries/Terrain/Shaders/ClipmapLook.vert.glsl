// What the fragment shader of all surfaces needs: label or colour, light, texture.
#ifdef DSPACE_LABEL
uniform int objectLabel;
flat out uint label;
#else
uniform vec4 objectColor;
flat out vec4 baseColor;
#endif
#ifdef DSPACE_LIT
uniform vec3 objectSurface; // metallic, roughness, mirrored
out vec3 positionVC;
out vec3 normalVC;
flat out vec3 surface;
#endif
#ifdef DSPACE_EMISSIVE
uniform vec3 objectEmissive;
flat out vec3 emissive;
#endif
#ifdef DSPACE_TEXTURE
uniform vec2 originTexture;
uniform mat2 postTexture;
out vec2 tcoord;
#endif
#ifdef DSPACE_HOLES
out float hole;
#endif

#ifdef DSPACE_HORIZON
out vec2 horizonAt;
#ifdef DSPACE_ANGLES
out vec2 postPlace;
out vec3 verticalVC;
out vec3 acrossVC;
out vec3 downVC;
#endif
#endif

void putLook(Standing standing, Ground ground, vec2 place)
{
#ifdef DSPACE_HORIZON
  horizonAt = ground.horizon;
#ifdef DSPACE_ANGLES
  postPlace = place;
  verticalVC = standing.verticalVC;
  acrossVC = standing.acrossVC;
  downVC = standing.downVC;
#endif
#endif
#ifdef DSPACE_LABEL
  label = uint(objectLabel);
#else
  baseColor = objectColor;
#endif
#ifdef DSPACE_LIT
  positionVC = standing.positionVC;
  normalVC = standing.normalVC;
  surface = objectSurface;
#endif
#ifdef DSPACE_EMISSIVE
  emissive = objectEmissive;
#endif
#ifdef DSPACE_TEXTURE
  tcoord = originTexture + postTexture * place;
#endif
#ifdef DSPACE_HOLES
  hole = ground.missing ? 1.0 : 0.0;
#endif
}
