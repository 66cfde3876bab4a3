// Kernels that a writer of the tests makes from closed forms, in both byte orders: what the readers
// say at the edges of segments, records and directories, and between.
#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/kernels/BinaryPck.h>
#include <dspace/kernels/CkFile.h>
#include <dspace/kernels/SpkFile.h>

#include "KernelWriter.h"
#include "TemporaryFolder.h"

namespace dspace {
namespace {

using testing::Components;
using testing::DafWriter;
using testing::TemporaryFolder;

constexpr double Earth = 398600.4418; // [km^3/s^2]

// An inclined ellipse in kilometres, by Kepler's equation: position, velocity, and its
// acceleration.
struct Ellipse {
  double a = 9000.0;
  double e = 0.12;
  Eigen::Matrix3d plane = (Eigen::AngleAxisd(0.7, Eigen::Vector3d::UnitZ()) *
                           Eigen::AngleAxisd(1.0, Eigen::Vector3d::UnitX()))
                              .toRotationMatrix();
  std::vector<double> State(double t) const {
    const double n = std::sqrt(Earth / (a * a * a));
    const double m = n * (t > 5e7 ? t - 1e8 : t); // its digits are kept near 0 and 1e8 s
    double E = m;
    for (int i = 0; i < 60; ++i) {
      E -= (E - e * std::sin(E) - m) / (1.0 - e * std::cos(E));
    }
    const double b = a * std::sqrt(1.0 - e * e);
    const double rate = n / (1.0 - e * std::cos(E));
    const Eigen::Vector3d p = plane * Eigen::Vector3d(a * (std::cos(E) - e), b * std::sin(E), 0.0);
    const Eigen::Vector3d v =
        plane * Eigen::Vector3d(-a * std::sin(E) * rate, b * std::cos(E) * rate, 0.0);
    return {p.x(), p.y(), p.z(), v.x(), v.y(), v.z()};
  }
  std::vector<double> Position(double t) const {
    std::vector<double> state = this->State(t);
    state.resize(3);
    return state;
  }
  std::vector<double> Acceleration(double t) const {
    const std::vector<double> s = this->State(t);
    const Eigen::Vector3d p(s[0], s[1], s[2]);
    const Eigen::Vector3d g = -Earth / std::pow(p.norm(), 3) * p;
    return {g.x(), g.y(), g.z()};
  }
};

struct Tolerance {
  double position; // [m]
  double velocity; // [m/s]
};

void ExpectOrbit(const SpkFile& file, std::size_t segment, const std::vector<double>& times,
                 const Tolerance& tolerance) {
  const Ellipse orbit;
  for (const double t : times) {
    const State state = file.At(segment, t);
    const std::vector<double> truth = orbit.State(t);
    const Eigen::Vector3d p = 1e3 * Eigen::Vector3d(truth[0], truth[1], truth[2]);
    const Eigen::Vector3d v = 1e3 * Eigen::Vector3d(truth[3], truth[4], truth[5]);
    EXPECT_LT((state.position - p).norm(), tolerance.position)
        << "segment " << segment << " at " << t;
    EXPECT_LT((state.velocity - v).norm(), tolerance.velocity)
        << "segment " << segment << " at " << t;
  }
}

// Ten times between two of `nodes`, the nodes themselves, and their neighbouring doubles within the
// segment.
std::vector<double> Around(const std::vector<double>& nodes) {
  std::vector<double> times;
  for (std::size_t i = 0; i < nodes.size(); ++i) {
    times.push_back(nodes[i]);
    if (i > 0) {
      times.push_back(std::nextafter(nodes[i], nodes[i - 1]));
    }
    if (i + 1 < nodes.size()) {
      times.push_back(std::nextafter(nodes[i], nodes[i + 1]));
      for (int k = 1; k < 10; ++k) {
        times.push_back(nodes[i] + 0.1 * k * (nodes[i + 1] - nodes[i]));
      }
    }
  }
  return times;
}

std::vector<double> Even(double begin, double step, int count) {
  std::vector<double> times;
  for (int i = 0; i < count; ++i) {
    times.push_back(begin + step * i);
  }
  return times;
}

class WrittenKernels : public ::testing::TestWithParam<bool> {
protected:
  TemporaryFolder Folder_;
  Components State_ = [](double t) { return Ellipse().State(t); };
  Components Position_ = [](double t) { return Ellipse().Position(t); };
  Components Acceleration_ = [](double t) { return Ellipse().Acceleration(t); };

