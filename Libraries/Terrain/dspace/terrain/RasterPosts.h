// The posts of one raster, in the raster's own rows and columns.
#ifndef DSPACE_TERRAIN_RASTERPOSTS_H
#define DSPACE_TERRAIN_RASTERPOSTS_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/terrain/ElevationSource.h>
#include <dspace/terrain/PostSource.h>

namespace dspace {

struct RasterPostsOptions {
  // Each cell between four pixels is divided into 2^subdivisions a side, flat in each of the two
  // triangles that HeightGrid states: the surface is the same, its posts are closer. 0 to 24.
  int subdivisions = 0;
  bool periodic = false; // the raster goes once around a body
  int levels = 0;        // 0: until a level has at most `coarsest` cells a side
  int coarsest = 96;
};

// Level `subdivisions` has a post at each pixel's centre. Coarser levels are means over boxes as
// wide as their posts are apart, from the raster's overviews where it has them; without overviews,
// beyond 8 pixels a post, of every n-th pixel (8 x 8 a post).
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

  std::shared_ptr<const ElevationSource> Source_;
  std::string Name_;
  PostLattice Lattice_;
  int Subdivisions_;
};

// Levels until the coarsest has at most `coarsest` cells a side; for a periodic lattice at most as
// many as halve its columns evenly.
int LevelsFor(const PostLattice& lattice, int coarsest);

} // namespace dspace

#endif
