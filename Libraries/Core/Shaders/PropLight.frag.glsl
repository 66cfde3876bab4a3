#version 330 core
//DSPACE::Defines
// What VTK drew, in display values, as linear light. DSPACE_OVER: premultiplied, for the blend
// function; else with its depth, and with an alpha that says that it is not exposed.
// DSPACE_UNKNOWN: zeros in place of the light.
#ifndef DSPACE_UNKNOWN
uniform sampler2D source;
#endif
uniform sampler2D depths;
layout(location = 0) out vec4 fragColor;

vec3 linearFromSrgb(vec3 c)
{
  return mix(c / 12.92, pow((c + 0.055) / 1.055, vec3(2.4)), greaterThan(c, vec3(0.04045)));
}

void main()
{
  ivec2 texel = ivec2(gl_FragCoord.xy);
#ifdef DSPACE_OVER
  vec4 shown = texelFetch(source, texel, 0);
  fragColor = vec4(linearFromSrgb(max(shown.rgb / max(shown.a, 1e-4), 0.0)) * shown.a, shown.a);
#else
  float d = texelFetch(depths, texel, 0).r;
  if (d <= 0.0)
  {
    discard; // nothing was drawn here
  }
  gl_FragDepth = d;
#ifdef DSPACE_UNKNOWN
  fragColor = vec4(0.0);
#else
  fragColor = vec4(linearFromSrgb(max(texelFetch(source, texel, 0).rgb, vec3(0.0))), 0.0);
#endif
#endif
}