  std::unique_ptr<SpkFile> Write(const std::vector<int>& types,
                                 const std::vector<std::vector<double>>& words, double begin,
                                 double end, int most = 25) {
    DafWriter writer("DAF/SPK ", 2, 6, this->GetParam());
    for (std::size_t i = 0; i < types.size(); ++i) {
      writer.Add("segment " + std::to_string(i), {begin, end}, {-1000 - int(i), 399, 1, types[i]},
                 words[i]);
    }
    const std::string path = this->Folder_ / "orbit.bsp";
    writer.Write(path, most);
    return std::make_unique<SpkFile>(path);
  }
};

TEST_P(WrittenKernels, SummariesNamesAndByteOrder) {
  std::vector<int> types;
  std::vector<std::vector<double>> words;
  for (int i = 0; i < 60; ++i) { // over several summary records
    types.push_back(2);
    words.push_back(testing::ChebyshevWords(this->Position_, 0.0, 600.0, 2, 12));
  }
  const auto file = this->Write(types, words, 0.0, 1200.0, 7);
  ASSERT_EQ(file->Segments().size(), 60u);
  EXPECT_EQ(file->File().IsBigEndian(), this->GetParam());
  EXPECT_EQ(file->File().Kind(), "SPK");
  for (int i = 0; i < 60; ++i) {
    const SpkFile::Segment& segment = file->Segments()[std::size_t(i)];
    EXPECT_EQ(segment.name, "segment " + std::to_string(i));
    EXPECT_EQ(segment.target, -1000 - i);
    EXPECT_EQ(segment.center, 399);
    EXPECT_EQ(segment.frame, 1);
    EXPECT_EQ(segment.type, 2);
    EXPECT_EQ(segment.begin, 0.0);
    EXPECT_EQ(segment.end, 1200.0);
  }
  ExpectOrbit(*file, 59, Around({0.0, 600.0, 1200.0}), {1e-3, 1e-4});
}

TEST_P(WrittenKernels, ChebyshevPolynomials) {
  const double begin = -1234.5; // before J2000
  const double length = 450.0;
  const auto file = this->Write({2, 3},
                                {testing::ChebyshevWords(this->Position_, begin, length, 7, 13),
                                 testing::ChebyshevWords(this->State_, begin, length, 7, 13)},
                                begin, begin + 7 * length);
  const std::vector<double> times = Around(Even(begin, length, 8));
  ExpectOrbit(*file, 0, times, {1e-3, 1e-4}); // the derivative of the polynomial
  ExpectOrbit(*file, 1, times, {1e-3, 1e-6}); // a polynomial of its own
  for (const std::size_t segment : {0u, 1u}) {
    EXPECT_THROW(file->At(segment, begin - 1e-3), Error);
    EXPECT_THROW(file->At(segment, begin + 7 * length + 1e-3), Error);
  }
}

// 100, 101, 199, 200 and 201 states: with and without an entry of the directory at the end.
TEST_P(WrittenKernels, StatesInTables) {
  for (const int count : {12, 99, 100, 101, 199, 200, 201, 350}) {
    SCOPED_TRACE(count);
    const std::vector<double> even = Even(1e8, 30.0, count);
    std::vector<double> uneven = even; // ascending, steps of 22 to 38 s
    for (int i = 1; i + 1 < count; ++i) {
      uneven[std::size_t(i)] += 4.0 * std::sin(2.1 * i);
    }
    const auto file =
        this->Write({8, 9, 9, 13, 13},
                    {testing::EqualStates(this->State_, even.front(), 30.0, count, 9),
                     testing::TimedStates(this->State_, uneven, 9),  // even number of states
                     testing::TimedStates(this->State_, uneven, 8),  // odd
                     testing::TimedStates(this->State_, uneven, 3),  // 4 states, degree 7
                     testing::TimedStates(this->State_, uneven, 4)}, // 5 states, degree 9
                    even.front(), even.back());
    const std::vector<double> times = Around(uneven);
    ExpectOrbit(*file, 0, Around(even), {0.01, 1e-5});
    ExpectOrbit(*file, 1, times, {0.05, 1e-4});
    ExpectOrbit(*file, 2, times, {0.5, 1e-3});
    ExpectOrbit(*file, 3, times, {1e-3, 1e-5});
    ExpectOrbit(*file, 4, times, {1e-3, 1e-5});
  }
}

// Which states a table of type 8 or 9 uses is part of the format: with a polynomial of low degree
// the choice shows. NAIF: an even number, as many on each side; an odd number, about the nearest
// one (of two equally near ones the later); fewer on a side at the ends.
TEST_P(WrittenKernels, TheChoiceOfStatesIsNaifs) {
  const Components cubed = [](double t) -> std::vector<double> {
    return {t * t * t, 0, 0, 3 * t * t, 0, 0};
  };
  const auto file = this->Write({9, 9},
                                {testing::TimedStates(cubed, Even(0.0, 1.0, 8), 1),
                                 testing::TimedStates(cubed, Even(0.0, 1.0, 8), 2)},
                                0.0, 7.0);
  const auto quadratic = [](double t, double first) { // through t^3 at first, first + 1, first + 2
    return t * t * t - (t - first) * (t - first - 1.0) * (t - first - 2.0);
  };
  for (const double t : {0.25, 3.25, 3.75, 6.9}) {
    const double left = std::floor(t);
    EXPECT_NEAR(file->At(0, t).position.x() / 1e3,
                left * left * left + (t - left) * (std::pow(left + 1, 3) - left * left * left),
                1e-9);
    const double nearest = std::round(t);
    EXPECT_NEAR(file->At(1, t).position.x() / 1e3,
                quadratic(t, std::clamp(nearest - 1.0, 0.0, 5.0)), 1e-9)
        << t;
  }
}

TEST_P(WrittenKernels, DifferenceLines) {
  for (const int count : {1, 99, 100, 101, 200, 230}) {
    SCOPED_TRACE(count);
    std::vector<std::vector<double>> large; // type 21
    std::vector<std::vector<double>> small; // type 1
    std::vector<double> ends;
    for (int i = 0; i < count; ++i) {
      // Each line's reference is its end; the accelerations reach back over it, at uneven gaps.
      const double end = 60.0 * (i + 1);
      ends.push_back(end);
      std::vector<double> gaps;
      for (int k = 0; k < 11; ++k) {
        gaps.push_back(7.0 + 0.5 * (k % 3));
      }
      large.push_back(testing::DifferenceLine(this->State_, this->Acceleration_, end, gaps, 20));
      small.push_back(testing::DifferenceLine(this->State_, this->Acceleration_, end, gaps, 15));
    }
    const auto file = this->Write({21, 1},
                                  {testing::DifferenceWords(large, ends, 20, false),
                                   testing::DifferenceWords(small, ends, 15, true)},
                                  0.0, ends.back());
    std::vector<double> nodes = {0.0};
    nodes.insert(nodes.end(), ends.begin(), ends.end());
    const std::vector<double> times = Around(nodes);
    ExpectOrbit(*file, 0, times, {1e-4, 1e-6});
    ExpectOrbit(*file, 1, times, {1e-4, 1e-6});
  }
}

TEST_P(WrittenKernels, Pointings) {
  // Turns about an axis that is not one of the frame's, at constant rate within each interval.
  const Eigen::Vector3d axis = Eigen::Vector3d(1, -2, 0.5).normalized();
  const double rate = 0.003; // [rad/s]
  const double ticksPerSecond = 256.0;
  // SPICE's quaternion of a C matrix, base to instrument: components turn against the instrument.
  const auto pointing = [&](double ticks) {
    return Eigen::Quaterniond(Eigen::AngleAxisd(-rate * ticks / ticksPerSecond, axis)).normalized();
  };
  for (const int count : {2, 100, 101, 250}) {
    for (const bool rates : {false, true}) {
      SCOPED_TRACE(count);
      std::vector<double> ticks;
      std::vector<double> starts;
      std::vector<Eigen::Quaterniond> quaternions;
      for (int i = 0; i < count; ++i) {
        if (i % 40 == 0) { // a gap before each interval
          starts.push_back(i == 0 ? 1e6 : ticks.back() + 1e5);
          ticks.push_back(starts.back());
        } else {
          ticks.push_back(ticks.back() + 2560.0 + 10.0 * (i % 5));
        }
        Eigen::Quaterniond q = pointing(ticks.back());
        if (i % 3 == 1) { // both signs are the same pointing
          q.coeffs() = -q.coeffs();
        }
        quaternions.push_back(q);
      }
      const std::vector<Eigen::Vector3d> angular(rates ? ticks.size() : 0, rate * axis);
      DafWriter writer("DAF/CK  ", 2, 6, this->GetParam());
      writer.Add("attitude", {ticks.front(), ticks.back()}, {-1000000, 1, 3, rates ? 1 : 0},
                 testing::PointingWords(ticks, quaternions, angular, starts));
      const std::string path = this->Folder_ / "attitude.bc";
      writer.Write(path);
      const CkFile file(path);
      ASSERT_EQ(file.Segments().size(), 1u);
      EXPECT_EQ(file.Segments()[0].instrument, -1000000);
      EXPECT_EQ(file.Segments()[0].hasRates, rates);
      EXPECT_EQ(file.Intervals(0).size(), starts.size());
      for (std::size_t i = 0; i < ticks.size(); ++i) {
        const bool last = i + 1 == ticks.size();
        const bool gap = last || std::count(starts.begin(), starts.end(), ticks[i + 1]) > 0;
        for (const double share : {0.0, 0.25, 0.5, 0.99}) {
          if (gap && share > 0.0) {
            continue;
          }
          const double t = last ? ticks[i] : ticks[i] + share * (ticks[i + 1] - ticks[i]);
          const auto found = file.At(0, t);
          ASSERT_TRUE(found.has_value()) << t;
          const Eigen::Matrix3d truth = pointing(t).toRotationMatrix();
          EXPECT_LT((found->rotation - truth).cwiseAbs().maxCoeff(), 1e-12) << t;
          EXPECT_EQ(found->rate.has_value(), rates);
          if (found->rate) {
            EXPECT_LT((*found->rate - rate * axis).norm(), 1e-12);
          }
        }
        if (gap && !last) { // between intervals there is none, but the nearest with a tolerance
          const double t = ticks[i] + 0.25 * (ticks[i + 1] - ticks[i]);
          EXPECT_FALSE(file.At(0, t).has_value()) << t;
          const auto near = file.At(0, t, 0.3 * (ticks[i + 1] - ticks[i]));
          ASSERT_TRUE(near.has_value());
          EXPECT_EQ(near->ticks, ticks[i]);
        }
      }
    }
  }
}

TEST_P(WrittenKernels, BodyOrientation) {
  const Components angles = [](double t) -> std::vector<double> {
    return {0.3 + 1e-7 * t, 0.4 + 1e-3 * std::sin(1e-4 * t), 1.0 + 7.29e-5 * t};
  };
  DafWriter writer("DAF/PCK ", 2, 5, this->GetParam());
  const double begin = 5e8;
  const double length = 3600.0;
  writer.Add("earth", {begin, begin + 5 * length}, {3000, 17, 2},
             testing::ChebyshevWords(angles, begin, length, 5, 8));
  const std::string path = this->Folder_ / "earth.bpc";
  writer.Write(path);
  const BinaryPck file(path);
  ASSERT_EQ(file.Segments().size(), 1u);
  EXPECT_EQ(file.Segments()[0].frameClass, 3000);
  EXPECT_EQ(file.Segments()[0].inertial, 17);
  for (const double t : Around(Even(begin, length, 6))) {
    const BinaryPck::Angles found = file.At(0, t);
    const std::vector<double> truth = angles(t);
    EXPECT_NEAR(found.phi, truth[0], 1e-10) << t;
    EXPECT_NEAR(found.delta, truth[1], 1e-10) << t;
    EXPECT_NEAR(found.w, truth[2], 1e-10 * truth[2]) << t;
    EXPECT_NEAR(found.phiRate, 1e-7, 1e-12);
    EXPECT_NEAR(found.deltaRate, 1e-7 * std::cos(1e-4 * t), 1e-12);
    EXPECT_NEAR(found.wRate, 7.29e-5, 1e-10);
  }
  EXPECT_THROW(file.At(0, begin - 1.0), Error);
}

INSTANTIATE_TEST_SUITE_P(ByteOrders, WrittenKernels, ::testing::Bool(),
                         [](const auto& info) { return info.param ? "Big" : "Little"; });

} // namespace
} // namespace dspace
