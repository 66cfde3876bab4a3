// Terrain as a clipmap over tiles that are read on demand.
#ifndef DSPACE_SESSION_CLIPMAP_TERRAIN_OBJECT_H
#define DSPACE_SESSION_CLIPMAP_TERRAIN_OBJECT_H

#include <atomic>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/commands/terrain/TerrainLayers.h>
#include <dspace/raster/OverviewBuild.h>
#include <dspace/state/TerrainObject.h>
#include <dspace/surface/StreamedTerrain.h>

namespace dspace::session {

// Its frame S: X east, Y north, Z up, metres; or the body-fixed frame.
class ClipmapTerrainObject : public TerrainObject {
public:
  // `cacheFolder`: where overviews are kept; empty: in memory only. Throws what ClipmapTerrain
  // throws.
  ClipmapTerrainObject(std::string name, std::shared_ptr<StreamedTerrain> surface,
                       const ClipmapOptions& options, const ElevationPyramidOptions& pyramid,
                       std::string cacheFolder);

  ClipmapTerrain& Clipmap() { return *this->Clipmap_; }
  TerrainLayers& Layers() { return this->Layers_; }
  const std::string& CacheFolder() const { return this->CacheFolder_; }
  // Describes its layers and the counters of their tiles.
  void DescribeLayers(v1::TerrainLayerList& list) const;
  bool OnBody() const override { return this->Surface_->Placement().OnBody(); }
  const StreamedTerrain& Surface() const override { return *this->Surface_; }
  std::shared_ptr<const TerrainSurface> HeldSurface() const override { return this->Surface_; }
  std::shared_ptr<const StreamedTerrain> SharedSurface() const { return this->Surface_; }
  // The command that set its own style; null: none.
  const v1::StyleTerrain* StyleCommand() const {
    return this->StyleCommand_ ? &*this->StyleCommand_ : nullptr;
  }
  void SetStyleCommand(const v1::StyleTerrain& command) { this->StyleCommand_ = command; }
  TrackedGround& Ground() override { return *this->Surface_; }
  const StreamedTerrain& Undisturbed() const override { return this->Surface_->Undisturbed(); }
  RasterPlace Place() const override { return PlaceOf(*this->Surface_); }
  void Draw(GraphicsObject& object) const override { object.custom = this->Clipmap_; }
  std::vector<Part> Triangles(std::size_t triangleBudget) const override;
  void Describe(v1::TerrainReply& reply) const override;
  // Builds overviews in the background into `folder`; `options` as for ElevationCache::Build.
  void BuildOverviews(const std::string& folder, const ElevationOptions& options);
  // Checks its arguments only: a clipmap's posts follow the cameras.
  bool Focus(const std::vector<Eigen::Vector2d>& points_S, double radius) override;
  void ForgetViewport(const std::string& viewport) override {
    this->Clipmap_->SetStyleIn(viewport, std::nullopt);
  }
  bool Explains(const std::string& viewport, const std::string& layer,
                const std::function<bool(const Membership&)>& shown) const override;
  void EndBackgroundWork() override { this->Build_.reset(); }

private:
  std::shared_ptr<StreamedTerrain> Surface_;
  std::optional<v1::StyleTerrain> StyleCommand_;
  std::shared_ptr<ClipmapTerrain> Clipmap_;
  TerrainLayers Layers_;
  std::string CacheFolder_;
  std::atomic<int> Overviews_{0};        // number built since it was opened
  std::unique_ptr<OverviewBuild> Build_; // destroyed before the members that it changes
};

} // namespace dspace::session

#endif
