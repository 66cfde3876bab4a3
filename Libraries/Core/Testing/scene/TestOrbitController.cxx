// Cameras moved by hand: what is under the pointer stays there, distances and the horizon hold.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/scene/controls/OrbitController.h>
#include <dspace/scene/controls/OrbitMotion.h>

namespace {

using dspace::BoundingSphere;
using dspace::Camera;
using dspace::CameraMount;
using dspace::InputEvent;
using dspace::OrbitController;
using dspace::OrbitResult;
using dspace::OrbitView;
using dspace::Pose;
using dspace::Projection;
using Eigen::Vector3d;

using Button = InputEvent::Button;
using Key = InputEvent::Key;
using Type = InputEvent::Type;

constexpr double Degree = 3.14159265358979323846 / 180.0;

InputEvent Event(Type type, double x, double y, Button button = Button::None, bool shift = false) {
  InputEvent event;
  event.type = type;
  event.x = x;
  event.y = y;
  event.button = button;
  event.shift = shift;
  return event;
}

InputEvent KeyPress(Key key) {
  InputEvent event = Event(Type::Key, 320, 180);
  event.key = key;
  return event;
}

InputEvent Wheel(double x, double y, double steps) {
  InputEvent event = Event(Type::Wheel, x, y);
  event.wheelSteps = steps;
  return event;
}

// A camera at (-10, -6, 4) that looks at the origin, in 640 × 360 pixels; applies what it is told.
struct Hand {
  OrbitView view;
  OrbitController controller;

  explicit Hand(Projection::Kind kind) {
    this->view.camera.name = "hand";
    Projection& p = this->view.camera.projection;
    p.kind = kind;
    if (kind == Projection::Kind::Orthographic) {
      p.farDistance = 1000;
    }
    if (kind == Projection::Kind::Frustum) {
      p.left = -0.2;
      p.right = 0.9;
      p.top = -0.3;
      p.bottom = 0.4;
    }
    this->view.pose.frame = 1;
    this->view.pose.X_FC = dspace::LookAt("hand", {-10, -6, 4}, {0, 0, 0}, {0, 0, 1});
    this->view.width = 640;
    this->view.height = 360;
  }
  OrbitResult Send(const InputEvent& event) {
    const OrbitResult result = this->controller.Handle(event, this->view);
    if (result.changed) {
      EXPECT_NO_THROW(result.camera.projection.Check("hand"));
      EXPECT_NO_THROW(result.camera.mount.Check("hand"));
      EXPECT_EQ(result.camera.mount.kind, CameraMount::Kind::Fixed);
      EXPECT_EQ(result.camera.mount.frame, this->view.pose.frame);
      EXPECT_EQ(result.camera.name, "hand");
      this->view.camera = result.camera;
      this->view.pose.X_FC = result.camera.mount.X_FC;
    }
    return result;
  }
  // The point on a pixel's ray at a depth, in F.
  Vector3d PointUnder(double x, double y, double depth) const {
    const auto ray = this->view.camera.projection.PixelRay(x, y, 640, 360);
    return this->view.pose.X_FC.Apply(ray.origin + ray.direction * (depth / ray.direction.z()));
  }
  Projection::PixelPoint Pixel(const Vector3d& p_F) const {
    return this->view.camera.projection.Project(this->view.pose.X_FC.Inverse().Apply(p_F), 640,
                                                360);
  }
  Vector3d Eye() const { return this->view.pose.X_FC.position; }
  Vector3d Axis(int i) const { return this->view.pose.X_FC.rotation * Vector3d::Unit(i); }
  double Elevation() const { return std::asin(std::clamp(this->Axis(2).z(), -1.0, 1.0)) / Degree; }
};

const auto AllKinds = {Projection::Kind::Perspective, Projection::Kind::Orthographic,
                       Projection::Kind::Frustum};

void ExpectPixel(const Hand& hand, const Vector3d& p_F, double x, double y) {
  const auto q = hand.Pixel(p_F);
  EXPECT_TRUE(q.visible);
  EXPECT_NEAR(q.x, x, 0.01);
  EXPECT_NEAR(q.y, y, 0.01);
}

} // namespace

