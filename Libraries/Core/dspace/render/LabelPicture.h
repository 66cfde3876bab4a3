// Labels and depth of a viewport: what capture's planes and picking read.
#ifndef DSPACE_RENDER_LABEL_PICTURE_H
#define DSPACE_RENDER_LABEL_PICTURE_H

#include <array>
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

  // Of the last picture, with its near and far distances.
  const DrawView& View() const { return this->View_; }
  // Of the whole picture, rows from the top down; after Draw().
  std::vector<std::uint32_t> Labels() const;
  std::vector<float> Depths() const; // metres along the camera's Z; +infinity where nothing was hit

  // Metres along each pixel's ray from its origin (Projection::PixelRay); +infinity where nothing
  // was hit.
  std::vector<float> Ranges() const;

  // The object at (x, y), or the nearest one within `radius` pixels if there is none. The
  // caller has checked that the point lies in the picture and drawn it from `scene`. `pixel`: its
  // column and row.
  PickResult Pick(const Scene& scene, double x, double y, int radius,
                  std::array<int, 2>& pixel) const;
  // The label of a pixel; after Draw().
  std::uint32_t LabelAt(const std::array<int, 2>& pixel) const;

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
