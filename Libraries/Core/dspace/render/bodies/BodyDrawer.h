// Draws a CelestialBody with OpenGL.
#ifndef DSPACE_RENDER_BODY_DRAWER_H
#define DSPACE_RENDER_BODY_DRAWER_H

#include <memory>

#include <dspace/render/CustomDrawer.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/render/bodies/BodyView.h>
#include <dspace/scene/bodies/CelestialBody.h>

class vtkShaderProgram;

namespace dspace {

class CustomDrawers;

// From now on the context with these drawers draws bodies. Any number of calls.
void RegisterBodyDrawer(CustomDrawers& drawers);

// Crosses each pixel's ray with the ellipsoid. A disc of less than CelestialBody::SmallRadius is
// drawn after what is opaque and the stars: each pixel gets the mean of the light in it. Shadow
// maps have no bodies: what they hide of the Sun is SurfaceShaders::Eclipses.
class BodyDrawer : public CustomDrawer {
public:
  explicit BodyDrawer(std::shared_ptr<const CelestialBody> body) : Body_(std::move(body)) {}
  BodyDrawer(const BodyDrawer&) = delete;
  BodyDrawer& operator=(const BodyDrawer&) = delete;
  ~BodyDrawer() override;

  bool Prepare(const CustomDrawing&) override { return true; }
  double NearestDepth(const CustomDrawing& drawing) override;
  void DrawColor(const CustomDrawing& drawing) override;
  void DrawLabels(const CustomDrawing& drawing) override;
  bool DrawAngles(const CustomDrawing& drawing) override;
  void DrawTranslucent(const CustomDrawing& drawing, const RenderTarget& target) override;

private:
  static bool IsSmall(const BodyView& body, const CustomDrawing& drawing);
  // Ready to draw, with what all programs of bodies share.
  vtkShaderProgram* Ready(const CustomDrawing& drawing, const BodyView& body,
                          SurfaceShaders::Features features, const std::string& defines,
                          const char* fragment);
  void DrawSurface(const CustomDrawing& drawing, const BodyView& body, bool small);
  // Draws over the part of the picture in which an ellipsoid of these radii is.
  static void SetBoxWithin(const CustomDrawing& drawing, vtkShaderProgram* program,
                           const Eigen::Vector3d& radii);
  void DrawRings(const CustomDrawing& drawing, const BodyView& view);
  void DrawAir(const CustomDrawing& drawing, const BodyView& view);
  void DrawBox();

  std::weak_ptr<const CelestialBody> Body_; // the scene has it while it is drawn
  unsigned int Array_ = 0;
  unsigned int Air_ = 0; // texture of an AirTable
};

} // namespace dspace

#endif
