#include <dspace/rays/RayPath.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr double Border = 1e-9; // cells; as wide as that of HeightGrid

} // namespace

// Narrows First..Last to where low <= o + t d <= high.
bool RayPath::Clip(double o, double d, double low, double high) {
  if (d == 0.0) {
    return o >= low && o <= high;
  }
  const double a = (low - o) / d;
  const double b = (high - o) / d;
  this->First_ = std::max(this->First_, std::min(a, b));
  this->Last_ = std::min(this->Last_, std::max(a, b));
  return this->First_ <= this->Last_;
}

RayPath::RayPath(const PostPlacement& placement, const PostLattice& lattice,
                 const Eigen::Vector3d& origin_S, const Eigen::Vector3d& unit_S, double maximum,
                 double low, double high)
    : Placement_(placement), Curved_(placement.OnBody()),
      Flattened_(Curved_ && !placement.Body().Spherical()),
      AtPole_(placement.GetKind() == PostPlacement::Kind::Pole), Last_(maximum), Origin_(origin_S),
      Direction_(unit_S) {
  if (this->AtPole_) {
    if (this->Flattened_) {
      throw Error(Error::Kind::Unsupported, "terrain",
                  "rays on a pole's chart of an ellipsoid are rejected; accepted: of a sphere");
    }
    this->Origin_ = placement.ToChart(origin_S);
    this->Direction_ = placement.ToChart(unit_S);
  }
  // The bounds are of heights as doubles, posts are floats.
  const double pad = 1e-6 * (1.0 + high - low) + 1.2e-7 * std::max(std::abs(low), std::abs(high));
  low -= pad;
  high += pad;
  bool meets = true;
  if (!this->Curved_) {
    const Eigen::Affine2d& toPosts = placement.SceneToPost();
    this->Origin_ << toPosts * Eigen::Vector2d(origin_S.head<2>()),
        origin_S.z() + placement.OriginHeight();
    this->Direction_.head<2>() = toPosts.linear() * Eigen::Vector2d(unit_S.head<2>());
    meets = this->Clip(this->Origin_.x(), this->Direction_.x(), -Border,
                       double(lattice.columns - 1) + Border) &&
            this->Clip(this->Origin_.y(), this->Direction_.y(), -Border,
                       double(lattice.rows - 1) + Border) &&
            this->Clip(this->Origin_.z(), this->Direction_.z(), low, high);
  } else {
    const double nearest = -origin_S.dot(unit_S);
    const double radius = (origin_S + nearest * unit_S).norm();
    const double outer = placement.Radius() + high;
    meets = radius < outer;
    if (meets) {
      const double half = std::sqrt((outer - radius) * (outer + radius));
      meets = this->Clip(0.0, 1.0, nearest - half, nearest + half);
    }
  }
  if (!meets || !std::isfinite(this->Last_)) {
    this->First_ = 1.0;
    this->Last_ = 0.0;
    return;
  }
  // From where it comes in, so that a far origin costs no digits inside.
  this->Entry_ = this->First_;
  this->Origin_ += this->Entry_ * this->Direction_;
  this->Last_ -= this->Entry_;
  this->First_ = 0.0;
  if (!this->Curved_) {
    this->Slack_ =
        1e-12 * (1.0 + std::abs(this->Origin_.z()) + std::abs(this->Direction_.z()) * this->Last_);
    return;
  }
  this->Slack_ = 1e-14 * (placement.Radius() + std::abs(high)) + 1e-9;
  if (this->Flattened_) {
    this->FindNearest();
    return;
  }
  this->Nearest_ = -this->Origin_.dot(this->Direction_);
  const Eigen::Vector3d nearest = this->Origin_ + this->Nearest_ * this->Direction_;
  this->NearestRadius_ = nearest.norm();
  const double z = this->NearestRadius_ > 0.0 ? nearest.z() / this->NearestRadius_ : 0.0;
  this->Amplitude_ = std::hypot(z, this->Direction_.z());
  this->Phase_ = std::atan2(this->Direction_.z(), z);
}

// Where its height above an ellipsoid is least, which is convex along a line: there the vertical is
// square to the ray.
void RayPath::FindNearest() {
  const BodyEllipsoid& body = this->Placement_.Body();
  const Eigen::Vector3d scale(1.0, 1.0, body.Equatorial() / body.Polar());
  const Eigen::Vector3d o = this->Origin_.cwiseProduct(scale);
  const Eigen::Vector3d d = this->Direction_.cwiseProduct(scale);
  this->Nearest_ = -o.dot(d) / d.squaredNorm();
  for (int i = 0; i < 6; ++i) {
    const BodyEllipsoid::Foot foot = this->FootAt(this->Nearest_);
    const double radius = std::max(body.Equatorial() + foot.height, body.Polar());
    this->Nearest_ -= radius * foot.up.dot(this->Direction_);
  }
}

Eigen::Vector2d RayPath::Post(double t, double column) const {
  const Eigen::Vector3d p = this->Origin_ + t * this->Direction_;
  if (!this->Curved_) {
    return p.head<2>();
  }
  if (this->AtPole_) {
    return this->Placement_.PostTowards(p);
  }
  const Eigen::Vector2d& step = this->Placement_.Step();
  const double longitude = std::atan2(p.y(), p.x()) - this->Placement_.First().x();
  const Eigen::Vector3d up = this->Flattened_ ? this->FootAt(t).up : p; // any length
  const double latitude = std::atan2(up.z(), up.head<2>().norm());
  const double c = std::remainder(longitude - column * step.x(), 2.0 * M_PI) / step.x() + column;
  return {c, (latitude - this->Placement_.First().y()) / step.y()};
}

