// Cameras above ground in closed form: level, above the ground, the point under the pointer stays.
#include <cmath>
#include <random>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/controls/GroundMotion.h>
#include <dspace/scene/controls/OrbitController.h>

namespace {

using dspace::InputEvent;
using dspace::Navigation;
using dspace::NavigationGround;
using dspace::OrbitController;
using dspace::OrbitResult;
using dspace::OrbitView;
using dspace::Projection;
using Eigen::Vector3d;

using Button = InputEvent::Button;
using Key = InputEvent::Key;
using Type = InputEvent::Type;

// z = 20 sin(x / 30) cos(y / 40).
class Waves : public NavigationGround {
public:
  static double Height(const Vector3d& p) {
    return 20.0 * std::sin(p.x() / 30.0) * std::cos(p.y() / 40.0);
  }
  std::optional<Vector3d> Up(const Vector3d&) const override { return Vector3d::UnitZ(); }
  std::optional<Vector3d> Below(const Vector3d& p) const override {
    if (p.head<2>().norm() > 5000.0) {
      return std::nullopt;
    }
    return Vector3d(p.x(), p.y(), Height(p));
  }
};

// A sphere about the origin.
class Ball : public NavigationGround {
public:
  static constexpr double Radius = 1000.0;
  std::optional<Vector3d> Up(const Vector3d& p) const override { return p.normalized(); }
  std::optional<Vector3d> Below(const Vector3d& p) const override {
    return Radius * p.normalized();
  }
};

struct Hand {
  const NavigationGround& ground;
  OrbitView view;
  OrbitController controller;

