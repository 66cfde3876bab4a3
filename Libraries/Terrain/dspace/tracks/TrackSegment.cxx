#include <dspace/tracks/TrackSegment.h>

#include <algorithm>
#include <cmath>
#include <tuple>

namespace dspace {

bool TrackProfile::operator==(const TrackProfile& o) const {
  const auto all = [](const TrackProfile& p) {
    return std::tie(p.width, p.wall, p.rimWidth, p.rimHeight, p.treadPitch, p.treadDepth);
  };
  return all(*this) == all(o);
}

TrackSegment::TrackSegment(const TrackProfile& profile, const TrackContact& from,
                           const TrackContact& to, double stretch)
    : Profile_(profile), From_(from), To_(to), Along_(to.place - from.place),
      Squared_(Along_.squaredNorm()), Stretch_(stretch) {
  const Eigen::Vector2d path =
      this->Squared_ > 0.0 ? Eigen::Vector2d(this->Along_.normalized()) : Eigen::Vector2d(1.0, 0.0);
  const auto axis = [&path](double heading) {
    return std::isnan(heading) ? path : Eigen::Vector2d(std::cos(heading), std::sin(heading));
  };
  this->FromHeading_ = axis(from.heading);
  this->ToHeading_ = axis(to.heading);
}

Eigen::AlignedBox2d TrackSegment::Box() const {
  Eigen::AlignedBox2d box(this->From_.place);
  box.extend(this->To_.place);
  const Eigen::Vector2d reach = Eigen::Vector2d::Constant(this->Profile_.Reach() * this->Stretch_);
  return {box.min() - reach, box.max() + reach};
}

bool TrackSegment::At(const Eigen::Vector2d& place, TrackDepth& depth, double scale) const {
  const Eigen::Vector2d offset = place - this->From_.place;
  const double t =
      this->Squared_ > 0.0 ? std::clamp(offset.dot(this->Along_) / this->Squared_, 0.0, 1.0) : 0.0;
  const Eigen::Vector2d away = (offset - t * this->Along_) / scale;
  const TrackProfile& p = this->Profile_;
  const double aside = away.norm() - 0.5 * p.width; // of the floor's edge
  if (aside > p.wall + p.rimWidth) {
    return false;
  }
  if (aside > p.wall) {
    const double u = (aside - p.wall) / p.rimWidth;
    depth = {float(-p.rimHeight * 4.0 * u * (1.0 - u)), 0.0f, float(aside - p.wall)};
    return true;
  }
  const auto between = [t](double from, double to) { return from + t * (to - from); };
  double floor = between(this->From_.sinkage, this->To_.sinkage);
  if (p.treadPitch > 0.0) {
    Eigen::Vector2d heading = this->FromHeading_ + t * (this->ToHeading_ - this->FromHeading_);
    heading.normalize();
    const double rolled = between(this->From_.rolled, this->To_.rolled) + away.dot(heading);
    floor += p.treadDepth * 0.5 * (1.0 - std::cos(2.0 * M_PI * rolled / p.treadPitch));
  }
  const double share = aside > 0.0 ? 1.0 - aside / p.wall : 1.0;
  depth = {float(floor * share), float(share), 0.0f};
  return true;
}

} // namespace dspace
