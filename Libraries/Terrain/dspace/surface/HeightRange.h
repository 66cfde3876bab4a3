// The range of heights of a raster. Not for public headers.
#ifndef DSPACE_TERRAIN_HEIGHTRANGE_H
#define DSPACE_TERRAIN_HEIGHTRANGE_H

#include <array>
#include <string>
#include <vector>

#include <dspace/posts/PostPlacement.h>
#include <dspace/pyramid/ElevationPyramid.h>
#include <dspace/raster/ElevationSource.h>

namespace dspace {

struct HeightRange {
  std::array<double, 2> heights = {0.0, 0.0}; // least and greatest [m]
  // Every pixel was looked at. Else those of a sample, widened by half to either side: a guess that
  // only culling uses.
  bool exact = false;
  std::vector<std::string> warnings; // heights that are in doubt
};

// Exact if the raster has at most 4 million pixels; else `pyramid` also starts to read the level of
// the first picture. `name` is for messages. Throws Error(InvalidArgument) for a height below a
// body's centre, and what reading throws.
HeightRange FindHeightRange(const std::string& name, const ElevationSource& source,
                            const PostPlacement& placement, const Eigen::Affine2d& pixelToPost,
                            ElevationPyramid& pyramid);

} // namespace dspace

#endif