  Hand(const NavigationGround& below, const Vector3d& eye, const Vector3d& target,
       const Vector3d& up)
      : ground(below) {
    this->view.camera.name = "hand";
    this->view.pose.frame = 1;
    this->view.pose.X_FC = dspace::LookAt("hand", eye, target, up);
    this->view.width = 640;
    this->view.height = 360;
    this->view.ground = &below;
  }
  OrbitResult Send(const InputEvent& event) {
    const OrbitResult result = this->controller.Handle(event, this->view);
    if (result.changed) {
      this->view.camera = result.camera;
      this->view.pose.X_FC = result.camera.mount.X_FC;
    }
    return result;
  }
  void Walks(double eyeHeight = 1.7, double speed = 1.5) {
    this->controller.SetNavigation({Navigation::Kind::Walk, eyeHeight, speed});
  }
  Vector3d Eye() const { return this->view.pose.X_FC.position; }
  Vector3d Axis(int i) const { return this->view.pose.X_FC.rotation * Vector3d::Unit(i); }
  double Height() const {
    return (this->Eye() - *this->ground.Below(this->Eye())).dot(*this->ground.Up(this->Eye()));
  }
  double Roll() const { return this->Axis(0).dot(*this->ground.Up(this->Eye())); }
  Projection::PixelPoint Pixel(const Vector3d& p_F) const {
    return this->view.camera.projection.Project(this->view.pose.X_FC.Inverse().Apply(p_F), 640,
                                                360);
  }
  // The first point of the ground on a pixel's ray, by bisection of small steps.
  std::optional<Vector3d> Under(double x, double y) const {
    const auto ray = this->view.camera.projection.PixelRay(x, y, 640, 360);
    const Vector3d direction = (this->view.pose.X_FC.rotation * ray.direction).normalized();
    const auto above = [&](double t) {
      const Vector3d p = this->Eye() + t * direction;
      const auto below = this->ground.Below(p);
      return !below || (p - *below).dot(*this->ground.Up(p)) > 0.0;
    };
    double t = 0.0;
    for (double step = 0.05; t < 5000.0; t += step, step *= 1.01) {
      if (!above(t + step)) {
        double low = t;
        double high = t + step;
        for (int i = 0; i < 60; ++i) {
          const double middle = 0.5 * (low + high);
          (above(middle) ? low : high) = middle;
        }
        return this->Eye() + low * direction;
      }
    }
    return std::nullopt;
  }
};

InputEvent Event(Type type, double x, double y, Button button = Button::None) {
  InputEvent event;
  event.type = type;
  event.x = x;
  event.y = y;
  event.button = button;
  return event;
}

InputEvent Press(Key key, double seconds = 0.1, bool shift = false) {
  InputEvent event = Event(Type::Key, 320, 180);
  event.key = key;
  event.seconds = seconds;
  event.shift = shift;
  return event;
}

// Random drags, wheels and keys. The eye stays above the ground, level, and what a drag or the
// wheel holds stays under the pointer; returns how often that was checked.
int Ramble(Hand& hand, double reach, int events) {
  std::mt19937 random(14);
  std::uniform_real_distribution<double> unit(0.0, 1.0);
  int held = 0;
  const dspace::Pose start = hand.view.pose.X_FC;
  for (int i = 0; i < events; ++i) {
    const double x = 640 * unit(random);
    const double y = 360 * unit(random);
    hand.view.pivot_F = hand.Under(x, y);
    const auto pivot = hand.view.pivot_F;
    const int what = int(6 * unit(random));
    double toX = x;
    double toY = y;
    if (what == 0) {
      InputEvent wheel = Event(Type::Wheel, x, y);
      wheel.wheelSteps = 8 * unit(random) - 4;
      hand.Send(wheel);
    } else if (what < 4) {
      const Button button = what == 1 ? Button::Left : what == 2 ? Button::Middle : Button::Right;
      hand.Send(Event(Type::Press, x, y, button));
      toX = x + 200 * (unit(random) - 0.5);
      toY = y + 200 * (unit(random) - 0.5);
      hand.Send(Event(Type::Move, toX, toY));
      hand.Send(Event(Type::Release, toX, toY, button));
      if (what != 2) { // only a pan takes the point along
        toX = x;
        toY = y;
      }
    } else if (what == 4) {
      hand.Send(Press(i % 2 ? Key::Down : Key::Up));
    } else {
      hand.Send(Event(Type::DoubleClick, x, y));
      toX = 319.5;
      toY = 179.5;
    }
    EXPECT_GE(hand.Height(), 0.1 - 1e-9) << "event " << i;
    EXPECT_NEAR(hand.Roll(), 0.0, 1e-6) << "event " << i;
    if (pivot && what != 4) {
      const auto pixel = hand.Pixel(*pivot);
      // Near the zenith and nadir no level camera may have it there.
      if (std::abs(hand.Axis(2).dot(*hand.ground.Up(hand.Eye()))) < 0.8 && pixel.visible &&
          (*pivot - hand.Eye()).norm() > 1.0) {
        EXPECT_NEAR(pixel.x, toX, 0.01) << "event " << i << " kind " << what;
        EXPECT_NEAR(pixel.y, toY, 0.01) << "event " << i << " kind " << what;
        ++held;
      }
    }
    if (::testing::Test::HasFailure()) {
      break;
    }
    if (hand.Eye().norm() > reach) { // back to where it began
      hand.view.pose.X_FC = start;
      hand.view.camera.mount.X_FC = start;
    }
  }
  return held;
}

} // namespace

TEST(Navigation, NeverUnderGroundAndLevelAboveWaves) {
  const Waves ground;
  Hand hand(ground, {0, -200, 80}, {0, 0, 0}, Vector3d::UnitZ());
  EXPECT_GE(Ramble(hand, 4000, 3000), 200);
}

TEST(Navigation, NeverUnderGroundAndLevelAboveASphere) {
  const Ball ground;
  Hand hand(ground, {0, -200, 1080}, {0, 0, 1000}, Vector3d::UnitZ());
  EXPECT_GE(Ramble(hand, 1300, 3000), 200); // within 300 m of the ground
}

