// The clipmap's levels, each in a colour of its own.
#ifdef DSPACE_LEVELS
in vec2 awayAt; // from the camera [posts]
uniform float levelOpacity;

vec3 withLevels(vec3 color)
{
  // Six hues in turn: neighbours differ much.
  vec3 hues[6] = vec3[6](vec3(0.8, 0.1, 0.1), vec3(0.9, 0.6, 0.05), vec3(0.35, 0.7, 0.1),
    vec3(0.05, 0.6, 0.6), vec3(0.1, 0.2, 0.8), vec3(0.6, 0.1, 0.6));
  // As the vertex shader blends; where two levels overlap both are the coarser.
  vec2 away = abs(awayAt);
  bool coarser = (max(max(away.x, away.y), blend.z) - blend.x) * blend.y >= 1.0;
  return mix(color, hues[(coarser ? level + 1 : level) % 6], levelOpacity);
}
#endif
