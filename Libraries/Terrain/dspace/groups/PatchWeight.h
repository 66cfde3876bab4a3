// The weight of a patch against the ground under it.
#ifndef DSPACE_TERRAIN_PATCHWEIGHT_H
#define DSPACE_TERRAIN_PATCHWEIGHT_H

#include <array>
#include <cstdint>
#include <vector>

#include <dspace/raster/ElevationSource.h>

#include <dspace/groups/PatchRanges.h>

namespace dspace {

// 0 within three cells of the raster's edge and of every pixel without data, from there rising
// smoothly (3 s^2 - 2 s^3, s the share of the margin) to 1 at a margin's distance [m]; straight
// between the cells. Cells are pixels, or 2^n x 2^n of them where the raster has over 4 million;
// one with any pixel without data has none. A raster of over 16 million pixels is read at a value
// a cell: holes that its overviews do not show, or that lie between the pixels read, count nothing.
// It changes by at most 1.5 sqrt(2) / margin a metre.
class PatchWeight {
public:
  // `metres` is a pixel's size on the ground. Throws what ElevationSource throws.
  PatchWeight(const ElevationSource& source, const Eigen::Vector2d& metres, double margin);

  // At a place in pixels from the raster's corner; its mean over 2^level pixels about there.
  double At(const Eigen::Vector2d& pixel, int level) const;
  // Bounds of At(pixel, 0) in a box; 1 exactly where all of it is.
  std::array<double, 2> Over(const Eigen::AlignedBox2d& pixels) const;

  bool Empty() const { return !(this->Heights_[0] <= this->Heights_[1]); } // no pixel has data
  double Greatest() const { return this->Greatest_; }
  // Of the pixels that were read [m], and whether those were all.
  const std::array<double, 2>& Heights() const { return this->Heights_; }
  bool HeightsAreExact() const { return this->Exact_; }
  const PatchRanges& Ranges() const { return this->Ranges_; } // of nothing where they are not

private:
  struct Level {
    int columns = 0;
    int rows = 0;
    std::vector<float> weights;
  };
  std::vector<std::uint8_t> ReadMask(const ElevationSource& source);
  void AddLevels();

  int Bits_ = 0; // a cell is 2^Bits_ pixels a side
  std::vector<Level> Levels_;
  std::array<double, 2> Heights_;
  double Greatest_ = 0.0;
  bool Exact_ = true;
  PatchRanges Ranges_;
  PatchRanges Shares_; // of the finest weights
};

} // namespace dspace

#endif
