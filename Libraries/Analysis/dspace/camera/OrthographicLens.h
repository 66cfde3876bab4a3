// A lens that sees along parallel rays.
#ifndef DSPACE_CAMERA_ORTHOGRAPHIC_LENS_H
#define DSPACE_CAMERA_ORTHOGRAPHIC_LENS_H

#include <dspace/camera/LensNumbers.h>

namespace dspace {

// Type "orthographic": pixel = scale · (X, Y) + center, of points ahead of Z = 0, where the rays
// begin.
class OrthographicLens : public LensModel {
public:
  // Throws as MakeLens does.
  explicit OrthographicLens(LensNumbers& numbers);

  const char* Type() const override { return "orthographic"; }
  bool Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
               Jacobian* jacobian = nullptr) const override;
  bool Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const override;
  LensField Field() const override { return {0.0, "parallel rays"}; }
  bool MovesPupil() const override { return true; }
  LensValues Values() const override;
  LensPtr Scaled(double x, double y) const override;

private:
  Eigen::Vector2d Scale_; // [pixels per metre]
  Eigen::Vector2d Center_;
};

} // namespace dspace

#endif
