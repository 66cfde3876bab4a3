// The coarser levels of a raster's posts: means over boxes of its pixels. Not for public headers.
#ifndef DSPACE_TERRAIN_RASTERMEANS_H
#define DSPACE_TERRAIN_RASTERMEANS_H

#include <map>
#include <memory>
#include <mutex>
#include <utility>
#include <vector>

#include <dspace/posts/BoxFilter.h>
#include <dspace/posts/PixelWindows.h>
#include <dspace/posts/PostLattice.h>
#include <dspace/posts/PostSource.h>

namespace dspace {

// RasterPosts documents the levels. Any thread may call.
class RasterMeans {
public:
  // `stretch`: pixels along a row from a post of level `subdivisions` to the next.
  RasterMeans(std::shared_ptr<const PixelWindows> pixels, const PostLattice& lattice,
              int subdivisions, bool poles, double stretch);

  // Into `shares` how much of each post's cell has data, 0 to 1; at poles 0 or 1.
  void Read(const PostBlock& block, float* heights, float* shares) const;
  // Of all that a level's boxes about a pole reach; up to the raster's own posts, of the row next
  // to it.
  double PoleHeight(int level, bool last) const;
  // The first level that is read from overviews, if the source has any.
  int FirstReducedLevel() const;
  // Clears cached reduced posts after the source has loaded other overviews.
  void InvalidateReduced();

private:
  std::vector<double> MeansOf(std::vector<BoxSpan> columns, std::vector<BoxSpan> rows, int factor,
                              std::vector<double>& shares) const;
  std::vector<double> MeansAround(const std::vector<BoxSpan>& columns,
                                  const std::vector<BoxSpan>& rows, int factor,
                                  std::vector<double>& shares) const;

  std::shared_ptr<const PixelWindows> Pixels_;
  PostLattice Lattice_;
  int Subdivisions_;
  bool Poles_;
  double Stretch_;
  mutable std::mutex Mutex_; // of what follows
  mutable std::map<std::pair<int, bool>, double> PoleHeights_;
};

} // namespace dspace

#endif
