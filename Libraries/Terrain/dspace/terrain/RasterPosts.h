// The posts of one raster, in the raster's own rows and columns.
#ifndef DSPACE_TERRAIN_RASTERPOSTS_H
#define DSPACE_TERRAIN_RASTERPOSTS_H

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <utility>
#include <vector>

#include <dspace/terrain/ElevationSource.h>
#include <dspace/terrain/PostSource.h>

namespace dspace {

struct RasterPostsOptions {
  // Each cell between four pixels is divided into 2^subdivisions a side, flat in each of the two
  // triangles that HeightGrid states: the surface is the same, its posts are closer. 0 to 24.
  int subdivisions = 0;
  bool periodic = false; // the raster goes once around a body
  // Its first and last rows of pixels lie half a pixel from the poles, where the lattice then ends:
  // needs `periodic` and subdivisions of 1 or more. A pole's height is the mean of the row next to
  // it; along each meridian the surface is straight between the two.
  bool poles = false;
  int levels = 0; // 0: until a level has at most `coarsest` cells a side
  int coarsest = 96;
};

// Level `subdivisions` has a post at each pixel's centre. Coarser levels are means over boxes as
// wide as their posts are apart, from the raster's overviews where it has them; without overviews,
// beyond 8 pixels a post, of every n-th pixel (8 x 8 a post).
// With poles, rows count from the pole: the raster's first row of pixels is row
// 2^(subdivisions - 1) of level 0, and rows of level `subdivisions` and coarser ones stand between
// rows of pixels. All posts of a pole have one height, at coarser levels the mean of the cap that
// their boxes reach.
class RasterPosts : public PostSource {
public:
  // Throws Error(InvalidArgument) for an option out of range, fewer than 2 x 2 pixels, or a
  // periodic raster that cannot be halved as often as `levels` or `coarsest` ask.
  explicit RasterPosts(std::shared_ptr<const ElevationSource> source,
                       const RasterPostsOptions& options = {});

  const std::string& GetName() const override { return this->Name_; }
  const PostLattice& GetLattice() const override { return this->Lattice_; }
  void Read(const PostBlock& block, float* heights) const override;

  const ElevationSource& Source() const { return *this->Source_; }
  int Subdivisions() const { return this->Subdivisions_; }

private:
  std::vector<double> ReadPixels(std::int64_t column, std::int64_t row, int width, int height,
                                 int factor) const;
  void ReadSubdivided(const PostBlock& block, float* heights) const;
  void ReadMeans(const PostBlock& block, float* heights) const;
  double PoleHeight(int level, bool last) const;

  std::shared_ptr<const ElevationSource> Source_;
  std::string Name_;
  PostLattice Lattice_;
  int Subdivisions_;
  bool Poles_;
  mutable std::mutex Mutex_; // of what follows
  mutable std::map<std::pair<int, bool>, double> PoleHeights_;
};

// Levels until the coarsest has at most `coarsest` cells a side; for a periodic lattice at most as
// many as halve its columns evenly.
int LevelsFor(const PostLattice& lattice, int coarsest);

} // namespace dspace

#endif
