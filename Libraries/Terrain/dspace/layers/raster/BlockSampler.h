// Texels of a colour grid as means of a raster's pixels, across CRS. Not for public headers.
#ifndef DSPACE_LAYERS_BLOCKSAMPLER_H
#define DSPACE_LAYERS_BLOCKSAMPLER_H

#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dspace/layers/ColorLayer.h>

#include <dspace/crs/CrsTransform.h>
#include <dspace/layers/raster/RasterLevels.h>

namespace dspace {

// Where a raster lies on the map. Pixel (0, 0) is its outer corner.
struct RasterPosition {
  Crs crs;
  Eigen::Affine2d mapToPixel = Eigen::Affine2d::Identity();
  int width = 0;
  int height = 0;
  double turn = 0.0;     // pixels once around the body; 0 where columns do not repeat
  bool periodic = false; // the column after the last is the first
};

// Grid maps to the raster's pixels. Not finite where a projection has no value. One thread at a
// time.
class PixelFinder {
public:
  // Throws Error(Unsupported) for CRS between which PROJ knows no way.
  PixelFinder(const Crs& grid, const RasterPosition& raster);
  void Find(Eigen::Matrix2Xd& places) const; // in place

private:
  std::unique_ptr<CrsTransform> Transform_; // null: the same
  Eigen::Affine2d MapToPixel_;
};

// A texel is the mean of the raster's bilinear surface over it, taken at k x k places that are at
// most a pixel apart; pixels are those of a level where a texel is 1.5 to 3 of them. What a texel
// is depends on its place in the grid alone, not on the block.
class BlockSampler {
public:
  BlockSampler(std::shared_ptr<const RasterLevels> levels, RasterPosition raster);

  const RasterPosition& Raster() const { return this->Raster_; }
  std::size_t KeptBytes() const { return this->Levels_->KeptBytes(); }
  // Channels times opacity, and opacity, one after the other; false where all opacity is 0. Any
  // thread may call.
  bool Sample(const ColorGrid& grid, const ColorBlock& block, std::vector<float>& texels) const;

private:
  std::unique_ptr<PixelFinder> AcquireFinder(const Crs& grid) const;
  void ReleaseFinder(const Crs& grid, std::unique_ptr<PixelFinder> finder) const;

  std::shared_ptr<const RasterLevels> Levels_;
  RasterPosition Raster_;
  mutable std::mutex Mutex_;
  mutable std::multimap<std::string, std::unique_ptr<PixelFinder>> Finders_;
};

} // namespace dspace

#endif