TEST(Orbit, PanKeepsThePointUnderThePointer) {
  for (const auto kind : AllKinds) {
    for (const bool shiftLeft : {false, true}) {
      Hand hand(kind);
      const Button button = shiftLeft ? Button::Left : Button::Middle;
      const Vector3d point = hand.PointUnder(200, 100, 7.0);
      const Eigen::Quaterniond before = hand.view.pose.X_FC.rotation;
      hand.view.pivot_F = point;
      EXPECT_FALSE(hand.Send(Event(Type::Press, 200, 100, button, shiftLeft)).changed);
      hand.view.pivot_F.reset();
      for (const auto& to : {std::pair{230.0, 140.0}, {500.0, 20.0}, {-80.0, 400.0}}) {
        EXPECT_TRUE(hand.Send(Event(Type::Move, to.first, to.second)).changed);
        ExpectPixel(hand, point, to.first, to.second);
        EXPECT_NEAR(hand.Pixel(point).depth, 7.0, 1e-9);
      }
      EXPECT_EQ(hand.view.pose.X_FC.rotation.coeffs(), before.coeffs());
      hand.Send(Event(Type::Release, 0, 0, button));
      EXPECT_FALSE(hand.Send(Event(Type::Move, 10, 10)).changed);
    }
  }
}

TEST(Orbit, OrbitKeepsDistanceHorizonAndPixel) {
  for (const auto kind : AllKinds) {
    Hand hand(kind);
    const Vector3d pivot = hand.PointUnder(420, 250, 9.0);
    const double distance = (hand.Eye() - pivot).norm();
    hand.view.pivot_F = pivot;
    hand.Send(Event(Type::Press, 420, 250, Button::Left));
    double x = 420, y = 250;
    for (int i = 0; i < 200; ++i) {
      x += 7 * std::cos(0.3 * i);
      y += 5 * std::sin(0.2 * i);
      hand.Send(Event(Type::Move, x, y));
      ASSERT_NEAR((hand.Eye() - pivot).norm(), distance, 1e-9);
      ASSERT_NEAR(hand.Axis(0).z(), 0.0, 1e-9);
      ASSERT_LE(hand.Axis(1).z(), 1e-9); // the image's down never points up
      ExpectPixel(hand, pivot, 420, 250);
    }
  }
}

TEST(Orbit, DragTurnsByHand) {
  Hand hand(Projection::Kind::Perspective);
  hand.view.pose.X_FC = dspace::LookAt("hand", {0, -10, 0}, {0, 0, 0}, {0, 0, 1});
  hand.view.pivot_F = Vector3d(0, 0, 0);
  hand.Send(Event(Type::Press, 319.5, 179.5, Button::Left));
  // Half the image's height is a quarter turn; the near side follows the pointer to the right, so
  // the camera goes to the left: from south to west.
  hand.Send(Event(Type::Move, 319.5 + 180, 179.5));
  EXPECT_LT((hand.Eye() - Vector3d(-10, 0, 0)).norm(), 1e-9);
  // Down by a sixth of the height: the camera rises by 30°.
  hand.Send(Event(Type::Move, 319.5 + 180, 179.5 + 60));
  EXPECT_LT((hand.Eye() - Vector3d(-10 * std::cos(30 * Degree), 0, 5)).norm(), 1e-9);
  EXPECT_NEAR(hand.Elevation(), -30, 1e-9);
}

