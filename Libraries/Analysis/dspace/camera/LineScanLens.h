// A push-broom camera: one row of pixels that moves.
#ifndef DSPACE_CAMERA_LINE_SCAN_LENS_H
#define DSPACE_CAMERA_LINE_SCAN_LENS_H

#include <memory>

#include <Eigen/Geometry>

#include <dspace/camera/LensNumbers.h>

namespace dspace {

// Type "line_scan". Each line of the image is taken at a pose of its own: the pixel (x, y) sees
// what a lens of type "usgs" with the same numbers sees at the pixel (x, row), turned and moved by
// the pose of line y. Poses are given for lines that ascend: positions [m] and rotations (w, x, y,
// z) in the camera's axes C. In between, both are Lagrange polynomials through up to eight of them
// around the line (quaternions normalized). Lines before the first and after the last have no ray.
//
// A point is seen in the first line in whose plane of sight it lies.
class LineScanLens : public LensModel {
public:
  // Throws as MakeLens does.
  explicit LineScanLens(LensNumbers& numbers);

  const char* Type() const override { return "line_scan"; }
  bool Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
               Jacobian* jacobian = nullptr) const override;
  bool Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const override;
  LensField Field() const override { return {0.0, "a row that moves"}; }
  bool MovesPupil() const override { return true; }
  LensValues Values() const override;
  LensPtr Scaled(double x, double y) const override;

private:
  // Of the row at a line, with the changes by the line.
  struct Place {
    Eigen::Quaterniond q_CS = Eigen::Quaterniond::Identity();
    Eigen::Vector3d p_CS = Eigen::Vector3d::Zero();
    Eigen::Vector3d turn_S = Eigen::Vector3d::Zero();   // [rad / line]
    Eigen::Vector3d velocity = Eigen::Vector3d::Zero(); // [m / line]
  };
  Place At(double line) const;
  // How far beyond the row the point is at a line [pixels]; NaN: not seen.
  double Beyond(const Eigen::Vector3d& p_C, double line) const;

  LensPtr Row_; // the lens of type "usgs"
  double RowLine_;
  std::vector<double> Lines_;
  std::vector<double> Positions_;
  std::vector<double> Rotations_; // of one sign
};

} // namespace dspace

#endif
