// Structure of the ground near the camera: images that repeat, by slope and height.
#ifdef DSPACE_DETAILS
in vec4 detailAt; // tiles
uniform sampler2D detailTexture0;
uniform sampler2D detailTexture1;
uniform vec3 detailMean0; // linear light
uniform vec3 detailMean1;
uniform vec4 detailRange0; // slopes [deg], heights [m]
uniform vec4 detailRange1;
uniform vec4 detailLook; // opacities, softness of the heights' ends [m]

float within(float value, vec2 range, float soft)
{
  return smoothstep(range.x - soft, range.x + soft, value) *
    (1.0 - smoothstep(range.y - soft, range.y + soft, value));
}

vec3 detailed(vec3 color, vec3 structure, vec3 mean, vec4 range, float opacity, float soft)
{
  float weight = opacity * within(styleAt.y, range.xy, 2.0) * within(styleAt.x, range.zw, soft);
  return color * mix(vec3(1.0), structure / mean, weight);
}

vec3 withDetails(vec3 color)
{
  color = detailed(color, texture(detailTexture0, detailAt.xy).rgb, detailMean0, detailRange0,
    detailLook.x, detailLook.z);
#if DSPACE_DETAILS > 1
  color = detailed(color, texture(detailTexture1, detailAt.zw).rgb, detailMean1, detailRange1,
    detailLook.y, detailLook.w);
#endif
  return color;
}
#endif