TEST(Orbit, StopsAtThePole) {
  for (const double direction : {1.0, -1.0}) {
    Hand hand(Projection::Kind::Perspective);
    hand.view.pivot_F = Vector3d(0, 0, 0);
    hand.Send(Event(Type::Press, 300, 100, Button::Left));
    double y = 100;
    for (int i = 0; i < 100; ++i) {
      y += 10 * direction;
      hand.Send(Event(Type::Move, 300, y));
      ASSERT_LE(hand.Axis(1).z(), 1e-9);
    }
    EXPECT_NEAR(hand.Elevation(), -90 * direction, 1e-4);
    const Vector3d right = hand.Axis(0);
    EXPECT_LT((hand.Eye() - Vector3d(0, 0, std::sqrt(152.0) * direction)).norm(), 1e-6);
    // Straight down is no dead end: it turns about the upright and comes back.
    hand.Send(Event(Type::Move, 300 + 180, y));
    EXPECT_NEAR(hand.Axis(0).dot(right), 0.0, 1e-9);
    hand.Send(Event(Type::Move, 300 + 180, y - 40 * direction));
    EXPECT_NEAR(hand.Elevation(), -70 * direction, 1e-4);
    EXPECT_NEAR(hand.Axis(0).z(), 0.0, 1e-9);
  }
}

TEST(Orbit, LevelsARolledCamera) {
  Hand hand(Projection::Kind::Perspective);
  hand.view.pose.X_FC.rotation =
      (hand.view.pose.X_FC.rotation * Eigen::AngleAxisd(0.7, Vector3d::UnitZ())).normalized();
  hand.view.pivot_F = Vector3d(0, 0, 0);
  const double distance = hand.Eye().norm();
  hand.Send(Event(Type::Press, 300, 100, Button::Left));
  hand.Send(Event(Type::Move, 310, 100));
  EXPECT_NEAR(hand.Axis(0).z(), 0.0, 1e-12);
  EXPECT_NEAR(hand.Eye().norm(), distance, 1e-9);
}

TEST(Orbit, DollyKeepsThePointedPixel) {
  for (const auto kind : AllKinds) {
    Hand hand(kind);
    const Vector3d pivot = hand.PointUnder(100, 300, 8.0);
    const double distance = (hand.Eye() - pivot).norm();
    const double height = hand.view.camera.projection.height;
    const bool flat = kind == Projection::Kind::Orthographic;
    hand.view.pivot_F = pivot;
    hand.Send(Wheel(100, 300, 2.0));
    ExpectPixel(hand, pivot, 100, 300);
    if (flat) {
      EXPECT_NEAR(hand.view.camera.projection.height, height / 1.44, 1e-12);
      EXPECT_NEAR(hand.Pixel(pivot).depth, 8.0, 1e-12);
    } else {
      EXPECT_NEAR((hand.Eye() - pivot).norm(), distance / 1.44, 1e-9);
    }
    hand.Send(Wheel(100, 300, -2.0)); // and back
    EXPECT_NEAR((hand.Eye() - pivot).norm(), distance, 1e-9);
    EXPECT_NEAR(hand.view.camera.projection.height, height, 1e-12);

    hand.Send(Event(Type::Press, 100, 300, Button::Right));
    hand.view.pivot_F.reset();
    for (int i = 1; i <= 20; ++i) {
      hand.Send(Event(Type::Move, 100, 300 - 5.0 * i));
      ExpectPixel(hand, pivot, 100, 300);
    }
    const double factor = std::pow(1.01, -100.0);
    if (flat) {
      EXPECT_NEAR(hand.view.camera.projection.height, height * factor, 1e-9);
    } else {
      EXPECT_NEAR((hand.Eye() - pivot).norm(), distance * factor, 1e-9);
    }
  }
}

TEST(Orbit, DollyStopsBeforeThePoint) {
  Hand hand(Projection::Kind::Perspective);
  const Vector3d pivot = hand.PointUnder(100, 300, 8.0);
  hand.view.pivot_F = pivot;
  for (int i = 0; i < 20; ++i) {
    hand.Send(Wheel(100, 300, 100.0));
  }
  EXPECT_NEAR(hand.Pixel(pivot).depth, 2.0 * hand.view.camera.projection.Near(), 1e-9);
  ExpectPixel(hand, pivot, 100, 300);
  for (int i = 0; i < 20; ++i) {
    hand.Send(Wheel(100, 300, -100.0));
  }
  EXPECT_NEAR(hand.Pixel(pivot).depth, 1e15, 1e3);
  Hand flat(Projection::Kind::Orthographic);
  for (int i = 0; i < 20; ++i) {
    flat.Send(Wheel(100, 300, 100.0));
  }
  EXPECT_DOUBLE_EQ(flat.view.camera.projection.height, 1e-9);
}

