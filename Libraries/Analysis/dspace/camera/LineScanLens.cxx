#include <dspace/camera/LineScanLens.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr std::size_t MostPoses = 1024;
constexpr std::size_t Order = 8; // of the polynomials: points

LensPtr RowOf(LensNumbers& numbers) {
  LensValues values = {{"focal_length", numbers.Exactly("focal_length", 1)},
                       {"matrix", numbers.Exactly("matrix", 4)},
                       {"center", numbers.Exactly("center", 2)}};
  values["radial"] = numbers.UpTo("radial", 1, 3);
  return MakeLens("usgs", values, numbers.Label());
}

} // namespace

LineScanLens::LineScanLens(LensNumbers& numbers)
    : Row_(RowOf(numbers)), RowLine_(numbers.One("row")),
      Lines_(numbers.Rows("line", 1, 2, MostPoses)),
      Positions_(numbers.Exactly("positions", 3 * this->Lines_.size())),
      Rotations_(numbers.Exactly("rotations", 4 * this->Lines_.size())) {
  numbers.Finish();
  for (std::size_t i = 0; i < this->Lines_.size(); ++i) {
    if (i > 0 && !(this->Lines_[i] > this->Lines_[i - 1])) {
      Reject(numbers.Label(), "'line' does not ascend at " + NumberText(this->Lines_[i]) +
                                  "; accepted: lines that ascend");
    }
    Eigen::Map<Eigen::Vector4d> q(&this->Rotations_[4 * i]);
    Require(std::abs(q.norm() - 1.0) <= 1e-6, numbers.Label(), "the length of a rotation", q.norm(),
            "1 within 1e-6");
    q.normalize();
    if (i > 0 && q.dot(Eigen::Map<Eigen::Vector4d>(&this->Rotations_[4 * i - 4])) < 0.0) {
      q = -q;
    }
  }
}

LineScanLens::Place LineScanLens::At(double line) const {
  const std::size_t count = this->Lines_.size();
  const std::size_t points = std::min(count, Order);
  const std::size_t after = std::size_t(
      std::upper_bound(this->Lines_.begin(), this->Lines_.end(), line) - this->Lines_.begin());
  const std::size_t first = std::min(after > points / 2 ? after - points / 2 : 0, count - points);
  Eigen::Vector4d q = Eigen::Vector4d::Zero(), dq = Eigen::Vector4d::Zero();
  Place place;
  for (std::size_t a = first; a < first + points; ++a) {
    double weight = 1.0, slope = 0.0; // of Lagrange's polynomial of this point
    for (std::size_t b = first; b < first + points; ++b) {
      if (b != a) {
        const double span = this->Lines_[a] - this->Lines_[b];
        const double factor = (line - this->Lines_[b]) / span;
        slope = slope * factor + weight / span;
        weight *= factor;
      }
    }
    const Eigen::Vector3d p(&this->Positions_[3 * a]);
    const Eigen::Vector4d r(&this->Rotations_[4 * a]);
    place.p_CS += weight * p;
    place.velocity += slope * p;
    q += weight * r;
    dq += slope * r;
  }
  const double norm = q.norm();
  q /= norm;
  dq = (dq - q * q.dot(dq)) / norm;
  place.q_CS = Eigen::Quaterniond(q[0], q[1], q[2], q[3]);
  const Eigen::Quaterniond change(dq[0], dq[1], dq[2], dq[3]);
  place.turn_S = 2.0 * (place.q_CS.conjugate() * change).vec();
  return place;
}

double LineScanLens::Beyond(const Eigen::Vector3d& p_C, double line) const {
  const Place place = this->At(line);
  Eigen::Vector2d pixel;
  return this->Row_->Project(place.q_CS.conjugate() * (p_C - place.p_CS), pixel)
             ? pixel.y() - this->RowLine_
             : std::numeric_limits<double>::quiet_NaN();
}

