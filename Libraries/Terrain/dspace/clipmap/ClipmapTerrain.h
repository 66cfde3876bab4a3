// A terrain that is drawn as a clipmap: its posts, their placement and style.
#ifndef DSPACE_TERRAIN_CLIPMAPTERRAIN_H
#define DSPACE_TERRAIN_CLIPMAPTERRAIN_H

#include <array>
#include <map>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <dspace/clipmap/ClipmapStyle.h>
#include <dspace/horizon/HorizonBlocks.h>
#include <dspace/layers/ColorTiles.h>
#include <dspace/posts/PostPlacement.h>
#include <dspace/pyramid/ElevationPyramid.h>
#include <dspace/scene/CustomGeometry.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {

struct ClipmapOptions {
  int cells = 124;                          // a side of each level: a multiple of 4 from 12 to 252
  std::array<double, 2> heights = {0, 0};   // [m] that the posts stay within
  std::shared_ptr<const Material> material; // null: Material's defaults
  // From level-0 posts (c, r) to the texture coordinates of the material's texture; (0, 0) is its
  // bottom-left corner.
  Eigen::Affine2d postToTexture = Eigen::Affine2d::Identity();
  // From level-0 posts to the map's coordinates, along which a plane's grid lines run; a body's run
  // along its meridians and parallels [deg].
  Eigen::Affine2d postToMap = Eigen::Affine2d::Identity();
  double deadline = 60.0; // [s] longest wait of a saved picture for its data
};

// Posts and where they stand.
struct ClipmapChart {
  std::shared_ptr<ElevationPyramid> pyramid;
  PostPlacement placement;
};

class ClipmapTerrain : public CustomGeometry {
public:
  // `poles`: charts (Pole) of a whole body's poles, which are drawn instead while the camera is
  // within 30 degrees of one. `grids`: where colour layers lie, one a chart (ColorGridsOf); none:
  // there are no layers. Throws Error(InvalidArgument) for an option out of range.
  ClipmapTerrain(std::shared_ptr<ElevationPyramid> pyramid, const PostPlacement& placement,
                 const ClipmapOptions& options, std::vector<ClipmapChart> poles = {},
                 std::vector<ColorGrid> grids = {});

  BoundingSphere Bounds() const override { return this->Bounds_; }
  std::uint64_t Revision() const override;
  std::vector<Member> Members() const override; // of its styles and layers

  // May change at any time between two pictures. Throws what ClipmapStyle::Check throws, and
  // Error(Unsupported) for details on a body.
  void SetStyle(const ClipmapStyle& style);
  const ClipmapStyle& Style() const { return this->Style_; }
  // Another style for one viewport, but for noise and details, which are Style()'s; none: Style()
  // again. Throws as SetStyle, and Error(InvalidArgument) for noise or details.
  void SetStyleIn(const std::string& viewport, const std::optional<ClipmapStyle>& style);
  bool HasStyleIn(const std::string& viewport) const { return this->Styles_.count(viewport) != 0; }
  // What is drawn in the viewport while all of it is shown.
  ClipmapStyle StyleIn(const std::string& viewport) const;

  // The colour layers, under the style; may change at any time. Null without grids.
  const std::shared_ptr<LayerStack>& Layers() const { return this->Layers_; }
  const std::vector<ColorGrid>& Grids() const { return this->Grids_; }
  // The tiles of the layers. The first call creates them and starts threads. Requires grids.
  ColorTiles& Tiles() const;
  // Statistics of the tiles; zeros before the first picture with layers.
  ColorTilesStatistics TileStatistics() const;

  // The horizons of a chart's posts. The first call creates them and starts threads.
  std::shared_ptr<HorizonBlocks> Horizons(std::size_t chart) const;

  // The terrain's own, which comes first, then the poles'.
  const std::vector<ClipmapChart>& Charts() const { return this->Charts_; }
  const std::shared_ptr<ElevationPyramid>& Pyramid() const { return this->Charts_[0].pyramid; }
  const PostPlacement& Placement() const { return this->Charts_[0].placement; }
  // Index of the chart that is drawn for a camera at p_S.
  std::size_t ChartAt(const Eigen::Vector3d& p_S) const;
  const ClipmapOptions& Options() const { return this->Options_; }

private:
  std::vector<ClipmapChart> Charts_;
  ClipmapOptions Options_;
  BoundingSphere Bounds_;
  ClipmapStyle Style_;
  std::map<std::string, ClipmapStyle> Styles_; // by viewport
  std::uint64_t StyleRevision_ = 0;
  std::vector<ColorGrid> Grids_;
  std::shared_ptr<LayerStack> Layers_;
  mutable std::mutex Mutex_; // of what follows
  mutable std::unique_ptr<ColorTiles> Tiles_;
  mutable std::vector<std::shared_ptr<HorizonBlocks>> Horizons_; // one a chart, or null
};

} // namespace dspace

#endif