TEST(Orbit, AClickPicksAndMovesNothing) {
  Hand hand(Projection::Kind::Perspective);
  hand.view.pivot_F = Vector3d(0, 0, 0);
  hand.Send(Event(Type::Press, 50, 60, Button::Left));
  EXPECT_FALSE(hand.Send(Event(Type::Move, 52, 61)).changed); // a shaking hand
  const OrbitResult click = hand.Send(Event(Type::Release, 52, 61, Button::Left));
  EXPECT_TRUE(click.picked);
  EXPECT_FALSE(click.changed);
  EXPECT_EQ(click.x, 50.0);
  EXPECT_EQ(click.y, 60.0);
  hand.Send(Event(Type::Press, 50, 60, Button::Left));
  hand.Send(Event(Type::Move, 90, 60));
  EXPECT_FALSE(hand.Send(Event(Type::Release, 50, 60, Button::Left)).picked); // a drag
  hand.Send(Event(Type::Press, 50, 60, Button::Right));
  EXPECT_FALSE(hand.Send(Event(Type::Release, 50, 60, Button::Right)).picked);
  EXPECT_FALSE(hand.Send(Event(Type::Release, 50, 60, Button::Left)).picked); // nothing was down
}

TEST(Orbit, OneDragAtATime) {
  Hand hand(Projection::Kind::Perspective);
  const Vector3d point = hand.PointUnder(200, 100, 7.0);
  hand.view.pivot_F = point;
  hand.Send(Event(Type::Press, 200, 100, Button::Middle));
  hand.Send(Event(Type::Press, 200, 100, Button::Left)); // is ignored
  hand.Send(Event(Type::Release, 200, 100, Button::Left));
  hand.Send(Event(Type::Move, 260, 130));
  ExpectPixel(hand, point, 260, 130); // still pans
  hand.view.pose.frame = 7;           // another camera meanwhile
  EXPECT_FALSE(hand.Send(Event(Type::Move, 300, 130)).changed);
  hand.view.pose.frame = 1;
  EXPECT_FALSE(hand.Send(Event(Type::Move, 300, 130)).changed); // and the drag is over
}

TEST(Orbit, KeysTurnAndApproach) {
  Hand hand(Projection::Kind::Perspective);
  hand.view.pose.X_FC = dspace::LookAt("hand", {0, -10, 0}, {0, 0, 0}, {0, 0, 1});
  hand.view.pivot_F = Vector3d(0, 0, 0);
  const double s = std::sin(5 * Degree);
  const double c = std::cos(5 * Degree);
  hand.Send(KeyPress(Key::Right));
  EXPECT_LT((hand.Eye() - 10 * Vector3d(s, -c, 0)).norm(), 1e-9);
  hand.Send(KeyPress(Key::Left));
  EXPECT_LT((hand.Eye() - 10 * Vector3d(0, -1, 0)).norm(), 1e-9);
  hand.Send(KeyPress(Key::Up));
  EXPECT_LT((hand.Eye() - 10 * Vector3d(0, -c, s)).norm(), 1e-9);
  hand.Send(KeyPress(Key::Down));
  EXPECT_LT((hand.Eye() - 10 * Vector3d(0, -1, 0)).norm(), 1e-9);
  hand.Send(KeyPress(Key::Plus));
  EXPECT_NEAR(hand.Eye().norm(), 10 / 1.2, 1e-9);
  hand.Send(KeyPress(Key::Minus));
  EXPECT_NEAR(hand.Eye().norm(), 10, 1e-9);
  EXPECT_FALSE(hand.Send(KeyPress(Key::None)).changed);
}

