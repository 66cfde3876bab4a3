// The frame camera of the USGS Community Sensor Model.
#ifndef DSPACE_CAMERA_USGS_LENS_H
#define DSPACE_CAMERA_USGS_LENS_H

#include <dspace/camera/LensNumbers.h>
#include <dspace/camera/PlaneLens.h>

namespace dspace {

// Type "usgs". A place (x, y) in the focal plane [mm], r² = x² + y², sees the direction
//   (x, y) (1 - k0 - k1 r² - k2 r⁴), f
// and pixel = [kx kxy; kyx ky] (x, y) + center. Source: usgscsm (USGS), Distortion.cpp, type
// RADIAL, whose polynomial removes the distortion.
class UsgsLens : public PlaneLens {
public:
  // Throws as MakeLens does.
  explicit UsgsLens(LensNumbers& numbers);

  const char* Type() const override { return "usgs"; }
  LensValues Values() const override;
  LensPtr Scaled(double x, double y) const override;

protected:
  bool Distort(const Eigen::Vector2d& n, Eigen::Vector2d& d,
               Eigen::Matrix2d* derivative) const override;

private:
  double Focal_; // [mm]
  std::vector<double> Radial_;
  double Farthest_ = 0.0; // where r (1 - k0 - k1 r² - k2 r⁴) grows up to [mm]
};

} // namespace dspace

#endif
