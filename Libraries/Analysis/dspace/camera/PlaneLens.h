// Lenses that distort the plane Z = 1, such as Brown and Conrady's.
#ifndef DSPACE_CAMERA_PLANE_LENS_H
#define DSPACE_CAMERA_PLANE_LENS_H

#include <cmath>
#include <vector>

#include <dspace/camera/LensModel.h>

namespace dspace {

// A lens with one entrance pupil that sees less than a hemisphere: pixel = M d(X / Z, Y / Z) + c.
// The distortion d is one to one out to the first place, on the way from the axis, where the
// determinant of its derivative is not positive. That fold is found for 64 azimuths once;
// in between the nearer of two counts.
class PlaneLens : public LensModel {
public:
  bool Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
               Jacobian* jacobian = nullptr) const override;
  bool Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const override;
  LensField Field() const override;

protected:
  PlaneLens(const Eigen::Matrix2d& matrix, const Eigen::Vector2d& center);
  // Of a point of the plane; `derivative` may be null. False where it is not defined.
  virtual bool Distort(const Eigen::Vector2d& n, Eigen::Vector2d& d,
                       Eigen::Matrix2d* derivative) const = 0;
  // Once, at the end of a constructor. `round`: the distortion does not depend on the azimuth.
  // Throws Error(InvalidArgument) naming `label` where the lens folds at its axis.
  void FindFold(bool round, const std::string& label);

  const Eigen::Matrix2d& Matrix() const { return this->Matrix_; }
  const Eigen::Vector2d& Center() const { return this->Center_; }

private:
  double FoldAlong(double azimuth) const;     // radius in the plane
  bool Holds(const Eigen::Vector2d& n) const; // within the fold
  bool Undistort(const Eigen::Vector2d& d, Eigen::Vector2d& n) const;
  bool Refine(const Eigen::Vector2d& d, Eigen::Vector2d& n) const; // from n on

  Eigen::Matrix2d Matrix_;
  Eigen::Matrix2d Inverse_;
  Eigen::Vector2d Center_;
  std::vector<double> Fold_; // radius by azimuth; one: for all
  double Nearest_ = 0.0;     // of Fold_
  double Farthest_ = 0.0;
  double Edge_ = HUGE_VAL; // of a round lens: the radius of d at the fold
  bool Folds_ = false;
};

} // namespace dspace

#endif
