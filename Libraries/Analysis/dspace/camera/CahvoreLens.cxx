#include <dspace/camera/CahvoreLens.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

#include <dspace/Checks.h>
#include <dspace/camera/MonotoneRange.h>

namespace dspace {
namespace {

constexpr double WidestTangent = M_PI_2 - 1e-3; // angle whose tangent is taken [rad]
constexpr double Straight = 1e-15;              // linearity that counts as 0

Eigen::Vector3d TakeUnit(LensNumbers& numbers, const char* name) {
  const Eigen::Vector3d v = numbers.Three(name);
  if (!(std::abs(v.norm() - 1.0) <= 1e-3)) {
    Reject(numbers.Label(), std::string(name) + " is " + VectorText(v) + ", of length " +
                                NumberText(v.norm()) + "; accepted: a unit vector");
  }
  return v;
}

// Sine and cosine of `angle`, from those of `angle` + `step`.
void TurnBack(double step, double angle, double& sine, double& cosine) {
  constexpr double Short = 0.05; // [rad]: the next terms of the series are below 1e-17
  if (std::abs(step) > Short) {
    sine = std::sin(angle);
    cosine = std::cos(angle);
    return;
  }
  const double q = step * step;
  const double s = step * (1.0 - q / 6.0 * (1.0 - q / 20.0 * (1.0 - q / 42.0)));
  const double c = 1.0 - q / 2.0 * (1.0 - q / 12.0 * (1.0 - q / 30.0 * (1.0 - q / 56.0)));
  const double before = sine;
  sine = before * c - cosine * s;
  cosine = cosine * c + before * s;
}

} // namespace

CahvoreLens::CahvoreLens(Kind kind, LensNumbers& numbers)
    : Kind_(kind), A_(TakeUnit(numbers, "A")), H_(numbers.Three("H")), V_(numbers.Three("V")) {
  const std::string& label = numbers.Label();
  const Eigen::Vector3d h = this->A_.cross(this->H_), v = this->A_.cross(this->V_);
  if (!(h.norm() > 1e-6)) {
    Reject(label, "H is " + VectorText(this->H_) + ", along A; accepted: a vector across A");
  }
  if (!(v.norm() > 1e-6)) {
    Reject(label, "V is " + VectorText(this->V_) + ", along A; accepted: a vector across A");
  }
  if (!(h.cross(v).norm() > 1e-6 * h.norm() * v.norm())) {
    Reject(label, "H " + VectorText(this->H_) + " and V " + VectorText(this->V_) +
                      " lie in one plane with A; accepted: two directions of the image");
  }
  if (kind != Kind::Cahv) {
    this->O_ = TakeUnit(numbers, "O").normalized();
    this->R_ = numbers.Three("R");
    Require(this->O_.dot(this->A_) > 0.5, label, "the cosine between O and A",
            this->O_.dot(this->A_), "above 0.5");
    Require(1.0 + this->R_[0] > 0.0, label, "R's first number", this->R_[0], "above -1");
  }
  if (kind == Kind::Cahvore) {
    this->E_ = numbers.Three("E");
    this->Linearity_ = numbers.One("linearity");
    Require(std::abs(this->Linearity_) <= 1.0, label, "the linearity", this->Linearity_, "-1 to 1");
  }
  if (kind != Kind::Cahv) {
    const double end = std::min(M_PI, WidestTangent / std::max(std::abs(this->Linearity_), 1e-3));
    this->AngleLimit_ = MonotoneRange(end, [this](double angle) {
      double dChi = 1.0, slope = 0.0;
      this->Distorted(this->ChiOf(angle, &dChi), &slope);
      return slope * dChi;
    });
    this->Folds_ = this->AngleLimit_ < end;
    this->ChiLimit_ = this->ChiOf(this->AngleLimit_, nullptr);
  }
  numbers.Finish();
}

const char* CahvoreLens::Type() const {
  return this->Kind_ == Kind::Cahv ? "cahv" : this->Kind_ == Kind::Cahvor ? "cahvor" : "cahvore";
}

double CahvoreLens::Distorted(double chi, double* slope) const {
  const double c2 = chi * chi;
  if (slope) {
    *slope = 1.0 + this->R_[0] + c2 * (3.0 * this->R_[1] + c2 * 5.0 * this->R_[2]);
  }
  return chi * (1.0 + this->R_[0] + c2 * (this->R_[1] + c2 * this->R_[2]));
}

double CahvoreLens::ChiOf(double angle, double* slope) const {
  const double l = this->Linearity_;
  if (l > Straight) {
    const double chi = std::tan(l * angle) / l;
    if (slope) {
      *slope = 1.0 + l * l * chi * chi;
    }
    return chi;
  }
  if (l < -Straight) {
    if (slope) {
      *slope = std::cos(l * angle);
    }
    return std::sin(l * angle) / l;
  }
  if (slope) {
    *slope = 1.0;
  }
  return angle;
}

double CahvoreLens::AngleFrom(double chi) const {
  const double l = this->Linearity_;
  if (l > Straight) {
    return std::atan(l * chi) / l;
  }
  if (l < -Straight) {
    return std::abs(l * chi) < 1.0 ? std::asin(l * chi) / l : M_PI_2 / -l;
  }
  return chi;
}

double CahvoreLens::PupilPolynomial(double angle, double* slope) const {
  const double t = angle * angle;
  if (slope) {
    *slope = angle * (2.0 * this->E_[1] + t * 4.0 * this->E_[2]);
  }
  return this->E_[0] + t * (this->E_[1] + t * this->E_[2]);
}

// The angle from O under which the ray through a point leaves the pupil: the root of
// along sin t - across cos t - (t - sin t) e(t), and the slope there.
bool CahvoreLens::AngleOf(double along, double across, double& angle, double& slope) const {
  angle = std::atan2(across, along);
  const double reach = std::hypot(along, across), small = 1e-15 * reach;
  double s = across / reach, c = along / reach; // of the angle, without a call
  for (int i = 0; i < 50; ++i) {
    double dPupil = 0.0;
    const double pupil = this->PupilPolynomial(angle, &dPupil);
    const double error = along * s - across * c - (angle - s) * pupil;
    slope = along * c + across * s - (1.0 - c) * pupil - (angle - s) * dPupil;
    if (!(slope > 0.0)) {
      return false;
    }
    const double step = error / slope;
    angle -= step;
    // The next step would be the square of this one, times half the curvature over the slope.
    const double curvature = reach + 10.0 * (std::abs(pupil) + std::abs(dPupil));
    if (std::abs(error) <= small || step * step * curvature <= 1e-17 * slope) {
      return angle >= 0.0;
    }
    TurnBack(step, angle, s, c);
  }
  return angle >= 0.0 && std::isfinite(angle);
}

bool CahvoreLens::StraightenCahvor(const Eigen::Vector3d& p, Eigen::Vector3d& q,
                                   Eigen::Matrix3d* derivative) const {
  const double along = p.dot(this->O_);
  if (!(along > 0.0)) {
    return false;
  }
  const Eigen::Vector3d across = p - along * this->O_;
  const double tau = across.squaredNorm() / (along * along);
  if (!(tau < this->ChiLimit_ * this->ChiLimit_)) {
    return false;
  }
  const double mu = this->R_[0] + tau * (this->R_[1] + tau * this->R_[2]);
  q = p + mu * across;
  if (derivative) {
    const Eigen::RowVector3d dTau =
        2.0 / (along * along) * across.transpose() - 2.0 * tau / along * this->O_.transpose();
    const double dMu = this->R_[1] + 2.0 * tau * this->R_[2];
    *derivative = Eigen::Matrix3d::Identity() +
                  mu * (Eigen::Matrix3d::Identity() - this->O_ * this->O_.transpose()) +
                  across * dMu * dTau;
  }
  return true;
}

bool CahvoreLens::StraightenCahvore(const Eigen::Vector3d& p, Eigen::Vector3d& q,
                                    Eigen::Matrix3d* derivative) const {
  const double along = p.dot(this->O_);
  const Eigen::Vector3d across = p - along * this->O_;
  const double lambda = across.norm();
  const Eigen::Matrix3d plane = Eigen::Matrix3d::Identity() - this->O_ * this->O_.transpose();
  if (lambda <= 1e-10 * along) { // on O
    q = p + this->R_[0] * across;
    if (derivative) {
      *derivative = Eigen::Matrix3d::Identity() + this->R_[0] * plane;
    }
    return true;
  }
  double angle = 0.0, slope = 1.0;
  if (!this->AngleOf(along, lambda, angle, slope) || !(angle > 0.0) ||
      !(angle < this->AngleLimit_)) {
    return false;
  }
  double dChi = 1.0;
  const double chi = this->ChiOf(angle, &dChi);
  const double c2 = chi * chi;
  const double mu = this->R_[0] + c2 * (this->R_[1] + c2 * this->R_[2]);
  const double forward = lambda / chi;
  q = forward * this->O_ + (1.0 + mu) * across;
  if (derivative) {
    const Eigen::RowVector3d dLambda = across.transpose() / lambda;
    const Eigen::RowVector3d dAngle =
        (std::cos(angle) * dLambda - std::sin(angle) * this->O_.transpose()) / slope;
    const Eigen::RowVector3d dForward = dLambda / chi - lambda / c2 * dChi * dAngle;
    const double dMu = chi * (2.0 * this->R_[1] + 4.0 * c2 * this->R_[2]) * dChi;
    *derivative = this->O_ * dForward + (1.0 + mu) * plane + across * (dMu * dAngle);
  }
  return true;
}

bool CahvoreLens::Straighten(const Eigen::Vector3d& p, Eigen::Vector3d& q,
                             Eigen::Matrix3d* derivative) const {
  switch (this->Kind_) {
  case Kind::Cahvor:
    return this->StraightenCahvor(p, q, derivative);
  case Kind::Cahvore:
    return this->StraightenCahvore(p, q, derivative);
  case Kind::Cahv:
    break;
  }
  q = p;
  if (derivative) {
    derivative->setIdentity();
  }
  return true;
}

bool CahvoreLens::Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
                          Jacobian* jacobian) const {
  Eigen::Vector3d q;
  Eigen::Matrix3d derivative;
  if (!this->Straighten(p_C, q, jacobian ? &derivative : nullptr)) {
    return false;
  }
  const double depth = q.dot(this->A_);
  if (!(depth > 0.0)) {
    return false;
  }
  pixel = Eigen::Vector2d(q.dot(this->H_), q.dot(this->V_)) / depth;
  if (jacobian) {
    Jacobian onto;
    onto.row(0) = (this->H_ - pixel.x() * this->A_).transpose() / depth;
    onto.row(1) = (this->V_ - pixel.y() * this->A_).transpose() / depth;
    *jacobian = onto * derivative;
  }
  return true;
}

