// The shaders of clipmaps, put together from their parts (Libraries/Terrain/Shaders).
#ifndef DSPACE_TERRAIN_CLIPMAPSHADERS_H
#define DSPACE_TERRAIN_CLIPMAPSHADERS_H

#include <dspace/posts/PostPlacement.h>

namespace dspace {

// For ShaderPages: the same pointer at each call, as long as the process lives.
const char* ClipmapVertexShader(PostPlacement::Kind kind);
// mixedColor() and what it calls.
const char* ClipmapFragmentFunctions();

} // namespace dspace

#endif
