// The Sun's shadow maps of one viewport, with OpenGL.
#ifndef DSPACE_RENDER_SHADOW_MAPS_H
#define DSPACE_RENDER_SHADOW_MAPS_H

#include <functional>
#include <vector>

#include <dspace/render/DrawList.h>

class vtkDspaceHubWindow;

namespace dspace {

// One layer of a depth texture a cascade; 32-bit floats, 1 towards the Sun, so that what receives
// shadows is resolved best. Casters that stand higher than a map's range are drawn at its end.
class ShadowMaps {
public:
  explicit ShadowMaps(vtkDspaceHubWindow* window) : Window_(window) {}
  ShadowMaps(const ShadowMaps&) = delete;
  ShadowMaps& operator=(const ShadowMaps&) = delete;
  ~ShadowMaps() { this->Release(); }

  // Draws all maps of a fit: `draw` draws the casters of one, with the list and the view that a map
  // is drawn for, and those of the ground where `ground` is true (CascadeFit::ground; such maps
  // follow the others); reversed depth, and the map is bound. Extends the fit's ranges to the
  // casters. Throws Error(Resource) about `viewport` when there is no memory for the maps.
  using Draw = std::function<void(const DrawList& casters, const DrawView& view, bool ground)>;
  void Update(const Scene& scene, const DrawView& view, const DrawFilter& filter, CascadeFit& fit,
              const Draw& draw);
  unsigned int Texture() const { return this->Texture_; }
  void Release();

private:
  void Resize(const std::string& viewport, int size, int count);

  vtkDspaceHubWindow* Window_;
  unsigned int Texture_ = 0;
  std::vector<unsigned int> Framebuffers_; // one a layer
  int Size_ = 0;
  std::vector<DrawList> Casters_; // one a layer
};

} // namespace dspace

#endif