TEST(Orbit, FramesASphere) {
  for (const auto kind : AllKinds) {
    for (const bool tall : {false, true}) {
      Hand hand(kind);
      hand.view.width = tall ? 200 : 640;
      hand.view.height = tall ? 500 : 360;
      const BoundingSphere sphere{{100, 50, -20}, 3.0};
      hand.view.bounds_F = sphere;
      const Eigen::Quaterniond before = hand.view.pose.X_FC.rotation;
      ASSERT_TRUE(hand.Send(KeyPress(Key::Frame)).changed);
      EXPECT_EQ(hand.view.pose.X_FC.rotation.coeffs(), before.coeffs());
      // The outline of the sphere by its points: inside the picture, and close to two borders.
      const Pose X_CF = hand.view.pose.X_FC.Inverse();
      Eigen::AlignedBox2d box;
      for (int i = 0; i < 20000; ++i) { // Fibonacci's lattice
        const double z = 1.0 - (2.0 * i + 1.0) / 20000.0;
        const double a = i * 2.399963229728653;
        const double r = std::sqrt(1.0 - z * z);
        const Vector3d p_F = sphere.center + 3.0 * Vector3d(r * std::cos(a), r * std::sin(a), z);
        const auto q =
            hand.view.camera.projection.Project(X_CF.Apply(p_F), hand.view.width, hand.view.height);
        ASSERT_TRUE(q.visible);
        ASSERT_GT(q.depth, hand.view.camera.projection.Near());
        box.extend(Eigen::Vector2d(q.x, q.y));
      }
      const double w = hand.view.width;
      const double h = hand.view.height;
      EXPECT_GT(box.min().x(), -0.5);
      EXPECT_GT(box.min().y(), -0.5);
      EXPECT_LT(box.max().x(), w - 0.5);
      EXPECT_LT(box.max().y(), h - 0.5);
      EXPECT_GT(std::max(box.sizes().x() / w, box.sizes().y() / h), 0.85);
      if (kind == Projection::Kind::Orthographic) {
        continue;
      }
      // As far from the left border's plane as from the right one's, and from the top's as from the
      // bottom's; from the nearer pair by the radius and its margin.
      const auto corner = [&](double x, double y) {
        return hand.view.camera.projection.PixelRay(x, y, hand.view.width, hand.view.height)
            .direction;
      };
      const Vector3d corners[] = {corner(-0.5, -0.5), corner(w - 0.5, -0.5),
                                  corner(w - 0.5, h - 0.5), corner(-0.5, h - 0.5)};
      const Vector3d center = X_CF.Apply(sphere.center);
      double away[4]; // top, right, bottom, left
      for (int k = 0; k < 4; ++k) {
        away[k] = std::abs(corners[k].cross(corners[(k + 1) % 4]).normalized().dot(center));
      }
      EXPECT_NEAR(away[0], away[2], 1e-9);
      EXPECT_NEAR(away[1], away[3], 1e-9);
      EXPECT_NEAR(std::min(away[0], away[1]), 1.05 * sphere.radius, 1e-9);
    }
  }
  Hand hand(Projection::Kind::Perspective);
  EXPECT_FALSE(hand.Send(KeyPress(Key::Frame)).changed); // nothing to frame
  hand.view.bounds_F = BoundingSphere{{0, 0, 0}, 0.0};
  EXPECT_THROW(hand.Send(KeyPress(Key::Frame)), dspace::Error);
}

TEST(Orbit, ResetGoesHome) {
  Hand hand(Projection::Kind::Orthographic);
  const Pose start = hand.view.pose.X_FC;
  hand.view.camera.mount.X_FC = start;
  hand.Send(Wheel(100, 100, 3));
  hand.Send(KeyPress(Key::Left));
  hand.Send(KeyPress(Key::Reset));
  EXPECT_EQ(hand.view.pose.X_FC, start);
  EXPECT_EQ(hand.view.camera.projection.height, 10.0);
  Camera home = hand.view.camera;
  home.mount.X_FC = dspace::LookAt("hand", {1, 1, 1}, {0, 0, 0}, {0, 0, 1});
  hand.controller.SetHome(home);
  hand.Send(KeyPress(Key::Reset));
  EXPECT_EQ(hand.Eye(), Vector3d(1, 1, 1));
  home.projection.height = -1;
  EXPECT_THROW(hand.controller.SetHome(home), dspace::Error);
}

