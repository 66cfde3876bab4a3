// Draws a StarField with OpenGL.
#ifndef DSPACE_RENDER_STAR_DRAWER_H
#define DSPACE_RENDER_STAR_DRAWER_H

#include <memory>
#include <vector>

#include <dspace/render/CustomDrawer.h>
#include <dspace/scene/stars/StarField.h>

namespace dspace {

class CustomDrawers;

// From now on the context with these drawers draws stars. Any number of calls.
void RegisterStarDrawer(CustomDrawers& drawers);

// Adds the stars' light to the background: of a star of irradiance E, a pixel that sees the solid
// angle O of the sky and gets the share w of the point spread has the radiance E w / O. Stars that
// change no display value are left out. Labels, depths and angles have none, nor have orthographic
// views.
class StarDrawer : public CustomDrawer {
public:
  explicit StarDrawer(std::shared_ptr<const StarField> stars) : Field_(std::move(stars)) {}
  StarDrawer(const StarDrawer&) = delete;
  StarDrawer& operator=(const StarDrawer&) = delete;
  ~StarDrawer() override;

  bool Prepare(const CustomDrawing& drawing) override;
  void DrawColor(const CustomDrawing& drawing) override;
  void DrawLabels(const CustomDrawing&) override {}

private:
  // Stars of one part of the sky, brightest first, so that others are not looked at.
  struct Cell {
    Eigen::Vector3d center; // unit, in the object's axes
    double radius = 0.0;    // [rad]
    int first = 0;
    std::vector<float> magnitudes;
  };

  std::weak_ptr<const StarField> Field_; // the scene has it while it is drawn
  std::vector<Cell> Cells_;
  unsigned int Array_ = 0;
  unsigned int Buffer_ = 0;
};

} // namespace dspace

#endif
