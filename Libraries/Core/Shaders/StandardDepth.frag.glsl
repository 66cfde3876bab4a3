#version 330 core
//DSPACE::Defines
// The depth of a picture with reversed depth as VTK's own, between the planes of another projection.
uniform sampler2D depths;
uniform vec4 viewFromDepth; // z of the view = (x d + y) / (z d + w)
uniform vec4 depthFromView; // depth = (x z + y) / (z z + w)

void main()
{
  float d = texelFetch(depths, ivec2(gl_FragCoord.xy), 0).r;
  float z = (viewFromDepth.x * d + viewFromDepth.y) / (viewFromDepth.z * d + viewFromDepth.w);
  float standard = (depthFromView.x * z + depthFromView.y) / (depthFromView.z * z + depthFromView.w);
  gl_FragDepth = d <= 0.0 ? 1.0 : clamp(standard, 0.0, 1.0);
}
