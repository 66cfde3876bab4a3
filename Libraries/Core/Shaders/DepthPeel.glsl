// Depth peeling: each layer draws what lies behind the layers before it, nearest first. Depth is
// reversed: larger is nearer.
#ifdef DSPACE_PEEL
uniform sampler2D opaqueDepth;
uniform sampler2D peeledDepth;
uniform int firstLayer;

// Whether opaque geometry hides this fragment, or a former layer drew it.
bool dspacePeeled()
{
  ivec2 pixel = ivec2(gl_FragCoord.xy);
  return gl_FragCoord.z < texelFetch(opaqueDepth, pixel, 0).r ||
    (firstLayer == 0 && gl_FragCoord.z >= texelFetch(peeledDepth, pixel, 0).r);
}
#endif
