#version 330 core
//DSPACE::Defines
// Which object a pixel belongs to.
flat in uint label;
layout(location = 0) out uint fragLabel;

#ifdef DSPACE_TEXTURE
in vec2 tcoord;
uniform sampler2D colorTexture;
#endif

#ifdef DSPACE_HOLES
in float hole; // 0 in what is to be seen
#endif

void main()
{
#ifdef DSPACE_HOLES
  if (hole > 0.0)
  {
    discard;
  }
#endif
#ifdef DSPACE_TEXTURE
  // What a texture cuts out (the ground around letters) is not the object.
  if (texture(colorTexture, tcoord).a <= 0.0)
  {
    discard;
  }
#endif
  fragLabel = label;
}
