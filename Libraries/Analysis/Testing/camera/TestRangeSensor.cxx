// Range sensors: beams on a plane, a sphere and a step in closed form; noise and drop-outs by their
// statistics.
#include <cmath>
#include <vector>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include <dspace/Error.h>
#include <dspace/camera/sensor/RangeSensor.h>

namespace dspace {
namespace {

using V = Eigen::Vector3d;
using Report = RangeSettings::Report;
using Outcome = RangeEcho::Outcome;
constexpr double PerDegree = M_PI / 180.0; // [rad]
const V Down(0, 0, -1);

// Level ground at z = 0 of albedo 0.5.
RangeMeeting Plane(const V& origin, const V& direction, double most) {
  const double range = -origin.z() / direction.z();
  if (!(range > 0.0 && range <= most)) {
    return {};
  }
  return {range, V(0, 0, 1), 0.5, 7};
}

RangeMeeting Ball(const V& origin, const V& direction, double most) { // of radius 3 about zero
  const double b = origin.dot(direction);
  const double c = origin.squaredNorm() - 9.0;
  const double range = -b - std::sqrt(b * b - c);
  if (!(range > 0.0 && range <= most)) {
    return {};
  }
  return {range, V(origin + range * direction) / 3.0, 1.0, 8};
}

// Ground at z = 0 for x < 0, and 2 m higher from there on.
RangeMeeting Step(const V& origin, const V& direction, double most) {
  const double high = (2.0 - origin.z()) / direction.z();
  if (high <= most && origin.x() + high * direction.x() >= 0.0) {
    return {high, V(0, 0, 1), 0.5, 2};
  }
  RangeMeeting low = Plane(origin, direction, most);
  low.label = 1;
  return low;
}

RangeEcho One(const RangeSettings& settings, const V& origin, const V& axis,
              const RangeSensor::Meet& meet) {
  return RangeSensor(settings).Measure(origin, axis, 0, meet);
}

TEST(RangeSensor, OneRayOnAPlane) {
  for (const double angle : {0.0, 20.0, 60.0, 85.0}) {
    const double cosine = std::cos(angle * PerDegree);
    const RangeEcho echo = One({}, {1, 2, 10}, {std::sin(angle * PerDegree), 0.0, -cosine}, Plane);
    ASSERT_EQ(echo.outcome, Outcome::Echo);
    EXPECT_NEAR(echo.range, 10.0 / cosine, 1e-11);
    EXPECT_EQ(echo.range, echo.trueRange);
    EXPECT_NEAR(echo.incidence, angle * PerDegree, 1e-7);
    EXPECT_NEAR(echo.intensity, 0.5 * cosine * cosine * cosine / 100.0, 1e-15);
    EXPECT_EQ(echo.label, 7u);
    EXPECT_EQ(echo.normal, V(0, 0, 1));
  }
  const RangeEcho none = One({}, {0, 0, 10}, {0, 0, 1}, Plane);
  EXPECT_EQ(none.outcome, Outcome::Nothing);
  EXPECT_TRUE(std::isnan(none.range));
  EXPECT_EQ(none.label, 0u);
  // From below, the normal is on the sensor's side.
  EXPECT_EQ(One({}, {0, 0, -10}, {0, 0, 1}, Plane).normal, V(0, 0, -1));
}

TEST(RangeSensor, TheFirstAndTheLastRayOfAConeOnAPlane) {
  // Of a cone of half angle a whose axis is t from the vertical: 10 / cos(t - a), 10 / cos(t + a).
  RangeSettings settings;
  settings.divergence = 4.0 * PerDegree;
  settings.rays = 10000;
  const V axis(std::sin(30.0 * PerDegree), 0.0, -std::cos(30.0 * PerDegree));
  settings.report = Report::First;
  const double first = One(settings, {0, 0, 10}, axis, Plane).range;
  EXPECT_NEAR(first, 10.0 / std::cos(28.0 * PerDegree), 0.01);
  EXPECT_GE(first, 10.0 / std::cos(28.0 * PerDegree));
  settings.report = Report::Last;
  const double last = One(settings, {0, 0, 10}, axis, Plane).range;
  EXPECT_NEAR(last, 10.0 / std::cos(32.0 * PerDegree), 0.01);
  EXPECT_LE(last, 10.0 / std::cos(32.0 * PerDegree));
  settings.report = Report::Mean;
  EXPECT_NEAR(One(settings, {0, 0, 10}, axis, Plane).range, 10.0 / std::cos(30.0 * PerDegree),
              0.01);
  // The rays lie evenly: the mean light is the integral over the cone.
  double sum = 0.0;
  constexpr int Steps = 400;
  for (int i = 0; i < Steps; ++i) {
    for (int j = 0; j < Steps; ++j) {
      const double c = 1.0 - (i + 0.5) / Steps * (1.0 - std::cos(2.0 * PerDegree));
      const double s = std::sqrt(1.0 - c * c), turn = 2.0 * M_PI * (j + 0.5) / Steps;
      const V right(std::cos(30.0 * PerDegree), 0.0, std::sin(30.0 * PerDegree));
      const double down =
          -(c * axis + s * (std::cos(turn) * right + std::sin(turn) * V::UnitY())).z();
      sum += 0.5 * down * down * down / 100.0;
    }
  }
  EXPECT_NEAR(One(settings, {0, 0, 10}, axis, Plane).intensity, sum / (Steps * Steps), 1e-7);
}

TEST(RangeSensor, TheLeastRangeInAConeToATenthOfAMillimetre) {
  RangeSettings settings;
  settings.report = Report::Least;
  settings.rays = 61;
  for (const double width : {2.0, 10.0, 60.0}) {
    settings.divergence = width * PerDegree;
    for (const double tilt : {0.0, 12.0, 40.0}) {
      const V axis(std::sin(tilt * PerDegree) * 0.6, std::sin(tilt * PerDegree) * 0.8,
                   -std::cos(tilt * PerDegree));
      const double off = std::max(tilt - 0.5 * width, 0.0);
      EXPECT_NEAR(One(settings, {0, 0, 1000}, axis, Plane).range,
                  1000.0 / std::cos(off * PerDegree), 1e-4 * 5)
          << width << " " << tilt;
      RangeSettings fine = settings; // the ball is 3.4 degrees wide: rays must meet it
      fine.rays = 1000;
      const double ball = One(fine, V(0, 0, 100), axis, Ball).range;
      if (off == 0.0) {
        EXPECT_NEAR(ball, 97.0, 1e-4 * 5) << width << " " << tilt;
      }
    }
  }
}

TEST(RangeSensor, OneBeamOnTwoSurfaces) {
  // The beam's axis is on the edge: half of the rays meet either.
  RangeSettings settings;
  settings.divergence = 1.0 * PerDegree;
  settings.rays = 2000;
  settings.report = Report::First;
  EXPECT_NEAR(One(settings, {0, 0, 100}, Down, Step).range, 98.0, 0.01);
  EXPECT_EQ(One(settings, {0, 0, 100}, Down, Step).label, 2u);
  settings.report = Report::Last;
  EXPECT_NEAR(One(settings, {0, 0, 100}, Down, Step).range, 100.0, 0.01);
  EXPECT_EQ(One(settings, {0, 0, 100}, Down, Step).label, 1u);
  settings.report = Report::Mean;
  const double near = 1.0 / (98.0 * 98.0), far = 1.0 / (100.0 * 100.0);
  EXPECT_NEAR(One(settings, {0, 0, 100}, Down, Step).range,
              (98.0 * near + 100.0 * far) / (near + far), 0.02);
  // What is nearer than the least range hides what is behind it, and the rest is seen.
  settings.report = Report::First;
  settings.minimumRange = 99.0;
  const RangeEcho rest = One(settings, {0, 0, 100}, Down, Step);
  EXPECT_EQ(rest.label, 1u);
  EXPECT_NEAR(rest.intensity, 0.25 * far, 1e-3 * far);
}

TEST(RangeSensor, WhyThereIsNoEcho) {
  const V slant(std::sin(60.0 * PerDegree), 0.0, -0.5); // 20 m of range from 10 m up
  const auto outcome = [&](const RangeSettings& s) {
    return One(s, {0, 0, 10}, slant, Plane).outcome;
  };
  RangeSettings s;
  s.minimumRange = 20.1;
  EXPECT_EQ(outcome(s), Outcome::TooNear);
  s.minimumRange = 19.9;
  EXPECT_EQ(outcome(s), Outcome::Echo);
  s = {};
  s.maximumRange = 19.9;
  EXPECT_EQ(outcome(s), Outcome::Nothing);
  s.maximumRange = 20.1;
  EXPECT_EQ(outcome(s), Outcome::Echo);
  s = {};
  s.greatestIncidence = 59.9 * PerDegree;
  EXPECT_EQ(outcome(s), Outcome::Oblique);
  s.greatestIncidence = 60.1 * PerDegree;
  EXPECT_EQ(outcome(s), Outcome::Echo);
  s = {};
  s.leastIntensity = 0.5 * 0.5 / 400.0 * 1.001;
  EXPECT_EQ(outcome(s), Outcome::Faint);
  s.leastIntensity = 0.5 * 0.5 / 400.0 * 0.999;
  EXPECT_EQ(outcome(s), Outcome::Echo);
  s = {};
  s.dropOut = 1.0;
  EXPECT_EQ(outcome(s), Outcome::Lost);
}

TEST(RangeSensor, NoiseAndDropOutsByTheirStatistics) {
  constexpr int Count = 100000;
  RangeSettings settings;
  settings.noise = 0.03;
  settings.noiseFraction = 4e-3; // at 10 m: 0.05 m together
  settings.dropOut = 0.2;
  settings.seed = 5;
  const RangeSensor sensor(settings);
  std::vector<double> errors;
  for (int i = 0; i < Count; ++i) {
    const RangeEcho echo = sensor.Measure({0, 0, 10}, Down, std::uint64_t(i), Plane);
    if (echo.outcome == Outcome::Echo) {
      EXPECT_EQ(echo.trueRange, 10.0);
      errors.push_back(echo.range - 10.0);
    }
  }
  const double n = double(errors.size());
  EXPECT_NEAR(n / Count, 0.8, 5.0 * std::sqrt(0.16 / Count));
  double mean = 0.0, square = 0.0, fourth = 0.0;
  for (const double error : errors) {
    mean += error / n;
    square += error * error / n;
    fourth += error * error * error * error / n;
  }
  EXPECT_NEAR(mean, 0.0, 5.0 * 0.05 / std::sqrt(n));
  EXPECT_NEAR(square, 0.0025, 5.0 * 0.0025 * std::sqrt(2.0 / n));
  EXPECT_NEAR(fourth / (square * square), 3.0, 0.1); // normal
}

TEST(RangeSensor, EqualSeedsGiveEqualNoiseAndOthersOther) {
  RangeSettings settings;
  settings.noise = 1.0;
  settings.seed = 0xfedcba9876543210u;
  const auto range = [](const RangeSettings& s, std::uint64_t beam) {
    return RangeSensor(s).Measure({0, 0, 10}, Down, beam, Plane).range;
  };
  const double first = range(settings, 3);
  EXPECT_EQ(first, range(settings, 3));
  EXPECT_NE(first, range(settings, 4));
  EXPECT_NE(first, range(settings, 3 + (std::uint64_t(1) << 32)));
  RangeSettings other = settings;
  other.scan = 1;
  EXPECT_NE(first, range(other, 3));
  other = settings;
  other.seed ^= std::uint64_t(1) << 40;
  EXPECT_NE(first, range(other, 3));
  other = settings;
  other.dropOut = 1e-6; // does not shift the noise
  EXPECT_EQ(first, range(other, 3));
}

void ExpectRejected(const RangeSettings& settings, const std::string& text) {
  try {
    const RangeSensor sensor(settings);
    ADD_FAILURE() << "accepted: " << text;
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
    EXPECT_NE(std::string(error.what()).find(text), std::string::npos) << error.what();
  }
}

TEST(RangeSensor, SettingsOutOfRangeAreRejected) {
  RangeSettings s;
  s.minimumRange = 5.0;
  s.maximumRange = 5.0;
  ExpectRejected(s, "the greatest range is 5 m; accepted: above the least one, 5 m");
  s = {};
  s.maximumRange = std::nan("");
  ExpectRejected(s, "the greatest range is nan");
  s = {};
  s.minimumRange = -1.0;
  ExpectRejected(s, "the least range is -1; accepted: 0 to 1e15 m");
  s = {};
  s.rays = 0;
  ExpectRejected(s, "the number of rays is 0; accepted: 1 to 10000");
  s = {};
  s.divergence = 4.0;
  ExpectRejected(s, "the divergence [rad] is 4; accepted: 0 to pi");
  s = {};
  s.noise = std::nan("");
  ExpectRejected(s, "the noise is nan; accepted: 0 to 1e6 m");
  s = {};
  s.dropOut = 1.5;
  ExpectRejected(s, "the probability of a drop-out is 1.5; accepted: 0 to 1");
  s = {};
  s.greatestIncidence = 2.0;
  ExpectRejected(s, "the greatest incidence [rad] is 2; accepted: 0 to pi / 2");
}

} // namespace
} // namespace dspace
