// The posts of one clipmap level, in the vertex shader and in fragment shaders that look at them.
#if defined(DSPACE_POSTS) || defined(DSPACE_LEVELS) || (defined(DSPACE_HORIZON) && defined(DSPACE_ANGLES))
uniform sampler2DArray posts; // height, slopes a level-0 column and row, 1 in a hole, else tracks
uniform int texelMask;
uniform int level;
uniform ivec2 windowTexel; // texel of the window's first post
uniform vec2 firstPost; // of the lattice, in the window's posts: those outside collapse into it
uniform vec2 lastPost;
uniform vec2 cameraPost;
uniform vec3 blend; // distance where blending begins, 1 / its width, the camera's distance [posts]

vec4 postAt(ivec2 texel, int layer)
{
  return texelFetch(posts, ivec3(texel & texelMask, layer), 0);
}

// How far a post of the window is turned into the next coarser level's, 0 to 1.
float coarserShare(vec2 at)
{
  vec2 away = abs(at - cameraPost);
  return clamp((max(max(away.x, away.y), blend.z) - blend.x) * blend.y, 0.0, 1.0);
}
#endif
