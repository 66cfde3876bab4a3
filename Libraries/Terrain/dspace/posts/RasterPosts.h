// The posts of one raster, in the raster's own rows and columns.
#ifndef DSPACE_TERRAIN_RASTERPOSTS_H
#define DSPACE_TERRAIN_RASTERPOSTS_H

#include <memory>
#include <string>

#include <dspace/posts/PostSource.h>
#include <dspace/raster/ElevationSource.h>

namespace dspace {

class PixelWindows;
class RasterMeans;

struct RasterPostsOptions {
  // Each cell between four pixels is divided into 2^subdivisions a side, flat in each of the two
  // triangles that HeightGrid states: the surface is the same, its posts are closer. 0 to 24.
  int subdivisions = 0;
  bool periodic = false; // the raster goes once around a body
  // Its first and last rows of pixels lie half a pixel from the poles, where the lattice then ends:
  // needs `periodic` and subdivisions of 1 or more. A pole's height is the mean of the row next to
  // it; along each meridian the surface is straight between the two.
  bool poles = false;
  // Number of columns around the body for a periodic raster; at least its own. It must halve as
  // often as needed; ColumnsAround() computes it. 0: the raster's own.
  std::int64_t columns = 0;
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
// With `columns` of its own choice the lattice is finer than the raster along the parallels, by
// Stretch(): posts of levels FullLevel() to `subdivisions` lie on the raster's surface, those of
// finer levels on the triangles between the posts of FullLevel(), and the boxes of coarser ones are
// as wide as its posts are apart. Between two columns of pixels that surface departs from the
// raster's by about a sixteenth of its second differences, at most.
class RasterPosts : public PostSource {
public:
  // Throws Error(InvalidArgument) for an option out of range, fewer than 2 x 2 pixels, or a
  // periodic raster that cannot be halved as often as `levels` or `coarsest` ask.
  explicit RasterPosts(std::shared_ptr<const ElevationSource> source,
                       const RasterPostsOptions& options = {});
  ~RasterPosts() override;

  const std::string& GetName() const override { return this->Name_; }
  const PostLattice& GetLattice() const override { return this->Lattice_; }
  void Read(const PostBlock& block, float* heights) const override;
  // Null where the columns are stretched.
  std::unique_ptr<PostProbe> MakeProbe() const override;
  // The same, and writes to `shares` how much of each post's cell has data, 0 to 1. At poles, and
  // in levels that are not means, it is 0 or 1.
  void ReadWithShares(const PostBlock& block, float* heights, float* shares) const;
  bool Poles() const { return this->Poles_; }

  const ElevationSource& Source() const { return *this->Source_; }
  int Subdivisions() const { return this->Subdivisions_; }
  // Halvings of a pixel that posts on chosen columns are taken at.
  static constexpr int Finer = 2;
  static constexpr int Most = 24; // subdivisions
  // The first level that is read from overviews, if the source has any.
  int FirstReducedLevel() const;
  // Clears cached reduced posts after the source has loaded other overviews.
  void InvalidateReduced();
  // The finest level with information of its own: posts of finer levels lie on its triangles.
  int FullLevel() const { return this->Full_; }
  // Pixels along a row from a post of level `subdivisions` to the next; 1 unless columns are given.
  double Stretch() const { return this->Stretch_; }

private:
  void ReadSubdivided(const PostBlock& block, float* heights) const;

  std::shared_ptr<const ElevationSource> Source_;
  std::shared_ptr<const PixelWindows> Pixels_; // of it
  std::string Name_;
  PostLattice Lattice_;
  int Subdivisions_;
  bool Poles_;
  double Stretch_ = 1.0;
  int Full_ = 0;
  std::unique_ptr<RasterMeans> Means_;
};

// Number of levels until the coarsest has at most `coarsest` cells a side; for a periodic lattice
// at most as many as halve its columns evenly.
int LevelsFor(const PostLattice& lattice, int coarsest);

// The number of columns for a raster that goes once around a body: the least number, from its own
// on, that halves evenly until at most twice `coarsest` columns and at most `coarsest` cells
// between rows are left.
std::int64_t ColumnsAround(int columns, int rowCells, int coarsest);

} // namespace dspace

#endif
