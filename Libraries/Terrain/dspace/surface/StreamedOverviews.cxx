// Overviews that come while a StreamedTerrain is open.
#include <dspace/surface/StreamedTerrain.h>

#include <dspace/posts/RasterPosts.h>

#include <dspace/pyramid/PostSurface.h>

namespace dspace {

int StreamedTerrain::TakeOverviews(
    const std::vector<std::shared_ptr<ElevationPyramid>>& others) const {
  if (this->Filled_) { // fills follow from coarse levels, also where finer tiles were made already
    return 0;
  }
  const int levels = this->Source_->TakeOverviews();
  if (levels > 0) {
    this->Posts_->ForgetReduced();
    std::vector<std::shared_ptr<ElevationPyramid>> pyramids = others;
    pyramids.push_back(this->Pyramid_);
    for (const std::shared_ptr<ElevationPyramid>& pyramid : pyramids) {
      PostRectangle coarse{0, 0, pyramid->Lattice().columns, pyramid->Lattice().rows};
      coarse.from = this->Posts_->FirstReducedLevel();
      pyramid->Invalidate({coarse});
    }
  }
  return levels;
}

} // namespace dspace