bool CahvoreLens::Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const {
  Eigen::Vector3d q =
      (this->V_ - pixel.y() * this->A_).cross(this->H_ - pixel.x() * this->A_).normalized();
  if (!q.allFinite()) {
    return false;
  }
  q = q.dot(this->A_) < 0.0 ? Eigen::Vector3d(-q) : q;
  ray.origin.setZero();
  if (this->Kind_ == Kind::Cahv) {
    ray.direction = q;
    return true;
  }
  const double forward = q.dot(this->O_);
  const Eigen::Vector3d across = q - forward * this->O_;
  const double lambda = across.norm();
  const double end = this->ChiLimit_;
  const double sought = lambda / forward;
  if (!(forward > 0.0) || !(sought < this->Distorted(end, nullptr))) {
    return false;
  }
  if (lambda < 1e-15) {
    ray.direction = this->O_;
    return true;
  }
  const double chi = SolveMonotone(
      sought, end, [this](double t, double& slope) { return this->Distorted(t, &slope); });
  const Eigen::Vector3d side = across / lambda;
  if (this->Kind_ == Kind::Cahvor) {
    ray.direction = (this->O_ + chi * side).normalized();
    return true;
  }
  const double angle = this->AngleFrom(chi);
  if (!(angle < this->AngleLimit_)) {
    return false;
  }
  // (t / sin t - 1) e(t) along O.
  const double s = std::sin(angle);
  const double shift = angle < 1e-4 ? angle * angle / 6.0 : angle / s - 1.0;
  ray.origin = shift * this->PupilPolynomial(angle, nullptr) * this->O_;
  ray.direction = std::cos(angle) * this->O_ + s * side;
  return true;
}

