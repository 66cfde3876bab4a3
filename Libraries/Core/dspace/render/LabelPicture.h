// Labels and depth of a viewport: what capture's planes and picking read.
#ifndef DSPACE_RENDER_LABEL_PICTURE_H
#define DSPACE_RENDER_LABEL_PICTURE_H

#include <cstdint>
#include <memory>
#include <vector>

#include <dspace/render/Capture.h>
#include <dspace/render/DrawList.h>
#include <dspace/render/SceneDrawer.h>

class vtkDspaceRenderContext;

namespace dspace {

// The visible object and its distance at each pixel, without supersampling. The picture is reused
// until the scene or the filter changes, or until Invalidate() (a change of camera or size). The
// context must outlive it.
class LabelPicture {
public:
  // Whether the picture shows the current state of `scene` with `filter`.
  bool IsCurrent(const Scene& scene, const DrawFilter& filter) const;
  void Draw(vtkDspaceRenderContext* context, const Scene& scene, const DrawView& view,
            const DrawFilter& filter);
  void Invalidate() { this->Revision_ = 0; }

  // Of the whole picture, rows from the top down; after Draw().
  std::vector<std::uint32_t> Labels() const;
  std::vector<float> Depths() const; // metres along the camera's Z; +infinity where nothing was hit

  // The object at (x, y), or the nearest one within `radius` pixels if there is none. The
  // caller has checked that the point lies in the picture and drawn it from `scene`.
  PickResult Pick(const Scene& scene, double x, double y, int radius) const;

private:
  std::unique_ptr<RenderTarget> Target_;
  std::unique_ptr<SceneDrawer> Drawer_; // its instances differ from the colour picture's
  DrawList List_;
  DrawView View_;
  DrawFilter Filter_;
  std::uint64_t Revision_ = 0; // of the scene, in what is there; 0: none
};

} // namespace dspace

#endif
