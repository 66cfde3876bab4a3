// Brown and Conrady's lens in OpenCV's form: rational radial, tangential, thin prism, tilt.
#ifndef DSPACE_CAMERA_BROWN_LENS_H
#define DSPACE_CAMERA_BROWN_LENS_H

#include <array>

#include <dspace/camera/LensNumbers.h>
#include <dspace/camera/PlaneLens.h>

namespace dspace {

// Types "pinhole" (no distortion) and "brown". With x = X / Z, y = Y / Z, r² = x² + y²:
//   g = (1 + k1 r² + k2 r⁴ + k3 r⁶) / (1 + k4 r² + k5 r⁴ + k6 r⁶)
//   x' = g x + 2 p1 x y + p2 (r² + 2 x²) + s1 r² + s2 r⁴
//   y' = g y + p1 (r² + 2 y²) + 2 p2 x y + s3 r² + s4 r⁴
// then the plane of a sensor tilted by (tau x, tau y), and pixel = (fx x', fy y') + center.
// Source: D. C. Brown, "Decentering distortion of lenses", 1966; OpenCV 4, module calib3d.
class BrownLens : public PlaneLens {
public:
  // Throws as MakeLens does.
  BrownLens(bool pinhole, LensNumbers& numbers);

  const char* Type() const override { return this->Pinhole_ ? "pinhole" : "brown"; }
  LensValues Values() const override;
  LensPtr Scaled(double x, double y) const override;

protected:
  bool Distort(const Eigen::Vector2d& n, Eigen::Vector2d& d,
               Eigen::Matrix2d* derivative) const override;

private:
  bool Pinhole_;
  std::array<double, 6> K_{};
  std::array<double, 2> P_{};
  std::array<double, 4> S_{};
  Eigen::Vector2d Tilt_deg_ = Eigen::Vector2d::Zero();
  bool Tilted_ = false;
  Eigen::Matrix3d TiltMatrix_ = Eigen::Matrix3d::Identity();
};

} // namespace dspace

#endif