TEST(Navigation, AWheelIntoTheGroundStopsAboveIt) {
  const Ball ground;
  Hand hand(ground, {0, 0, 1010}, {5, 0, 1000}, Vector3d::UnitY());
  hand.view.pivot_F = hand.Under(319.5, 179.5);
  for (int i = 0; i < 200; ++i) {
    InputEvent wheel = Event(Type::Wheel, 319.5, 179.5);
    wheel.wheelSteps = 1;
    hand.Send(wheel);
  }
  EXPECT_NEAR(hand.Height(), 0.1, 0.02);
}

TEST(Navigation, LevelAimTurnsTheRayToThePoint) {
  std::mt19937 random(3);
  std::normal_distribution<double> normal;
  int found = 0;
  for (int i = 0; i < 1000; ++i) {
    const Vector3d up = Vector3d(normal(random), normal(random), normal(random)).normalized();
    const Vector3d aim(normal(random), normal(random), normal(random));
    const Vector3d ray(0.5 * normal(random), 0.5 * normal(random), 1.0);
    const Eigen::Quaterniond before = Eigen::Quaterniond::UnitRandom();
    const auto R = dspace::LevelAim(before, ray, aim, up);
    const bool possible =
        std::abs(aim.normalized().dot(up)) < std::hypot(ray.y(), ray.z()) / ray.norm();
    if (!R) {
      continue;
    }
    ++found;
    EXPECT_TRUE(possible);
    EXPECT_LT((*R * ray.normalized() - aim.normalized()).norm(), 1e-9);
    EXPECT_NEAR((*R * Vector3d::UnitX()).dot(up), 0.0, 1e-12);
    EXPECT_LE((*R * Vector3d::UnitY()).dot(up), 1e-12);
  }
  EXPECT_GT(found, 600);
}

TEST(Navigation, AWalkGoesAtItsSpeedAtEyeHeight) {
  const Waves ground;
  Hand hand(ground, {10, 20, 100}, {11, 20, 100}, Vector3d::UnitZ());
  hand.Walks(1.7, 2.0);
  Vector3d at(10, 20, 0);
  for (int i = 0; i < 100; ++i) {
    hand.Send(Press(Key::Forward, 0.5));
    at.x() += 1.0;
    ASSERT_NEAR(hand.Eye().x(), at.x(), 1e-9);
    ASSERT_NEAR(hand.Eye().y(), at.y(), 1e-9);
    ASSERT_NEAR(hand.Eye().z(), Waves::Height(at) + 1.7, 1e-9);
    ASSERT_NEAR(hand.Roll(), 0.0, 1e-9);
  }
  hand.Send(Press(Key::StepRight, 0.5, true)); // four times as fast; right of +X is -Y
  EXPECT_NEAR(hand.Eye().y(), 16.0, 1e-9);
  hand.Send(Press(Key::Down, 0.25));
  EXPECT_NEAR(hand.Eye().x(), 109.5, 1e-9);
  hand.Send(Press(Key::Left, 1.0));
  EXPECT_NEAR(hand.Eye().y(), 18.0, 1e-9);
}

TEST(Navigation, AWalkAroundABallComesBack) {
  const Ball ground;
  Hand hand(ground, {0, 0, 1001.7}, {1, 0, 1001.7}, Vector3d::UnitZ());
  hand.Walks(1.7, 10.0);
  const double step = std::atan2(10.0, 1001.7); // of a tangent of 10 m, brought back to the ground
  const int steps = int(std::lround(6.283185307179586 / step));
  for (int i = 0; i < steps; ++i) {
    hand.Send(Press(Key::Up, 1.0));
    ASSERT_NEAR(hand.Eye().norm(), 1001.7, 1e-9);
    ASSERT_NEAR(hand.Eye().y(), 0.0, 1e-6);
    ASSERT_NEAR(hand.Axis(2).dot(hand.Eye().normalized()), 0.0, 1e-9);
  }
  const double angle = steps * step;
  EXPECT_NEAR(hand.Eye().x(), 1001.7 * std::sin(angle), 1e-6);
  EXPECT_NEAR(hand.Eye().z(), 1001.7 * std::cos(angle), 1e-6);
}

