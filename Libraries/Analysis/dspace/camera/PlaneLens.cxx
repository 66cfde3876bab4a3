#include <dspace/camera/PlaneLens.h>

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr int Azimuths = 64;
constexpr double Step = 0.25 * M_PI / 180.0;   // of the search for the fold
constexpr double Widest = 89.9 * M_PI / 180.0; // from the axis
constexpr int Iterations = 60;

} // namespace

PlaneLens::PlaneLens(const Eigen::Matrix2d& matrix, const Eigen::Vector2d& center)
    : Matrix_(matrix), Inverse_(matrix.inverse()), Center_(center) {}

double PlaneLens::FoldAlong(double azimuth) const {
  const Eigen::Vector2d direction(std::cos(azimuth), std::sin(azimuth));
  const auto good = [&](double angle) {
    Eigen::Vector2d d;
    Eigen::Matrix2d derivative;
    return this->Distort(std::tan(angle) * direction, d, &derivative) &&
           derivative.determinant() > 0.0;
  };
  double inside = 0.0;
  if (!good(inside)) {
    return 0.0;
  }
  while (inside < Widest) {
    const double next = std::min(inside + Step, Widest);
    if (!good(next)) {
      double outside = next;
      for (int i = 0; i < 50; ++i) {
        const double middle = 0.5 * (inside + outside);
        (good(middle) ? inside : outside) = middle;
      }
      return std::tan(inside);
    }
    inside = next;
  }
  return std::tan(Widest);
}

void PlaneLens::FindFold(bool round, const std::string& label) {
  const int count = round ? 1 : Azimuths;
  for (int i = 0; i < count; ++i) {
    this->Fold_.push_back(this->FoldAlong(2.0 * M_PI * i / count));
  }
  const auto [nearest, farthest] = std::minmax_element(this->Fold_.begin(), this->Fold_.end());
  this->Nearest_ = *nearest;
  this->Farthest_ = *farthest;
  this->Folds_ = this->Nearest_ < std::tan(Widest) * (1.0 - 1e-9);
  if (this->Nearest_ < 1e-6) {
    Reject(label, "its distortion folds the image at the axis; accepted: coefficients that keep it "
                  "one to one there");
  }
  // The radius of d grows up to the fold of a round lens: a pixel beyond needs no search.
  Eigen::Vector2d edge;
  if (round && this->Distort(Eigen::Vector2d(this->Nearest_, 0.0), edge, nullptr)) {
    this->Edge_ = edge.norm();
  }
}

LensField PlaneLens::Field() const {
  return {std::atan(this->Nearest_) * 180.0 / M_PI,
          this->Folds_ ? "a fold" : "the plane of the lens"};
}

bool PlaneLens::Holds(const Eigen::Vector2d& n) const {
  const double square = n.squaredNorm();
  if (square < this->Nearest_ * this->Nearest_) {
    return true;
  }
  if (!(square < this->Farthest_ * this->Farthest_)) {
    return false;
  }
  double sector = std::atan2(n.y(), n.x()) / (2.0 * M_PI) * Azimuths;
  sector = sector < 0.0 ? sector + Azimuths : sector;
  const std::size_t at = std::size_t(sector) % this->Fold_.size();
  const double fold = std::min(this->Fold_[at], this->Fold_[(at + 1) % this->Fold_.size()]);
  return square < fold * fold;
}

bool PlaneLens::Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
                        Jacobian* jacobian) const {
  if (!(p_C.z() > 0.0)) {
    return false;
  }
  const Eigen::Vector2d n = p_C.head<2>() / p_C.z();
  Eigen::Vector2d d;
  if (!jacobian) {
    if (!this->Holds(n) || !this->Distort(n, d, nullptr)) {
      return false;
    }
  } else {
    Eigen::Matrix2d derivative;
    if (!this->Holds(n) || !this->Distort(n, d, &derivative)) {
      return false;
    }
    const Eigen::Matrix2d scaled = this->Matrix_ * derivative / p_C.z();
    jacobian->leftCols<2>() = scaled;
    jacobian->col(2) = -scaled * n;
  }
  pixel = this->Matrix_ * d + this->Center_;
  return true;
}

bool PlaneLens::Refine(const Eigen::Vector2d& sought, Eigen::Vector2d& n) const {
  const double small = 1e-15 * (1.0 + sought.norm());
  double error = HUGE_VAL;
  Eigen::Vector2d d;
  Eigen::Matrix2d derivative;
  if (!this->Holds(n) || !this->Distort(n, d, &derivative)) {
    return false;
  }
  error = (d - sought).norm();
  for (int i = 0; i < Iterations && error > small; ++i) {
    const Eigen::Vector2d step = derivative.inverse() * (sought - d);
    if (!step.allFinite()) {
      return false;
    }
    double part = 1.0;
    bool better = false;
    for (; part > 1e-6; part *= 0.5) { // stay within the fold, and come nearer
      const Eigen::Vector2d next = n + part * step;
      Eigen::Vector2d there;
      Eigen::Matrix2d slope;
      if (this->Holds(next) && this->Distort(next, there, &slope) &&
          (there - sought).norm() < error) {
        n = next;
        d = there;
        derivative = slope;
        error = (d - sought).norm();
        better = true;
        break;
      }
    }
    if (!better) {
      break;
    }
  }
  return error <= 1e-11 * (1.0 + sought.norm());
}

bool PlaneLens::Undistort(const Eigen::Vector2d& sought, Eigen::Vector2d& n) const {
  const double length = sought.norm();
  if (!(length < this->Edge_)) {
    return false;
  }
  n = sought;
  if (this->Refine(sought, n)) {
    return true;
  }
  if (length == 0.0) {
    n.setZero();
    return this->Refine(sought, n);
  }
  for (const double part : {0.999, 0.95, 0.8, 0.6, 0.4, 0.2}) {
    n = sought / length * part * this->Nearest_;
    if (this->Refine(sought, n)) {
      return true;
    }
  }
  return false;
}

bool PlaneLens::Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const {
  Eigen::Vector2d n;
  if (!pixel.allFinite() || !this->Undistort(this->Inverse_ * (pixel - this->Center_), n)) {
    return false;
  }
  ray.origin.setZero();
  ray.direction = Eigen::Vector3d(n.x(), n.y(), 1.0).normalized();
  return true;
}

} // namespace dspace
