// Lenses that project from a sphere: unified, extended unified, double sphere.
#ifndef DSPACE_CAMERA_SPHERE_LENS_H
#define DSPACE_CAMERA_SPHERE_LENS_H

#include <dspace/camera/LensNumbers.h>

namespace dspace {

// Types "ucm", "eucm" and "double_sphere": pixel = focal · (X, Y) / w + center with
//   ucm, eucm:     w = alpha d + (1 - alpha) Z,  d² = beta (X² + Y²) + Z²  (ucm: beta = 1)
//   double_sphere: w = alpha d + (1 - alpha) k,  d² = X² + Y² + k²,  k = xi |p| + Z
// Sees what maps one to one: Z > -q d (eucm), Z > -q |p| (double_sphere). Source: V. Usenko, N.
// Demmel, D. Cremers, "The double sphere camera model", 3DV 2018 (arXiv:1807.08957). A mirror of
// Mei's xi is alpha = xi / (1 + xi), focal = gamma / (1 + xi).
class SphereLens : public LensModel {
public:
  enum class Kind { Unified, Extended, Double };
  // Throws as MakeLens does: alpha 0 to 1, beta 1e-3 to 1e3, xi -1 to 1.
  SphereLens(Kind kind, LensNumbers& numbers);

  const char* Type() const override;
  bool Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
               Jacobian* jacobian = nullptr) const override;
  bool Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const override;
  LensField Field() const override;
  LensValues Values() const override;
  LensPtr Scaled(double x, double y) const override;

private:
  Kind Kind_;
  Eigen::Vector2d Focal_;
  Eigen::Vector2d Center_;
  double Alpha_ = 0.0;
  double Beta_ = 1.0;
  double Xi_ = 0.0;
  double Least_ = 0.0; // q above
};

} // namespace dspace

#endif
