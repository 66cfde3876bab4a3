// A whole raster in memory at full resolution, as a TerrainSurface in a local metric frame.
#ifndef DSPACE_TERRAIN_GRIDTERRAIN_H
#define DSPACE_TERRAIN_GRIDTERRAIN_H

#include <memory>
#include <optional>
#include <string>

#include <dspace/crs/SceneFrame.h>
#include <dspace/posts/HeightGrid.h>
#include <dspace/raster/ElevationSource.h>
#include <dspace/rays/GridRay.h>
#include <dspace/surface/TerrainSurface.h>

namespace dspace {

struct GridTerrainOptions {
  ElevationOptions elevation;
  // Scene origin in map coordinates; the raster's middle by default.
  std::optional<Eigen::Vector2d> origin;
  double originHeight = 0.0; // [m] above the vertical datum, where scene z = 0
  // Greatest number of posts that is loaded; about 11 bytes each. Larger rasters are rejected.
  std::size_t maximumPosts = 100000000;
};

// Posts stand at pixel centres; between them are the triangles of HeightGrid, for heights, normals,
// slopes and rays alike. The frame is SceneFrame's; up is Z everywhere. Level 0 answers everywhere.
// Rotated, sheared, south-up and non-square pixels are taken as they are. The border is the line
// through the outermost posts, half a pixel inside the raster's edge; a whole body is not closed
// across its date line.
class GridTerrain : public TerrainSurface {
public:
  // Throws what ElevationSource, HeightGrid and SceneFrame throw, and Error(Resource) for more than
  // maximumPosts.
  static std::shared_ptr<const GridTerrain> Load(const std::string& path,
                                                 const GridTerrainOptions& options = {});

  // From heights made elsewhere: [m] above `datum`, row by row from the top, NaN for none.
  // `pixelToMap` as in ElevationInfo.
  GridTerrain(const std::string& name, int columns, int rows, std::vector<double> heights,
              const Eigen::Affine2d& pixelToMap, const Crs& crs = {},
              const VerticalDatum& datum = {},
              const std::optional<Eigen::Vector2d>& origin = std::nullopt,
              double originHeight = 0.0, std::vector<std::string> warnings = {});

  const HeightGrid& Grid() const { return this->Grid_; }
  const SceneFrame& Frame() const { return this->Frame_; }
  // Pixel corners to map, of the posts that are loaded (a window's own).
  const Eigen::Affine2d& PixelToMap() const { return this->PixelToMap_; }

protected:
  TerrainBounds DoGetBounds() const override;
  SurfaceSample DoSample(const Eigen::Vector3d& p_S) const override;
  SurfaceSample DoSampleMap(const Eigen::Vector2d& map) const override;
  RayHit DoIntersect(const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S,
                     double maximumDistance) const override;
  Eigen::Vector3d DoMapToScene(const Eigen::Vector3d& map) const override;
  Eigen::Vector3d DoSceneToMap(const Eigen::Vector3d& p_S) const override;
  Eigen::Vector3d DoUp(const Eigen::Vector3d& p_S) const override;
  int DoResidentLevel(const Eigen::Vector2d& map) const override;
  void DoHeights(const Eigen::Ref<const Rows3>& points_S,
                 Eigen::Ref<Eigen::VectorXd> heights) const override;

private:
  SurfaceSample SampleGrid(const Eigen::Vector2d& g, const Eigen::Vector2d& xy_S) const;

  Eigen::Affine2d PixelToMap_;
  SceneFrame Frame_;
  HeightGrid Grid_;
  GridRay Ray_;
};

} // namespace dspace

#endif
