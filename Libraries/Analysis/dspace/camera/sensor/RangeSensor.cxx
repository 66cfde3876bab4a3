#include <dspace/camera/sensor/RangeSensor.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/Checks.h>
#include <dspace/camera/sensor/Draws.h>

namespace dspace {
namespace {

using V = Eigen::Vector3d;
using Place = Eigen::Vector2d; // in the cone: the angle from the axis [rad], in two directions
constexpr double Infinity = std::numeric_limits<double>::infinity();
constexpr std::uint32_t RangeChannel =
    128; // of random numbers; a camera's sensor has those from 0 on
constexpr int MostRangeRays = 10000;
const std::string RangeLabel = "range sensor";

// The directions of one beam's cone.
class Cone {
public:
  Cone(V axis, double half) : Axis_(std::move(axis)), Half_(half) {
    this->Right_ = this->Axis_.unitOrthogonal();
    this->Up_ = this->Axis_.cross(this->Right_);
  }

  V At(const Place& place) const {
    const double angle = place.norm();
    if (angle == 0.0) {
      return this->Axis_;
    }
    const V across = (place.x() * this->Right_ + place.y() * this->Up_) / angle;
    return std::cos(angle) * this->Axis_ + std::sin(angle) * across;
  }
  Place Within(const Place& place) const {
    const double angle = place.norm();
    return angle > this->Half_ ? Place(place * (this->Half_ / angle)) : place;
  }
  // The first is the axis. The others lie on a spiral of golden angles (Vogel 1979), each with the
  // same solid angle.
  Place Ray(int index, int count) const {
    if (index == 0) {
      return Place::Zero();
    }
    constexpr double Golden = M_PI * (3.0 - 2.2360679774997896964);
    const double share = (index + 0.5) / count;
    const double turn = Golden * index;
    // 1 - cos a = share (1 - cos half), by half angles: exact for narrow cones.
    const double angle = 2.0 * std::asin(std::sqrt(share) * std::sin(0.5 * this->Half_));
    return angle * Place(std::cos(turn), std::sin(turn));
  }

private:
  V Axis_;
  V Right_;
  V Up_;
  double Half_;
};

struct Ray {
  Place place = Place::Zero();
  double range = Infinity;
  double incidence = 0.0;
  double light = 0.0; // albedo cos / range²
  RangeMeeting meeting;
};

// Searches for a range that is less than `best` around it, down to `step` where a surface can be
// only a tenth of a millimetre nearer, or rays differ by rounding.
template<typename Find> void Refine(const Cone& cone, double step, const Find& find, Ray& best) {
  constexpr double Nearer = 1e-4, Rounding = 1e-12;
  while (step > Rounding && step * best.range > 0.1 * Nearer) {
    std::optional<Ray> nearer;
    for (int k = 0; k < 8; ++k) {
      const double turn = M_PI / 4.0 * k;
      const std::optional<Ray> ray =
          find(cone.Within(best.place + step * Place(std::cos(turn), std::sin(turn))));
      if (ray && ray->range < (nearer ? nearer->range : best.range)) {
        nearer = ray;
      }
    }
    if (nearer) {
      best = *nearer;
    } else {
      step *= 0.5;
    }
  }
}

double MeanOf(const std::vector<Ray>& rays) {
  double sum = 0.0, weights = 0.0, plain = 0.0;
  for (const Ray& ray : rays) {
    sum += ray.light * ray.range;
    weights += ray.light;
    plain += ray.range;
  }
  return weights > 0.0 ? sum / weights : plain / double(rays.size());
}

bool IsNearer(const Ray& a, const Ray& b) {
  return a.range < b.range;
}

} // namespace

RangeSensor::RangeSensor(const RangeSettings& settings) : Settings_(settings) {
  const RangeSettings& s = this->Settings_;
  Require(s.minimumRange >= 0.0 && s.minimumRange <= 1e15, RangeLabel, "the least range",
          s.minimumRange, "0 to 1e15 m");
  if (!(s.maximumRange > s.minimumRange)) {
    Reject(RangeLabel, "the greatest range is " + NumberText(s.maximumRange) +
                           " m; accepted: above the least one, " + NumberText(s.minimumRange) +
                           " m");
  }
  Require(s.divergence >= 0.0 && s.divergence <= M_PI, RangeLabel, "the divergence [rad]",
          s.divergence, "0 to pi");
  Require(s.rays >= 1 && s.rays <= MostRangeRays, RangeLabel, "the number of rays", s.rays,
          "1 to 10000");
  Require(s.noise >= 0.0 && s.noise <= 1e6, RangeLabel, "the noise", s.noise, "0 to 1e6 m");
  Require(s.noiseFraction >= 0.0 && s.noiseFraction <= 1.0, RangeLabel, "the noise as a fraction",
          s.noiseFraction, "0 to 1");
  Require(s.dropOut >= 0.0 && s.dropOut <= 1.0, RangeLabel, "the probability of a drop-out",
          s.dropOut, "0 to 1");
  Require(s.greatestIncidence >= 0.0 && s.greatestIncidence <= M_PI / 2.0, RangeLabel,
          "the greatest incidence [rad]", s.greatestIncidence, "0 to pi / 2");
  Require(s.leastIntensity >= 0.0, RangeLabel, "the least intensity", s.leastIntensity,
          "0 or more");
}

RangeEcho RangeSensor::Measure(const V& origin, const V& axis, std::uint64_t beam,
                               const Meet& meet) const {
  const RangeSettings& s = this->Settings_;
  const Cone cone(axis, 0.5 * s.divergence);
  RangeEcho echo;
  echo.outcome = RangeEcho::Outcome::Nothing;
  // A ray with an echo, or the reason why it has none.
  const auto find = [&](const Place& place, RangeEcho::Outcome* why) -> std::optional<Ray> {
    Ray ray;
    const V direction = cone.At(place);
    ray.place = place;
    ray.meeting = meet(origin, direction, s.maximumRange);
    ray.range = ray.meeting.range;
    if (!(ray.range <= s.maximumRange) || !std::isfinite(ray.range)) {
      return {};
    }
    if (ray.range < s.minimumRange) {
      *why = RangeEcho::Outcome::TooNear;
      return {};
    }
    const double cosine = std::min(std::abs(direction.dot(ray.meeting.normal)), 1.0);
    ray.incidence = std::acos(cosine);
    if (ray.incidence > s.greatestIncidence) {
      if (*why != RangeEcho::Outcome::TooNear) {
        *why = RangeEcho::Outcome::Oblique;
      }
      return {};
    }
    ray.light = ray.meeting.albedo * cosine / (ray.range * ray.range);
    return ray;
  };
  const int count = s.divergence > 0.0 ? s.rays : 1;
  std::vector<Ray> rays;
  double light = 0.0;
  for (int i = 0; i < count; ++i) {
    if (const std::optional<Ray> ray = find(cone.Ray(i, count), &echo.outcome)) {
      rays.push_back(*ray);
      light += ray->light;
    }
  }
  if (rays.empty()) {
    return echo;
  }
  light /= double(count);
  if (light < s.leastIntensity) {
    echo.outcome = RangeEcho::Outcome::Faint;
    return echo;
  }
  Draws draws(s.seed, std::uint32_t(beam), std::uint32_t(beam >> 32), s.scan, RangeChannel);
  if (draws.Next() < s.dropOut) { // drawn in any case, so that the noise does not depend on it
    echo.outcome = RangeEcho::Outcome::Lost;
    return echo;
  }
  Ray shown;
  switch (s.report) {
  case RangeSettings::Report::First:
    shown = *std::min_element(rays.begin(), rays.end(), IsNearer);
    echo.trueRange = shown.range;
    break;
  case RangeSettings::Report::Last:
    shown = *std::max_element(rays.begin(), rays.end(), IsNearer);
    echo.trueRange = shown.range;
    break;
  case RangeSettings::Report::Mean: {
    const double mean = echo.trueRange = MeanOf(rays);
    shown = *std::min_element(rays.begin(), rays.end(), [&](const Ray& a, const Ray& b) {
      return std::abs(a.range - mean) < std::abs(b.range - mean);
    });
    break;
  }
  case RangeSettings::Report::Least: {
    std::sort(rays.begin(), rays.end(), IsNearer);
    constexpr std::size_t Starts = 4;
    const double spacing = 0.5 * s.divergence / std::sqrt(double(count));
    const auto again = [&](const Place& place) {
      RangeEcho::Outcome why = echo.outcome;
      return find(place, &why);
    };
    shown = rays.front();
    for (std::size_t k = 0; k < std::min(Starts, rays.size()) && spacing > 0.0; ++k) {
      Ray best = rays[k];
      Refine(cone, spacing, again, best);
      if (IsNearer(best, shown)) {
        shown = best;
      }
    }
    echo.trueRange = shown.range;
    break;
  }
  }
  const double deviation = std::hypot(s.noise, s.noiseFraction * echo.trueRange);
  echo.outcome = RangeEcho::Outcome::Echo;
  echo.range = std::max(echo.trueRange + (deviation > 0.0 ? deviation * draws.Normal() : 0.0), 0.0);
  echo.intensity = light;
  echo.incidence = shown.incidence;
  const V direction = cone.At(shown.place);
  echo.normal =
      direction.dot(shown.meeting.normal) > 0.0 ? V(-shown.meeting.normal) : shown.meeting.normal;
  echo.label = shown.meeting.label;
  return echo;
}

} // namespace dspace
