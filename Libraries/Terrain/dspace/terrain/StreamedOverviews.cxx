// Overviews that come while a StreamedTerrain is open.
#include <dspace/terrain/StreamedTerrain.h>

#include <dspace/terrain/FilledPosts.h>
#include <dspace/terrain/RasterPosts.h>

#include "PostSurface.h"

namespace dspace {

int StreamedTerrain::TakeOverviews(
    const std::vector<std::shared_ptr<ElevationPyramid>>& others) const {
  const int levels = this->Source_->TakeOverviews();
  if (levels > 0) {
    this->Posts_->ForgetReduced();
    if (this->Filled_) {
      this->Filled_->ForgetReduced();
    }
    std::vector<std::shared_ptr<ElevationPyramid>> pyramids = others;
    pyramids.push_back(this->Pyramid_);
    for (const std::shared_ptr<ElevationPyramid>& pyramid : pyramids) {
      PostRectangle coarse{0, 0, pyramid->Lattice().columns, pyramid->Lattice().rows};
      // What is filled follows from coarser levels.
      coarse.from = this->Filled_ ? 0 : this->Posts_->FirstReducedLevel();
      pyramid->Invalidate({coarse});
    }
  }
  return levels;
}

} // namespace dspace
