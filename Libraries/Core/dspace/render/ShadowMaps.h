// The Sun's shadow maps of one viewport, with OpenGL.
#ifndef DSPACE_RENDER_SHADOW_MAPS_H
#define DSPACE_RENDER_SHADOW_MAPS_H

#include <optional>
#include <vector>

#include <dspace/render/DrawKey.h>
#include <dspace/render/DrawList.h>
#include <dspace/render/shadows/CasterTiles.h>

class vtkDspaceHubWindow;

namespace dspace {

class GpuStore;
struct RenderStatistics;

// One layer of a depth texture a cascade, and one more for each ground (ShadowGround) with all of
// its maps, cascade k at the place (k mod 4, k / 4) of its 4 x 4; 32-bit floats, 1 towards the Sun,
// so that what receives shadows is resolved best. Casters that stand higher than a map's range are
// drawn at its end.
// Only the texels of CasterTiles are cleared and drawn: those of tiles without casters mean
// nothing.
class ShadowMaps {
public:
  ShadowMaps(vtkDspaceHubWindow* window, GpuStore& store) : Window_(window), Store_(store) {}
  ShadowMaps(const ShadowMaps&) = delete;
  ShadowMaps& operator=(const ShadowMaps&) = delete;
  ~ShadowMaps() { this->Release(); }

  // What draws casters: `casters` in the view that a map is drawn for, with reversed depth, the map
  // bound. Custom geometry is drawn into the maps of its ground or into the others; meshes into the
  // others.
  static constexpr int NoGround = -1;
  class Painter {
  public:
    virtual ~Painter() = default;
    // Makes ready the casters that the picture does not show. Returns false if some of their data
    // are not there yet.
    virtual bool PrepareCasters(const DrawList& casters, const DrawView& view) = 0;
    virtual int GroundOf(const DrawCustom& object) = 0; // its layer, or NoGround
    virtual std::vector<LightHull> Hulls(const DrawCustom& object, const DrawList& list,
                                         const DrawView& view) = 0; // CustomDrawer::Hulls()
    virtual void Draw(const DrawList& casters, const DrawView& view, int ground) = 0;
    // Adds what Draw() draws from, besides the view's clip, texel and takes. Returns false if that
    // is not known.
    virtual bool AddTo(DrawKey& key, const DrawList& casters, const DrawView& view, int ground) = 0;
  };
  // Draws all maps of a fit for what `seen` shows, and sets them in `view`; a map whose casters,
  // fit and receivers have not changed since it was drawn is kept. Extends the fit's ranges to the
  // casters. Returns whether all casters' data were there. Throws Error(Resource) about `viewport`
  // when there is no memory for the maps.
  bool Update(const Scene& scene, const DrawList& seen, DrawView& view, CascadeFit fit,
              Painter& painter, RenderStatistics& statistics);
  unsigned int Texture() const { return this->Texture_; }
  // CasterTiles::Tops(): a layer a cascade, and as many for each ground.
  unsigned int Tiles() const { return this->Tiles_; }
  void Release();

private:
  void Resize(const std::string& viewport, int size, int count);
  void ResizeTiles(int count);
  // Where the list's ground of a layer is, or all else.
  std::vector<LightHull> HullsOf(const DrawList& list, const DrawView& view, int ground,
                                 Painter& painter) const;
  LightHull HullOf(const DrawBatch& batch, const DrawInstance& instance) const;
  void UploadTiles(const CasterTiles& tiles, int layer) const;
  // `takers`: what takes the shadows of a ground's map.
  void DrawMap(const DrawList& casters, DrawView view, const std::array<int, 4>& texels,
               const CascadeFit& fit, int k, int ground, Painter& painter,
               const std::vector<LightHull>& takers, RenderStatistics& statistics);

  vtkDspaceHubWindow* Window_;
  GpuStore& Store_;
  unsigned int Texture_ = 0;
  unsigned int Tiles_ = 0;
  int TileLayers_ = 0;
  std::vector<unsigned int> Framebuffers_; // one a layer
  int Size_ = 0;
  std::vector<DrawList> Casters_; // one a layer
  // Of the map that each place holds, k of the objects' and then k of each ground's; empty: nothing
  // that could be kept.
  std::vector<std::optional<DrawKey>> Keys_;
};

} // namespace dspace

#endif
