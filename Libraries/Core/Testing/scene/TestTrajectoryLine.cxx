// Lines of trajectories: what is rejected, and how they follow the scene's time.
#include <cmath>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/trajectories/TrajectoryLine.h>

namespace dspace {
namespace {

using Strip = TrajectoryLine::Strip;

Eigen::Vector3d OnCircle(double t) {
  return 1e6 * Eigen::Vector3d(std::cos(t), std::sin(t), 0.0);
}

Strip Circle(int count) {
  Strip strip;
  for (int i = 0; i < count; ++i) {
    strip.times.push_back(0.1 * i);
    strip.points.push_back(OnCircle(0.1 * i));
  }
  return strip;
}

TEST(TrajectoryLine, RejectsWhatIsNoLine) {
  const auto rejected = [](std::vector<Strip> strips, const char* words) {
    try {
      TrajectoryLine("object 'a'", std::move(strips));
      FAIL() << "accepted: " << words;
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  rejected({}, "two and more");
  rejected({Circle(1)}, "two and more");
  Strip strip = Circle(4);
  strip.times.pop_back();
  rejected({strip}, "3 times");
  strip = Circle(4);
  strip.colors.resize(2);
  rejected({strip}, "2 colours");
  strip = Circle(4);
  strip.times[2] = strip.times[1];
  rejected({strip}, "ascending");
  strip = Circle(4);
  strip.points[1].z() = NAN;
  rejected({strip}, "point");
  rejected({Circle(4), Circle(4)}, "ascending"); // the second begins before the first ends
  TrajectoryLine line("object 'a'", {Circle(4)});
  TrajectoryLook look;
  look.before = -1.0;
  EXPECT_THROW(line.SetLook("object 'a'", look), Error);
  look = {};
  look.opacity = 1.5;
  EXPECT_THROW(line.SetLook("object 'a'", look), Error);
  look = {};
  look.fontSize = 5;
  EXPECT_THROW(line.SetLook("object 'a'", look), Error);
  EXPECT_EQ(line.Look().opacity, 1.0);
}

TEST(TrajectoryLine, RunsThroughTheCraftHoweverCoarseItsPoints) {
  TrajectoryLine line("line", {Circle(20)}, {}, OnCircle);
  for (const double now : {0.0, 0.031, 0.75, 0.8, 1.9}) {
    line.SetTime(now);
    const auto& detail = line.GetDetail();
    const auto& points = detail.points;
    ASSERT_GE(points.points.size(), 2u) << now;
    const Strip& whole = line.Strips()[0];
    EXPECT_EQ(points.points.front(), whole.points[detail.first]); // no gap
    EXPECT_EQ(points.points.back(), whole.points[detail.last]);
    double nearest = 1e9;
    for (std::size_t i = 1; i < points.times.size(); ++i) {
      ASSERT_GT(points.times[i], points.times[i - 1]);
      const Eigen::Vector3d a = points.points[i - 1];
      const Eigen::Vector3d b = points.points[i];
      const double share =
          std::clamp((OnCircle(now) - a).dot(b - a) / (b - a).squaredNorm(), 0.0, 1.0);
      nearest = std::min(nearest, (a + share * (b - a) - OnCircle(now)).norm());
    }
    EXPECT_LT(nearest, 1e-9) << now; // the chords themselves sag by 1.2 km
  }
  line.SetTime(5.0); // after its end
  EXPECT_TRUE(line.GetDetail().points.points.empty());
}

TEST(TrajectoryLine, ChangesOnlyWithATimeThatItFollows) {
  TrajectoryLine line("line", {Circle(20)});
  const auto revision = line.Revision();
  line.SetTime(1.0);
  EXPECT_EQ(line.Revision(), revision);
  TrajectoryLook look;
  look.before = 0.5;
  line.SetLook("line", look);
  const auto then = line.Revision();
  EXPECT_GT(then, revision);
  line.SetTime(1.1);
  EXPECT_GT(line.Revision(), then);
  look = {};
  look.fade = true;
  line.SetLook("line", look);
  EXPECT_NEAR(line.FadeLengths()[0], 1.1, 1e-12); // to its first point
  EXPECT_NEAR(line.FadeLengths()[1], 0.8, 1e-12);
  EXPECT_NEAR(line.Bounds().radius, 0.505 * std::hypot(1e6 * (1.0 - std::cos(1.9)), 1e6), 1e3);
}

} // namespace
} // namespace dspace