double RayPath::Height(double t) const {
  if (this->Flattened_) {
    return this->FootAt(t).height;
  }
  const Eigen::Vector3d p = this->Origin_ + t * this->Direction_;
  return this->Curved_ ? p.norm() - this->Placement_.Radius() : p.z();
}

bool RayPath::Rises(double t) const {
  return this->Curved_ ? t > this->Nearest_ : this->Direction_.z() > 0.0;
}

std::pair<double, double> RayPath::Heights(double t0, double t1) const {
  const double a = this->Height(t0);
  const double b = this->Height(t1);
  const bool dips = this->Curved_ && t0 < this->Nearest_ && this->Nearest_ < t1;
  const double least = dips ? this->Height(this->Nearest_) : std::min(a, b);
  return {least, std::max(a, b)};
}

void RayPath::ColumnCrossings(double column, std::vector<double>& t) const {
  if (!this->Curved_) {
    if (this->Direction_.x() != 0.0) {
      t.push_back((column - this->Origin_.x()) / this->Direction_.x());
    }
    return;
  }
  if (this->AtPole_) {
    this->CrossingsAtPole(0, column, t);
    return;
  }
  const double longitude = this->Placement_.First().x() + column * this->Placement_.Step().x();
  const Eigen::Vector3d side(-std::sin(longitude), std::cos(longitude), 0.0);
  const double rate = side.dot(this->Direction_);
  if (rate != 0.0) {
    t.push_back(-side.dot(this->Origin_) / rate);
  }
}

void RayPath::RowCrossings(double row, std::vector<double>& t) const {
  if (!this->Curved_) {
    if (this->Direction_.y() != 0.0) {
      t.push_back((row - this->Origin_.y()) / this->Direction_.y());
    }
    return;
  }
  if (this->AtPole_) {
    this->CrossingsAtPole(1, row, t);
    return;
  }
  const double latitude = this->Placement_.First().y() + row * this->Placement_.Step().y();
  if (this->Flattened_) {
    this->RowCrossingsOfEllipsoid(latitude, t);
    return;
  }
  const double sine = std::sin(latitude);
  if (std::abs(sine) > this->Amplitude_ || this->Amplitude_ == 0.0) {
    return;
  }
  const double away = std::acos(sine / this->Amplitude_);
  for (const double a : {this->Phase_ - away, this->Phase_ + away}) {
    const double angle = std::remainder(a, 2.0 * M_PI);
    if (std::abs(angle) < 0.5 * M_PI) { // seen from the centre the ray spans half a turn
      t.push_back(this->Nearest_ + this->NearestRadius_ * std::tan(angle));
    }
  }
}

// On the line at k of the chart's plane, x = k (r + z), r the distance from the centre. From the
// ray's nearest place to the centre, p away, x - k z = N + A t = k r, hence
// (A^2 - k^2) t^2 + 2 N A t + N^2 - k^2 p^2 = 0, whose root is of k^2 (N^2 + p^2 (A^2 - k^2)): no
// difference of large numbers.
void RayPath::CrossingsAtPole(int axis, double line, std::vector<double>& t) const {
  const double k =
      this->Placement_.OnPlaneOfPole(Eigen::Vector2d::Constant(line))[Eigen::Index(axis)];
  const Eigen::Vector3d nearest = this->Origin_ + this->Nearest_ * this->Direction_;
  const double p = this->NearestRadius_;
  const double N = nearest[axis] - k * nearest.z();
  const double A = this->Direction_[axis] - k * this->Direction_.z();
  const double a = (A - k) * (A + k);
  const double square = N * N + p * p * a;
  if (square < 0.0) {
    return;
  }
  const double root = std::abs(k) * std::sqrt(square);
  const double product = (N - k * p) * (N + k * p); // a times both roots
  // -N A + root and -N A - root, over a, without cancellation.
  const double sum = N * A > 0.0 ? -N * A - root : -N * A + root;
  const double far = sum / a;
  const double near = product / sum;
  const bool plusIsFar = !(N * A > 0.0);
  const auto take = [&](bool plus) {
    const double at = plus == plusIsFar ? far : near;
    if (std::isfinite(at)) {
      t.push_back(this->Nearest_ + at);
    }
  };
  // Where r is -r the line is another one.
  if (a > 0.0) {
    take((A > 0.0) == (k >= 0.0));
  } else if (N * k > 0.0) {
    take(true);
    take(false);
  }
}

// Normals of one latitude form a cone whose tip is on the axis.
void RayPath::RowCrossingsOfEllipsoid(double latitude, std::vector<double>& t) const {
  const double sine = std::sin(latitude);
  const double cosine = std::cos(latitude);
  const BodyEllipsoid& body = this->Placement_.Body();
  const double z = this->Origin_.z() + body.Squash() * body.EastRadius(sine) * sine;
  const double s = sine * sine;
  const double c = cosine * cosine;
  const Eigen::Vector2d o = this->Origin_.head<2>();
  const Eigen::Vector2d d = this->Direction_.head<2>();
  // a t^2 + 2 b t + e = 0: distances from the tip along the axis and across.
  const double a = c * this->Direction_.z() * this->Direction_.z() - s * d.squaredNorm();
  const double b = c * z * this->Direction_.z() - s * o.dot(d);
  const double e = c * z * z - s * o.squaredNorm();
  double root = b * b - a * e;
  if (root < -1e-12 * (b * b + std::abs(a * e))) {
    return;
  }
  root = std::sqrt(std::max(root, 0.0));
  const double q = -(b + std::copysign(root, b));
  if (q != 0.0) {
    t.push_back(e / q);
  }
  if (a != 0.0) {
    t.push_back(q / a);
  }
}

} // namespace dspace
