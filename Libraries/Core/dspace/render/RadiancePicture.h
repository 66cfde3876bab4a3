// Linear light towards the camera, and the angles under which it is reflected.
#ifndef DSPACE_RENDER_RADIANCE_PICTURE_H
#define DSPACE_RENDER_RADIANCE_PICTURE_H

#include <memory>
#include <vector>

#include <dspace/render/DrawList.h>
#include <dspace/render/RenderTarget.h>
#include <dspace/render/SceneDrawer.h>

class vtkDspaceRenderContext;

namespace dspace {

// The physical scene in radiance: no ornaments, no fill light, no exposure. The mean over the
// samples of each pixel; what no object covers is black. The value of a surface without light (an
// unlit object, a prop of VTK) counts as linear light.
class RadiancePicture {
public:
  // `view` counts samples. The context must outlive it.
  void Draw(vtkDspaceRenderContext* context, const Scene& scene, const DrawView& view,
            const DrawFilter& filter);
  // [W/m^2/sr], red, green, blue; linear value 1 is SolarConstant / pi. Rows from the top down;
  // after Draw().
  std::vector<float> Radiances() const;

private:
  std::unique_ptr<RenderTarget> Samples_;
  std::unique_ptr<RenderTarget> Pixels_; // mean of the samples; none at one sample a pixel
  std::unique_ptr<SceneDrawer> Drawer_;
  DrawList List_;
};

// Angles at each pixel's centre, of the surface that labels show. NaN where nothing is, and where
// the angle is not known: unlit objects, props of VTK, code of objects that does the lighting
// itself; incidence and phase also without a Sun.
class AnglePicture {
public:
  // `view` has one sample a pixel. The context must outlive it.
  void Draw(vtkDspaceRenderContext* context, const Scene& scene, const DrawView& view,
            const DrawFilter& filter);
  enum class Angle { Incidence, Emission, Phase };
  std::vector<float> Degrees(Angle angle) const; // rows from the top down; after Draw()
  // The part of the Sun's disc, 0 to 1, that lights the surface, by all shadows, whether or not the
  // view shows them; NaN as for incidence. 0 where the surface faces away from the Sun.
  std::vector<float> LitFractions() const;

  // Draws normals in place of the above.
  void DrawNormals(vtkDspaceRenderContext* context, const Scene& scene, const DrawView& view,
                   const DrawFilter& filter);
  // x y z at each pixel, unit, in view coordinates: X right, Y up, Z backwards; NaN as for
  // emission. After DrawNormals().
  std::vector<float> Normals() const;

private:
  std::unique_ptr<RenderTarget> Target_;
  std::unique_ptr<SceneDrawer> Drawer_;
  DrawList List_;
  std::vector<float> Values_;
  bool Sun_ = false;
};

} // namespace dspace

#endif
