// Draws a ClipmapTerrain with OpenGL.
#ifndef DSPACE_TERRAIN_CLIPMAPDRAWER_H
#define DSPACE_TERRAIN_CLIPMAPDRAWER_H

#include <array>
#include <memory>
#include <vector>

#include <dspace/clipmap/ClipmapBlocks.h>
#include <dspace/clipmap/ClipmapHorizon.h>
#include <dspace/clipmap/ClipmapLevels.h>
#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/clipmap/arithmetic/ClipmapIndices.h>
#include <dspace/clipmap/gl/LayerDrawing.h>
#include <dspace/render/CustomDrawer.h>
#include <dspace/render/SurfaceShaders.h>

namespace dspace {

struct ClipmapCamera;

// One layer of a texture array holds a level's posts; each level is drawn as a ring around the next
// finer one with indices that all levels share, in blocks that are left out where the view does not
// see them. Of a body the chart under the camera is drawn.
class ClipmapDrawer : public CustomDrawer {
public:
  // The terrain is not kept alive: it is drawn while a scene has it, and then this goes, too.
  explicit ClipmapDrawer(const ClipmapTerrain& terrain);
  ~ClipmapDrawer() override;

  bool Prepare(const CustomDrawing& drawing) override;
  double NearestDepth(const CustomDrawing& drawing) override;
  bool ShadowsItself(const CustomDrawing& drawing) override;
  std::vector<LightHull> Hulls(const CustomDrawing& drawing) override;
  void DrawColor(const CustomDrawing& drawing) override;
  bool MixesDisplayColors(const CustomDrawing& drawing) override;
  void DrawLabels(const CustomDrawing& drawing) override;
  bool AddTo(DrawKey& key, const CustomDrawing& drawing) override;
  bool DrawAngles(const CustomDrawing& drawing) override;
  std::vector<Caption> Captions(const CustomDrawing& drawing, const RenderTarget& target) override;

private:
  // State of one chart of the terrain.
  struct Chart {
    Chart(const ClipmapChart& from, const ClipmapOptions& options)
        : placement(from.placement), levels(from.pyramid, options.cells), heights(options.heights) {
    }
    PostPlacement placement;
    ClipmapLevels levels;
    ClipmapLevels::State state;
    std::array<double, 2> heights; // [m] that nothing that is drawn leaves; at first a guess
    ClipmapRanges ranges;
    std::uint64_t uploads = 0; // of posts, so far
    unsigned int texture = 0;
    std::unique_ptr<ClipmapHorizon> horizon; // null: no shadows yet
    unsigned int horizonTexture = 0;
    // Some level of it is there.
    bool Drawable() const { return this->state.finest < this->levels.Count(); }
  };
  void LoadTextures(const CustomDrawing& drawing) const;
  void Update(Chart& chart, const CustomDrawing& drawing) const;
  static void UpdateAbout(Chart& chart, const Eigen::Vector3d& p_S, const CustomDrawing& drawing,
                          double deadline);
  bool PrepareLayers(const CustomDrawing& drawing);
  bool IsLit(const CustomDrawing& drawing) const;
  bool ShowsTracks() const; // on the active chart
  void Create();
  static void CreateTexture(Chart& chart);
  bool HasFarShadows(const CustomDrawing& drawing) const;
  bool PrepareHorizon(const CustomDrawing& drawing);
  std::size_t ActiveIndex() const; // of the terrain's charts
  // Of DrawView::shadowGrounds that with this terrain; -1: none.
  static int OwnGround(const CustomDrawing& drawing);
  void Draw(const CustomDrawing& drawing, SurfaceShaders::Features features);
  // Of each level, from the finest on.
  using Blocks = std::vector<std::vector<ClipmapBlocks::Block>>;
  Blocks BlocksIn(const ClipmapCamera& camera, const DrawView& view) const;
  // The finest level that a view draws: of a shadow map, the coarsest whose posts are no further
  // apart than its texels.
  int FinestIn(const DrawView& view) const;
  void DrawBlocks(const CustomDrawing& drawing, SurfaceShaders::Features features,
                  const ClipmapCamera& camera, const Blocks& blocks);

  const ClipmapTerrain* Terrain_;
  ClipmapIndices Indices_;
  ClipmapStyle Style_;                         // of the picture, without what it hides
  std::vector<std::unique_ptr<Chart>> Charts_; // of the terrain's; null until the camera is there
  Chart* Active_ = nullptr;
  LayerDrawing Layers_;
  LayerDrawing Normals_; // of lit terrain
  unsigned int VertexArray_ = 0;
  unsigned int VertexBuffer_ = 0;
  unsigned int IndexBuffer_ = 0;
};

} // namespace dspace

#endif
