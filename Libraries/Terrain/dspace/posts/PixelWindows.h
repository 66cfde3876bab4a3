// Pixels of any window of a raster, also beyond its edges. Not for public headers.
#ifndef DSPACE_TERRAIN_PIXELWINDOWS_H
#define DSPACE_TERRAIN_PIXELWINDOWS_H

#include <cstdint>
#include <memory>
#include <vector>

#include <dspace/raster/ElevationSource.h>
#include <dspace/raster/PixelTiles.h>

namespace dspace {

class PixelWindows {
public:
  // `periodic`: the raster goes once around a body.
  PixelWindows(std::shared_ptr<const ElevationSource> source, bool periodic);

  // Of the raster reduced by `factor`; NaN outside it, wrapped where periodic. Any thread may call.
  std::vector<double> Read(std::int64_t column, std::int64_t row, int width, int height,
                           int factor) const;
  const RasterWindow& Whole() const { return this->Source_->Info().window; }
  bool Periodic() const { return this->Periodic_; }
  const PixelTiles& Tiles() const { return this->Few_; } // of the raster at full resolution

private:
  std::shared_ptr<const ElevationSource> Source_;
  PixelTiles Few_; // of it
  bool Periodic_;
};

} // namespace dspace

#endif
