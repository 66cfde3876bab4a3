// What a terrain's style lays over its own colour: a ramp by height, slope or aspect, normals, the
// levels, lines.
in vec4 styleAt; // height [m], slope [deg], grid lines along columns and rows (whole at a line)

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
#endif
#ifdef DSPACE_TRACKS
in float trackAt; // how much is rolled over
uniform vec4 trackColor; // linear light, opacity
#endif
#ifdef DSPACE_RAMP
uniform sampler2D rampTexture;
uniform vec4 ramp; // value of its left edge, 1 / range, opacity, 0: by height, 1: by slope
#endif
#ifdef DSPACE_FACING
in vec3 facingAt;
#endif
#ifdef DSPACE_LEVELS
in vec2 awayAt;
uniform float levelOpacity;
uniform int level;
uniform vec3 blend;
#endif
#ifdef DSPACE_CONTOURS
uniform vec2 contours; // lines a metre, half width [pixels]
uniform vec4 contourColor; // linear light, opacity
#endif
#ifdef DSPACE_GRID
uniform float gridWidth; // half [pixels]
uniform vec4 gridColor;
#endif
#ifdef DSPACE_POLE
in vec3 poleDirection; // Z out of the pole
uniform float poleSign; // -1 at the south pole
#ifdef DSPACE_GRID
uniform float gridInterval; // [deg]
#endif
#ifdef DSPACE_POLE_TEXTURE
uniform sampler2D colorTexture;
uniform mat2 degreesTexture; // longitude and latitude to the texture
uniform vec2 degreesOrigin;
#endif

// Longitude from -180 to 180, latitude; and longitude from 0 to 360, which does not jump where the
// first does.
vec3 degreesAt()
{
  float longitude = degrees(atan(poleSign * poleDirection.y, poleDirection.x));
  float latitude = poleSign * degrees(atan(poleDirection.z, length(poleDirection.xy)));
  return vec3(longitude, latitude, longitude < 0.0 ? longitude + 360.0 : longitude);
}
#endif

// How much of a pixel is a line at whole values of f; lines closer than two pixels fade away.
float lineAt(float f, float halfWidth)
{
  float pixel = max(fwidth(f), 1e-12);
  float away = abs(fract(f - 0.5) - 0.5) / pixel;
  return (1.0 - smoothstep(halfWidth - 0.5, halfWidth + 0.5, away)) *
    clamp(2.0 - 4.0 * pixel, 0.0, 1.0);
}

vec4 mixedColor(vec4 color)
{
#ifdef DSPACE_POLE
  vec3 at = degreesAt();
#endif
#ifdef DSPACE_POLE_TEXTURE
  // Its size on the screen is that of the longitude that does not jump here.
  vec2 t = degreesTexture * at.xy + degreesOrigin;
  vec2 other = degreesTexture * at.zy + degreesOrigin;
  vec2 dx = dFdx(t);
  vec2 dy = dFdy(t);
  vec2 otherX = dFdx(other);
  vec2 otherY = dFdy(other);
  bool jump = dot(dx, dx) + dot(dy, dy) > dot(otherX, otherX) + dot(otherY, otherY);
  color *= textureGrad(colorTexture, t, jump ? otherX : dx, jump ? otherY : dy);
#endif
#ifdef DSPACE_LAYERS
  color.rgb = layered(color.rgb);
#endif
#ifdef DSPACE_DETAILS
  color.rgb = detailed(color.rgb, texture(detailTexture0, detailAt.xy).rgb, detailMean0, detailRange0,
    detailLook.x, detailLook.z);
#if DSPACE_DETAILS > 1
  color.rgb = detailed(color.rgb, texture(detailTexture1, detailAt.zw).rgb, detailMean1, detailRange1,
    detailLook.y, detailLook.w);
#endif
#endif
#ifdef DSPACE_TRACKS
  color.rgb = mix(color.rgb, trackColor.rgb, trackColor.a * clamp(trackAt, 0.0, 1.0));
#endif
#ifdef DSPACE_FACING
#ifdef DSPACE_POLE
  vec3 up = normalize(poleDirection);
  vec3 east = normalize(poleSign * vec3(-up.y, up.x, 0.0));
  vec3 facing = normalize(vec3(dot(facingAt, east), dot(facingAt, cross(up, east)), dot(facingAt, up)));
#else
  vec3 facing = normalize(facingAt);
#endif
#endif
#ifdef DSPACE_BY_NORMAL
  color.rgb = mix(color.rgb, linearFromSrgb(0.5 + 0.5 * facing), ramp.z);
#elif defined(DSPACE_BY_ASPECT)
  // Level ground has none. Not a smaller image of the ramp where 360 degrees become 0.
  float aspect = degrees(atan(facing.x, facing.y));
  aspect += aspect < 0.0 ? 360.0 : 0.0;
  color.rgb = mix(color.rgb,
    textureLod(rampTexture, vec2((aspect - ramp.x) * ramp.y, 0.5), 0.0).rgb,
    dot(facing.xy, facing.xy) > 1e-12 ? ramp.z : 0.0);
#elif defined(DSPACE_RAMP)
  float value = ramp.w == 0.0 ? styleAt.x : styleAt.y;
  color.rgb = mix(color.rgb, texture(rampTexture, vec2((value - ramp.x) * ramp.y, 0.5)).rgb, ramp.z);
#endif
#ifdef DSPACE_LEVELS
  // Six hues in turn: neighbours differ much.
  vec3 hues[6] = vec3[6](vec3(0.8, 0.1, 0.1), vec3(0.9, 0.6, 0.05), vec3(0.35, 0.7, 0.1),
    vec3(0.05, 0.6, 0.6), vec3(0.1, 0.2, 0.8), vec3(0.6, 0.1, 0.6));
  // As the vertex shader blends; where two levels overlap both are the coarser.
  vec2 away = abs(awayAt);
  bool coarser = (max(max(away.x, away.y), blend.z) - blend.x) * blend.y >= 1.0;
  color.rgb = mix(color.rgb, hues[(coarser ? level + 1 : level) % 6], levelOpacity);
#endif
#ifdef DSPACE_CONTOURS
  color.rgb = mix(color.rgb, contourColor.rgb,
    contourColor.a * lineAt(styleAt.x * contours.x, contours.y));
#endif
#ifdef DSPACE_GRID
#ifdef DSPACE_POLE
  vec3 lines = at / gridInterval;
  float meridian = fwidth(lines.x) < fwidth(lines.z) ? lineAt(lines.x, gridWidth)
                                                     : lineAt(lines.z, gridWidth);
  float line = max(meridian, lineAt(lines.y, gridWidth));
#else
  float line = max(lineAt(styleAt.z, gridWidth), lineAt(styleAt.w, gridWidth));
#endif
  color.rgb = mix(color.rgb, gridColor.rgb, gridColor.a * line);
#endif
  return color;
}
