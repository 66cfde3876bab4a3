// W. M. Owen's lens of optical navigation.
#ifndef DSPACE_CAMERA_OWEN_LENS_H
#define DSPACE_CAMERA_OWEN_LENS_H

#include <dspace/camera/LensNumbers.h>
#include <dspace/camera/PlaneLens.h>

namespace dspace {

// The numbers "matrix" of a lens with a focal plane, by rows [pixels per millimetre]. Throws
// Error(InvalidArgument) for a singular one.
Eigen::Matrix2d TakeFocalMatrix(LensNumbers& numbers);

// Type "owen". In the focal plane, (x, y) = f (X / Z, Y / Z) [mm], r² = x² + y²:
//   (x, y)' = (x, y) + (a r² + b r⁴ + c y + d x) (x, y) + (e r + g r³) (-y, x)
//   pixel = [kx kxy; kyx ky] (x, y)' + center
// with radial (a, b), tangential (c, d) and pinwheel (e, g). Source: W. M. Owen, "Methods of
// optical navigation", AAS 11-215, 2011.
class OwenLens : public PlaneLens {
public:
  // Throws as MakeLens does.
  explicit OwenLens(LensNumbers& numbers);

  const char* Type() const override { return "owen"; }
  LensValues Values() const override;
  LensPtr Scaled(double x, double y) const override;

protected:
  bool Distort(const Eigen::Vector2d& n, Eigen::Vector2d& d,
               Eigen::Matrix2d* derivative) const override;

private:
  double Focal_; // [mm]
  std::vector<double> Radial_;
  std::vector<double> Tangential_;
  std::vector<double> Pinwheel_;
};

} // namespace dspace

#endif
