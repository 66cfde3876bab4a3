// JPL's lenses CAHV, CAHVOR and CAHVORE.
#ifndef DSPACE_CAMERA_CAHVORE_LENS_H
#define DSPACE_CAMERA_CAHVORE_LENS_H

#include <cmath>

#include <dspace/camera/LensNumbers.h>

namespace dspace {

// Types "cahv", "cahvor" and "cahvore". A is the axis, H and V hold the image's scale and centre, O
// is the axis of the distortion R, and E moves the entrance pupil along O. C is the origin of the
// camera's axes. `linearity` is 1 for type 1 (perspective), 0 for type 2 (fish-eye), else that of
// type 3 (general). A and O must be unit within 1e-3; O is made unit.
// Sources: Y. Yakimovsky and R. Cunningham, 1978; D. Gennery, "Generalized camera calibration
// including fish-eye lenses", IJCV 68(3), 2006.
class CahvoreLens : public LensModel {
public:
  enum class Kind { Cahv, Cahvor, Cahvore };
  // Throws as MakeLens does.
  CahvoreLens(Kind kind, LensNumbers& numbers);

  const char* Type() const override;
  bool Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
               Jacobian* jacobian = nullptr) const override;
  bool Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const override;
  LensField Field() const override;
  bool MovesPupil() const override { return this->E_ != Eigen::Vector3d::Zero(); }
  LensValues Values() const override;
  LensPtr Scaled(double x, double y) const override;

private:
  // The point as an undistorted lens sees it, and its derivative.
  bool Straighten(const Eigen::Vector3d& p_C, Eigen::Vector3d& q,
                  Eigen::Matrix3d* derivative) const;
  bool StraightenCahvor(const Eigen::Vector3d& p_C, Eigen::Vector3d& q, Eigen::Matrix3d* d) const;
  bool StraightenCahvore(const Eigen::Vector3d& p_C, Eigen::Vector3d& q, Eigen::Matrix3d* d) const;
  bool AngleOf(double along, double across, double& angle, double& slope) const;
  double Distorted(double chi, double* slope) const; // chi (1 + r0 + r1 chi² + r2 chi⁴)
  double ChiOf(double angle, double* slope) const;
  double AngleFrom(double chi) const;
  double PupilPolynomial(double angle, double* slope) const;

  Kind Kind_;
  Eigen::Vector3d A_, H_, V_;
  Eigen::Vector3d O_ = Eigen::Vector3d::UnitZ();
  Eigen::Vector3d R_ = Eigen::Vector3d::Zero();
  Eigen::Vector3d E_ = Eigen::Vector3d::Zero();
  double Linearity_ = 1.0;
  double AngleLimit_ = M_PI_2; // from O [rad]
  double ChiLimit_ = HUGE_VAL; // chi there: the tangent for CAHVOR
  bool Folds_ = false;
};

} // namespace dspace

#endif
