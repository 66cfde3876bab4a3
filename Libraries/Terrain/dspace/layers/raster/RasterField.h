// The values of a raster at places of a terrain.
#ifndef DSPACE_LAYERS_RASTERFIELD_H
#define DSPACE_LAYERS_RASTERFIELD_H

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/crs/Crs.h>
#include <dspace/layers/raster/ImageLayer.h>
#include <dspace/raster/RasterPlace.h>

namespace dspace {

struct RasterFieldOptions {
  int band = 1; // counted from 1
  // Values of the pixel that contains the place, as classes need; else bilinear between the centres
  // of pixels.
  bool nearest = false;
  std::string units;                              // empty: those that the file states
  RasterLayerOptions raster;                      // of these crs, extent and network
  std::size_t byteBudget = std::size_t(64) << 20; // of pixels in memory [bytes]
};

// One band of a raster that lies on a terrain, in any CRS of the same body: soil, thermal inertia,
// hazard. The band's scale and offset are applied. The file is read by tiles of 128 x 128 pixels
// where values are asked for, in full resolution; the latest stay in memory. Any thread may call.
//
// Bilinear values are of the up to four pixels around a place. Pixels without data are left out,
// and the weights of the others are divided by their sum; where the pixel that contains the place
// has no data, neither has the place. Beyond the centres of the outermost pixels values are those
// at the centres. Columns of a raster that goes once around the body meet at its seam.
class RasterField {
public:
  // Reads the file's header. `name` is the field's, for messages. Throws Error that names the
  // field: NotFound, Corrupt, Io, Unsupported (complex values; a CRS of another body),
  // InvalidArgument (band, extent, no overlap with the terrain).
  RasterField(const std::string& name, const std::string& path, const RasterPlace& terrain,
              const RasterFieldOptions& options = {});
  ~RasterField();
  RasterField(const RasterField&) = delete;
  RasterField& operator=(const RasterField&) = delete;

  // One value for each map place of the terrain; NaN outside the raster, without data, and where a
  // projection has no value. Throws Error(Io, Corrupt).
  Eigen::VectorXd Values(const Eigen::Ref<const Eigen::Matrix2Xd>& map) const;

  const std::string& Units() const;
  const Crs& GetCrs() const;
  double PixelSize() const; // the lesser side [m] on the ground, in the middle of the overlap
  bool Nearest() const;
  int Columns() const; // pixels of the raster
  int Rows() const;
  std::size_t Bytes() const; // of pixels in memory now
  // Assumptions made at opening; each names the option that replaces it.
  const std::vector<std::string>& Warnings() const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl_;
};

} // namespace dspace

#endif