bool LineScanLens::Project(const Eigen::Vector3d& p_C, Eigen::Vector2d& pixel,
                           Jacobian* jacobian) const {
  if (!p_C.allFinite()) {
    return false;
  }
  // The first change of sign, between the poses and four times in between.
  constexpr int Parts = 4;
  double low = this->Lines_.front();
  double atLow = this->Beyond(p_C, low);
  double high = low, atHigh = atLow;
  bool found = atLow == 0.0;
  for (std::size_t i = 0; i + 1 < this->Lines_.size() && !found; ++i) {
    for (int k = 1; k <= Parts && !found; ++k) {
      const double share = double(k) / Parts;
      high = k == Parts ? this->Lines_[i + 1]
                        : (1.0 - share) * this->Lines_[i] + share * this->Lines_[i + 1];
      atHigh = this->Beyond(p_C, high);
      found = atLow * atHigh <= 0.0; // false for NaN
      if (!found) {
        low = high;
        atLow = atHigh;
      }
    }
  }
  if (!found) {
    return false;
  }
  double line = atLow == 0.0 ? low : high;
  for (int i = 0, side = 0; i < 100 && atLow != 0.0 && atHigh != 0.0; ++i) { // Illinois
    line = (atLow * high - atHigh * low) / (atLow - atHigh);
    const double here = this->Beyond(p_C, line);
    if (std::isnan(here)) {
      return false;
    }
    const bool isLow = here * atHigh <= 0.0;
    const double before = isLow ? low : high;
    if (isLow) {
      low = line;
      atLow = here;
      atHigh *= side == 1 ? 0.5 : 1.0;
    } else {
      high = line;
      atHigh = here;
      atLow *= side == -1 ? 0.5 : 1.0;
    }
    side = isLow ? 1 : -1;
    if (std::abs(line - before) <= 1e-14 * (1.0 + std::abs(line))) {
      break;
    }
  }
  const Place place = this->At(line);
  const Eigen::Vector3d p_S = place.q_CS.conjugate() * (p_C - place.p_CS);
  Jacobian inRow;
  if (!this->Row_->Project(p_S, pixel, &inRow)) {
    return false;
  }
  if (jacobian) {
    const Jacobian byPoint = inRow * place.q_CS.conjugate().toRotationMatrix();
    const Eigen::Vector2d byLine =
        inRow * (-place.turn_S.cross(p_S) - place.q_CS.conjugate() * place.velocity);
    // The line stays where the point is in the row.
    const Eigen::RowVector3d lineByPoint = -byPoint.row(1) / byLine.y();
    jacobian->row(0) = byPoint.row(0) + byLine.x() * lineByPoint;
    jacobian->row(1) = lineByPoint;
  }
  pixel.y() = line;
  return true;
}

bool LineScanLens::Unproject(const Eigen::Vector2d& pixel, LensRay& ray) const {
  if (!(pixel.y() >= this->Lines_.front() && pixel.y() <= this->Lines_.back()) ||
      !this->Row_->Unproject({pixel.x(), this->RowLine_}, ray)) {
    return false;
  }
  const Place place = this->At(pixel.y());
  ray.origin = place.p_CS;
  ray.direction = place.q_CS * ray.direction;
  return true;
}

LensValues LineScanLens::Values() const {
  LensValues values = this->Row_->Values();
  values["row"] = {this->RowLine_};
  values["line"] = this->Lines_;
  values["positions"] = this->Positions_;
  values["rotations"] = this->Rotations_;
  return values;
}

LensPtr LineScanLens::Scaled(double x, double y) const {
  LensValues values = this->Values();
  for (std::size_t k = 0; k < 2; ++k) { // across the row alone: lines are time
    values["matrix"][k] *= x;
  }
  values["center"][0] = ScaledPosition(values["center"][0], x);
  for (double& line : values["line"]) {
    line = ScaledPosition(line, y);
  }
  return MakeLens(this->Type(), values, "scaled lens");
}

} // namespace dspace