TEST(Navigation, ALookKeepsTheDirectionUnderThePointer) {
  const Waves ground;
  Hand hand(ground, {0, 0, 21.7}, {1, 1, 21}, Vector3d::UnitZ());
  hand.Walks();
  const Vector3d eye = hand.Eye();
  const auto ray = hand.view.camera.projection.PixelRay(100, 250, 640, 360);
  const Vector3d far = hand.view.pose.X_FC.Apply(1e3 * ray.direction);
  hand.Send(Event(Type::Press, 100, 250, Button::Left));
  hand.Send(Event(Type::Move, 350, 120));
  EXPECT_NEAR(hand.Pixel(far).x, 350, 1e-6);
  EXPECT_NEAR(hand.Pixel(far).y, 120, 1e-6);
  EXPECT_NEAR(hand.Roll(), 0.0, 1e-12);
  EXPECT_EQ(hand.Eye(), eye);
}

TEST(Navigation, AWalkEndsAtTheEdge) {
  const Waves ground;
  Hand hand(ground, {4990, 0, 30}, {4991, 0, 30}, Vector3d::UnitZ());
  hand.Walks(1.7, 3.0);
  for (int i = 0; i < 10; ++i) {
    hand.Send(Press(Key::Up, 1.0));
  }
  EXPECT_NEAR(hand.Eye().x(), 4999.0, 1e-9);
}

TEST(Navigation, EscapeReturnsToTheBeginningOfTheDrag) {
  const Waves ground;
  Hand hand(ground, {0, -200, 80}, {0, 0, 0}, Vector3d::UnitZ());
  const dspace::Pose before = hand.view.pose.X_FC;
  hand.view.camera.mount.X_FC = before;
  EXPECT_TRUE(hand.Send(Press(Key::Cancel)).unused);
  hand.Send(Event(Type::Press, 300, 200, Button::Left));
  hand.Send(Event(Type::Move, 400, 250));
  EXPECT_FALSE(hand.view.pose.X_FC == before);
  EXPECT_FALSE(hand.Send(Press(Key::Cancel)).unused);
  EXPECT_TRUE(hand.view.pose.X_FC == before);
  hand.Send(Event(Type::Move, 500, 300)); // the drag is over
  EXPECT_TRUE(hand.view.pose.X_FC == before);
}

TEST(Navigation, MapsDoNotTurn) {
  const Waves ground;
  Hand hand(ground, {0, 0, 500}, {0, 0, 0}, Vector3d::UnitY());
  hand.view.camera.projection.kind = Projection::Kind::Orthographic;
  hand.view.camera.projection.height = 360.0;
  hand.controller.SetNavigation({Navigation::Kind::Map, 1.7, 1.5});
  const Eigen::Quaterniond before = hand.view.pose.X_FC.rotation;
  hand.view.pivot_F = Vector3d(0, 0, 0);
  hand.Send(Event(Type::Press, 319.5, 179.5, Button::Left));
  hand.Send(Event(Type::Move, 349.5, 199.5)); // 1 m a pixel; the ground goes right and down
  hand.Send(Event(Type::Release, 349.5, 199.5, Button::Left));
  EXPECT_NEAR(hand.Eye().x(), -30, 1e-9);
  EXPECT_NEAR(hand.Eye().y(), 20, 1e-9);
  hand.view.pivot_F.reset(); // what was under the pointer is there no longer
  hand.Send(Press(Key::Right));
  EXPECT_NEAR(hand.Eye().x(), -12, 1e-9); // a twentieth of 360 m
  EXPECT_TRUE(hand.view.pose.X_FC.rotation.coeffs() == before.coeffs());
}

TEST(Navigation, BadSettingsAreRejected) {
  OrbitController controller;
  for (const Navigation& bad :
       {Navigation{Navigation::Kind::Walk, 0.0, 1.0}, Navigation{Navigation::Kind::Walk, 1.0, 1e7},
        Navigation{Navigation::Kind::Walk, std::nan(""), 1.0}}) {
    EXPECT_THROW(controller.SetNavigation(bad), dspace::Error);
  }
}
