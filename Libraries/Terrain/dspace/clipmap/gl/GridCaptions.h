// The values of a clipmap's grid lines, written where the picture shows them. Not a public header.
#ifndef DSPACE_TERRAIN_GRIDCAPTIONS_H
#define DSPACE_TERRAIN_GRIDCAPTIONS_H

#include <vector>

#include <dspace/clipmap/ClipmapLevels.h>
#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/render/Captions.h>
#include <dspace/render/CustomDrawer.h>

namespace dspace {

class RenderTarget;

// Looks for the lines along a few rows and columns of the picture that was drawn, near its borders
// first: objects that hide the ground hide the value. Each line has one value, at most 20 a
// direction (of more, those of round multiples), none over another. The style has a grid
// and its labels; nothing waits for data.
std::vector<Caption> GridCaptions(const CustomDrawing& drawing, const RenderTarget& target,
                                  const ClipmapTerrain& terrain, const ClipmapStyle& style,
                                  const PostPlacement& placement, const ClipmapLevels& levels,
                                  const ClipmapLevels::State& state);

} // namespace dspace

#endif