LensField CahvoreLens::Field() const {
  if (this->Kind_ == Kind::Cahv) {
    return {90.0, "the plane of the lens"};
  }
  const double between = std::acos(std::clamp(this->O_.dot(this->A_.normalized()), -1.0, 1.0));
  const double limit = std::max(this->AngleLimit_ - between, 0.0) * 180.0 / M_PI;
  const char* end = this->Folds_                  ? "a fold"
                    : this->Kind_ == Kind::Cahvor ? "the plane of the lens"
                    : this->AngleLimit_ >= M_PI   ? ""
                                                  : "the end of the model";
  return {limit, end};
}

LensValues CahvoreLens::Values() const {
  const auto list = [](const Eigen::Vector3d& v) { return std::vector<double>{v[0], v[1], v[2]}; };
  LensValues values{{"A", list(this->A_)}, {"H", list(this->H_)}, {"V", list(this->V_)}};
  if (this->Kind_ != Kind::Cahv) {
    values["O"] = list(this->O_);
    values["R"] = list(this->R_);
  }
  if (this->Kind_ == Kind::Cahvore) {
    values["E"] = list(this->E_);
    values["linearity"] = {this->Linearity_};
  }
  return values;
}

LensPtr CahvoreLens::Scaled(double x, double y) const {
  LensValues values = this->Values();
  // ScaledPosition(H·p / A·p): H' = x H + (x - 1) / 2 A.
  const Eigen::Vector3d H = x * this->H_ + 0.5 * (x - 1.0) * this->A_;
  const Eigen::Vector3d V = y * this->V_ + 0.5 * (y - 1.0) * this->A_;
  values["H"] = {H[0], H[1], H[2]};
  values["V"] = {V[0], V[1], V[2]};
  return MakeLens(this->Type(), values, "scaled lens");
}

} // namespace dspace
