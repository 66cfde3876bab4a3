// Draws a DrawList with OpenGL: opaque surfaces, then translucent ones layer by layer.
#ifndef DSPACE_RENDER_SCENE_DRAWER_H
#define DSPACE_RENDER_SCENE_DRAWER_H

#include <array>
#include <map>
#include <memory>
#include <set>
#include <unordered_map>
#include <vector>

#include <dspace/render/CustomDrawer.h>
#include <dspace/render/CustomDrawers.h>
#include <dspace/render/DrawList.h>
#include <dspace/render/EmptyVertexArray.h>
#include <dspace/render/GpuStore.h>
#include <dspace/render/RenderTarget.h>
#include <dspace/render/ShadowMaps.h>
#include <dspace/render/SurfaceShaders.h>

class vtkDspaceHubWindow;
class vtkShaderProgram;

namespace dspace {

// One a viewport: it keeps the viewport's instance buffer, which is uploaded again only where it
// differs from what is there. Depth is reversed (near 1, far 0, clip control zero-to-one,
// GL_GEQUAL): float depth then resolves a millionth of the distance from centimetres to infinity.
// Translucent surfaces are peeled front to back (Everitt 2001) and blended in linear light; after
// MaximumLayers the rest, which lies behind, is left out.
class SceneDrawer : private ShadowMaps::Painter {
public:
  static constexpr int MaximumLayers = 16;

  // All of them must outlive it.
  SceneDrawer(vtkDspaceHubWindow* window, GpuStore& store, const CustomDrawers& drawers,
              RenderStatistics& statistics);
  SceneDrawer(const SceneDrawer&) = delete;
  SceneDrawer& operator=(const SceneDrawer&) = delete;
  ~SceneDrawer();

  // Into `target` (Display or Light, with depth), which must be bound and cleared. The background
  // (sRGB, 0 to 1; a vertical gradient) is drawn where nothing opaque is.
  struct Background {
    std::array<double, 3> bottom = {0.0, 0.0, 0.0};
    std::array<double, 3> top = {0.0, 0.0, 0.0};
  };
  void Clear(const Background& background);
  void ClearLight(const Background& background); // of a Light target
  // Uploads the data of custom geometry for the next pictures, before any target is bound. Returns
  // false if some data is not loaded yet.
  bool Prepare(const DrawList& list, const DrawView& view, int samples, bool labels = false);
  // Draws the Sun's shadow maps where the view has shadows, and sets `view.shadows`; after
  // Prepare(), before any target is bound. Returns false if some data of what is outside the
  // picture, and may throw a shadow into it, is not loaded yet.
  bool DrawShadows(const Scene& scene, const DrawList& list, DrawView& view, int samples);
  // Whether DrawColor() needs `view.exposure`; after Prepare().
  bool MixesDisplayColors(const DrawList& list, const DrawView& view, int samples);
  // `samples` is the supersampling factor: lines, points and billboards scale with it.
  void DrawColor(const DrawList& list, const DrawView& view, RenderTarget& target, int samples,
                 const Background* background = nullptr);
  // Captions of custom geometry over the last picture.
  std::vector<Caption> Captions(const DrawList& list, const DrawView& view,
                                const RenderTarget& target, int samples);
  // Into `target` (Label, with depth), cleared first.
  void DrawLabels(const DrawList& list, const DrawView& view, RenderTarget& target);
  // Angles of incidence, emission and phase [deg] and 1 into `target` (Light, with depth), cleared
  // first; 0 where they are not known. Without a Sun only the emission is defined.
  void DrawAngles(const DrawList& list, const DrawView& view, RenderTarget& target);
  // Mean of the samples of `source` into `target` (both Display, or both Light).
  void Downsample(const RenderTarget& source, RenderTarget& target, int samples);

  void Release();

private:
  CustomDrawing Drawing(const DrawCustom& object, const DrawList& list, const DrawView& view,
                        int samples);
  // The least and greatest depths [m] along the view's axis of what a coarse picture of the list
  // shows, with some room; nothing: {0, 1}.
  std::array<double, 2> SeenDepths(const DrawList& list, const DrawView& view);
  // The list's labels and depths into what is bound.
  void DrawDepths(const DrawList& list, const DrawView& view);
  bool PrepareOne(const DrawCustom& object, const DrawList& list, const DrawView& view, int samples,
                  bool labels);
  bool PrepareCasters(const DrawList& casters, const DrawView& view) override;
  int GroundOf(const DrawCustom& object) override;
  std::vector<LightHull> Hulls(const DrawCustom& object, const DrawList& list,
                               const DrawView& view) override;
  void Draw(const DrawList& casters, const DrawView& view, int ground) override;
  bool AddTo(DrawKey& key, const DrawList& casters, const DrawView& view, int ground) override;
  void DrawBackground(const Background& background, int height);
  void Upload(const DrawList& list);
  vtkShaderProgram* ProgramOf(const DrawBatch& batch, const DrawList& list,
                              SurfaceShaders::Features features);
  void DrawBatches(const DrawList& list, const DrawView& view, bool translucent,
                   SurfaceShaders::Features features, int samples);
  // What the shadow maps say of the list's opaque meshes (SurfaceShaders::SunMask).
  void DrawLitMask(const DrawList& list, const DrawView& view, const RenderTarget& target);
  void DrawTranslucentCustoms(const DrawList& list, const DrawView& view, RenderTarget& target,
                              int samples);
  // Puts geometry that has no angles in front of what has.
  void HideAngles(const std::vector<const DrawCustom*>& customs, const DrawList& list,
                  const DrawView& view, RenderTarget& target);
  void PeelTranslucent(const DrawList& list, const DrawView& view, RenderTarget& target,
                       int samples);

  vtkDspaceHubWindow* Window_;
  GpuStore& Store_;
  const CustomDrawers& Drawers_;
  RenderStatistics& Statistics_;
  SurfaceShaders Shaders_;
  ShadowMaps Shadows_;
  struct Custom {
    std::weak_ptr<const CustomGeometry> geometry;
    std::unique_ptr<CustomDrawer> drawer;
  };
  std::unordered_map<const CustomGeometry*, Custom> Customs_;
  std::set<ObjectId> Prepared_;     // of the picture, and what throws shadows into it
  std::map<ObjectId, int> Grounds_; // of the picture: ShadowGround
  std::vector<DrawInstance> Uploaded_;
  unsigned int InstanceBuffer_ = 0;
  std::size_t InstanceCapacity_ = 0;
  EmptyVertexArray EmptyVertices_;
  unsigned int Query_ = 0;
  std::unique_ptr<RenderTarget> Layers_[2]; // Linear, with depth: the layer now and the one before
  std::unique_ptr<RenderTarget> Coarse_;    // Label, with depth: for SeenDepths()
  std::unique_ptr<RenderTarget> Sum_;       // Linear: layers blended so far, front to back
  std::unique_ptr<RenderTarget> Planes_;    // Light, with depth: for DrawLitMask()
  std::unique_ptr<RenderTarget> LitMask_;   // Number
  bool Masked_ = false;                     // the lit mask is there
  bool FirstLayer_ = false;                 // for the peel uniforms
  bool Light_ = false;                      // the target of the colours is Light
};

} // namespace dspace

#endif
