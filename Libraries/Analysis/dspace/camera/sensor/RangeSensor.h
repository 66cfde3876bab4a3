// What a range sensor, a lidar or an altimeter, reports of surfaces that its rays meet.
#ifndef DSPACE_CAMERA_SENSOR_RANGE_SENSOR_H
#define DSPACE_CAMERA_SENSOR_RANGE_SENSOR_H

#include <cstdint>
#include <functional>
#include <limits>

#include <Eigen/Core>

namespace dspace {

struct RangeSettings {
  // Of several surfaces in one beam. Mean: the mean of the rays' ranges, weighted with their light.
  // Least: the least range within the cone, searched for between the rays too (beam-limited
  // altimeter).
  enum class Report { First, Last, Mean, Least };

  double minimumRange = 0.0; // [m]; what is nearer gives no echo, and hides what is behind it
  double maximumRange = std::numeric_limits<double>::infinity(); // [m], above the least one
  double divergence = 0.0; // full angle of the beam's cone [rad], 0 to pi; 0: one ray
  int rays = 1;            // of a beam, 1 to 10,000: the axis, and others evenly over the cone
  Report report = Report::First;
  // Standard deviation of the range: sqrt(noise² + (noiseFraction · range)²).
  double noise = 0.0;                    // [m], 0 to 1e6
  double noiseFraction = 0.0;            // 0 to 1
  double dropOut = 0.0;                  // probability that a beam is lost, 0 to 1
  double greatestIncidence = M_PI / 2.0; // [rad], 0 to pi / 2; steeper surfaces give no echo
  double leastIntensity = 0.0;           // [1/m²], >= 0; a beam that is fainter is lost
  std::uint64_t seed = 0;
  std::uint32_t scan = 0; // its number: other noise with the same seed
};

// The first surface on a ray.
struct RangeMeeting {
  double range = std::numeric_limits<double>::infinity(); // [m]; infinity: none
  Eigen::Vector3d normal = Eigen::Vector3d::Zero();       // unit, either side
  double albedo = 0.0;                                    // Lambert's, 0 to 1
  std::uint32_t label = 0;                                // whose it is
};

// The report on one beam. Numbers are NaN and the label is 0 where there is no echo.
struct RangeEcho {
  // Echo, or why there is none: nothing in range; nearer than the least range; steeper than the
  // greatest incidence; fainter than the least intensity; lost at random; no such beam.
  enum class Outcome { Echo, Nothing, TooNear, Oblique, Faint, Lost, NoBeam };
  Outcome outcome = Outcome::NoBeam;
  double range = std::numeric_limits<double>::quiet_NaN();     // as measured, with noise [m]
  double trueRange = std::numeric_limits<double>::quiet_NaN(); // without noise [m]
  // The mean over all rays of the beam of albedo · cos(incidence) / range² [1/m²]: the light of a
  // Lambertian surface that fills the beam. A ray without an echo counts as 0.
  double intensity = std::numeric_limits<double>::quiet_NaN();
  // Of the ray whose range is nearest to the true one: the angle between ray and normal [rad], the
  // normal on the sensor's side, the label.
  double incidence = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector3d normal = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());
  std::uint32_t label = 0;
};

// Immutable. Noise depends on the seed, the scan and the beam's number alone (Philox4x32-10).
class RangeSensor {
public:
  // Finds the first surface from an origin in a unit direction, up to a range.
  using Meet = std::function<RangeMeeting(const Eigen::Vector3d& origin,
                                          const Eigen::Vector3d& direction, double most)>;

  // Throws Error(InvalidArgument) naming the value and what is accepted.
  explicit RangeSensor(const RangeSettings& settings);

  const RangeSettings& Settings() const { return this->Settings_; }
  // The report on a beam along a unit axis. `beam`: its number.
  RangeEcho Measure(const Eigen::Vector3d& origin, const Eigen::Vector3d& axis, std::uint64_t beam,
                    const Meet& meet) const;

private:
  RangeSettings Settings_;
};

} // namespace dspace

#endif