TEST(Orbit, AChaseCameraComesLooseInItsParent) {
  Hand hand(Projection::Kind::Perspective);
  hand.view.camera.mount.kind = CameraMount::Kind::Chase;
  hand.view.camera.mount.frame = 5;
  hand.view.pose.frame = 3;
  hand.view.pivot_F = Vector3d(0, 0, 0);
  const OrbitResult result = hand.Send(Wheel(320, 180, 1)); // Send checks kind and frame
  EXPECT_TRUE(result.changed);
}

TEST(Orbit, PointsTakenWhereNoneIsGiven) {
  Hand hand(Projection::Kind::Perspective);
  // First at 10 m, or the depth of the bounds; then at the depth of the last one used.
  const Vector3d ten = hand.PointUnder(100, 90, 10.0);
  hand.Send(Event(Type::Press, 100, 90, Button::Middle));
  hand.Send(Event(Type::Move, 180, 120));
  ExpectPixel(hand, ten, 180, 120);
  hand.Send(Event(Type::Release, 180, 120, Button::Middle));

  hand.view.pivot_F = hand.PointUnder(10, 10, 33.0);
  hand.Send(Event(Type::Press, 10, 10, Button::Left));
  hand.Send(Event(Type::Release, 10, 10, Button::Left));
  hand.view.pivot_F.reset();
  const Vector3d last = hand.PointUnder(100, 90, 33.0);
  hand.Send(Event(Type::Press, 100, 90, Button::Middle));
  hand.Send(Event(Type::Move, 300, 300));
  ExpectPixel(hand, last, 300, 300);
  hand.Send(Event(Type::Release, 300, 300, Button::Middle));

  hand.view.pivot_F = hand.view.pose.X_FC.Apply({0, 0, -5}); // behind the camera: not used
  const Vector3d again = hand.PointUnder(100, 90, 33.0);
  hand.Send(Event(Type::Press, 100, 90, Button::Middle));
  hand.Send(Event(Type::Move, 300, 300));
  ExpectPixel(hand, again, 300, 300);

  Hand other(Projection::Kind::Perspective);
  other.view.bounds_F = BoundingSphere{other.PointUnder(320, 180, 21.0), 1.0};
  const Vector3d centre = other.PointUnder(100, 90, 21.0);
  other.Send(Event(Type::Press, 100, 90, Button::Middle));
  other.Send(Event(Type::Move, 200, 10));
  ExpectPixel(other, centre, 200, 10);
}

TEST(Orbit, NeedsAPointOnlyWhenADragBeginsOrAStepIsTaken) {
  EXPECT_TRUE(OrbitController::NeedsPivot(Event(Type::Press, 0, 0, Button::Left)));
  EXPECT_TRUE(OrbitController::NeedsPivot(Wheel(0, 0, 1)));
  EXPECT_TRUE(OrbitController::NeedsPivot(KeyPress(Key::Plus)));
  EXPECT_FALSE(OrbitController::NeedsPivot(KeyPress(Key::Reset)));
  EXPECT_FALSE(OrbitController::NeedsPivot(KeyPress(Key::Frame)));
  EXPECT_FALSE(OrbitController::NeedsPivot(Event(Type::Move, 0, 0)));
  EXPECT_FALSE(OrbitController::NeedsPivot(Event(Type::Release, 0, 0)));
}

TEST(Orbit, Rejections) {
  const double nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(OrbitController(Vector3d(0, 0, 0)), dspace::Error);
  EXPECT_THROW(OrbitController(Vector3d(nan, 0, 0)), dspace::Error);
  Hand hand(Projection::Kind::Perspective);
  EXPECT_THROW(hand.Send(Event(Type::Press, nan, 0, Button::Left)), dspace::Error);
  EXPECT_THROW(hand.Send(Wheel(0, 0, nan)), dspace::Error);
  hand.view.pivot_F = Vector3d(0, nan, 0);
  EXPECT_THROW(hand.Send(Wheel(0, 0, 1)), dspace::Error);
  hand.view.pivot_F.reset();
  hand.view.width = 0;
  EXPECT_THROW(hand.Send(Wheel(0, 0, 1)), dspace::Error);
}
