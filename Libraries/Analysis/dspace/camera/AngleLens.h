// Fish-eye lenses whose image radius is a polynomial of the angle from the axis.
#ifndef DSPACE_CAMERA_ANGLE_LENS_H
#define DSPACE_CAMERA_ANGLE_LENS_H

#include <array>

#include <dspace/camera/LensNumbers.h>

namespace dspace {

// Types "equidistant" and "kannala_brandt": with the angle t from the axis,
//   u = t (1 + k1 t² + k2 t⁴ + k3 t⁶ + k4 t⁸) (X, Y) / hypot(X, Y), pixel = focal · u + center.
// Sees up to 180 degrees from the axis, or to the first angle where u no longer grows. Source: J.
// Kannala and S. Brandt, "A generic camera model ...", IEEE PAMI 28(8), 2006; OpenCV's fisheye.
class AngleLens : public LensModel {
public:
  // Throws as MakeLens does.
  AngleLens(bool equidistant, LensNumbers& numbers);

  const char* Type() const override { return this->Plain_ ? "equidistant" : "kannala_brandt"; }
  bool Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
               Jacobian* jacobian = nullptr) const override;
  bool Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const override;
  LensField Field() const override;
  LensValues Values() const override;
  LensPtr Scaled(double x, double y) const override;

private:
  double Radius(double angle, double* slope) const;

  bool Plain_;
  Eigen::Vector2d Focal_;
  Eigen::Vector2d Center_;
  std::array<double, 4> K_{};
  double Limit_ = 0.0;  // angle [rad]
  double Widest_ = 0.0; // radius there
};

} // namespace dspace

#endif
