// Limits filling to a distance from data. Not for public headers.
#ifndef DSPACE_TERRAIN_FILLEDREACH_H
#define DSPACE_TERRAIN_FILLEDREACH_H

#include <memory>
#include <vector>

#include <dspace/posts/RasterPosts.h>

namespace dspace {

class FilledReach {
public:
  // `reach`: in the raster's pixels.
  FilledReach(std::shared_ptr<const RasterPosts> posts, double reach);

  // Removes posts that were filled further from data than that.
  void Drop(const PostBlock& block, std::vector<float>& heights) const;

private:
  std::shared_ptr<const RasterPosts> Posts_;
  double Reach_;
};

} // namespace dspace

#endif
