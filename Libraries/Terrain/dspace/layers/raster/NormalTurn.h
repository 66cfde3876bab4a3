// Turns vectors from the axes of a raster into those of a chart. Not for public headers.
#ifndef DSPACE_LAYERS_NORMALTURN_H
#define DSPACE_LAYERS_NORMALTURN_H

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <dspace/layers/ColorLayer.h>

#include <dspace/layers/raster/GroundAxes.h>

namespace dspace {

// The axes of a chart, in which tiles hold normals: of a plane the scene's X and Y; of a sphere
// east and north; at a pole along columns and against rows of its posts. The third is up.
//
// Any thread may call.
class NormalTurn {
public:
  // `raster`: whose map x and y the vectors have; null: they have east and north.
  NormalTurn(const ColorGrid& grid, const Crs* raster);

  // One matrix a texel of the block, row by row: horizontal numbers of the raster to those of the
  // chart. NaN where a projection has no value. Found at places 32 texels apart, and at each texel
  // where they differ by more than some degrees.
  std::vector<Eigen::Matrix2d> Of(const ColorGrid& grid, const ColorBlock& block) const;

private:
  std::vector<Eigen::Matrix2d> At(const ColorGrid& grid, int zoom,
                                  const Eigen::Matrix2Xd& texels) const;

  // Null: of no use, since both have the same axes.
  std::unique_ptr<GroundAxes> GridAxes_;
  std::unique_ptr<GroundAxes> RasterAxes_;
  std::unique_ptr<CrsTransform> ToRaster_;
};

} // namespace dspace

#endif
