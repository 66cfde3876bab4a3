#include <dspace/scene/controls/OrbitController.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/scene/controls/GroundMotion.h>
#include <dspace/scene/controls/OrbitMotion.h>

namespace dspace {

namespace {

constexpr double DegreesPerImageHeight = 180.0; // of an orbit drag
constexpr double KeyTurn_deg = 5.0;
constexpr double DragFactor = 1.01;   // of a pixel of dolly drag
constexpr double ClickRadius = 3.0;   // pixels a hand may shake
constexpr double DefaultDepth = 10.0; // metres, where nothing else is known
constexpr double FramingMargin = 1.05;
constexpr double KeySeconds = 0.1;     // of a key without a duration
constexpr double LeastClearance = 0.1; // metres above the ground
constexpr double HasteFactor = 4.0;    // of a walk with Shift
constexpr double NotchSeconds = 0.5;   // of a walk
constexpr double MapStep = 0.05;       // of the picture's height

using Key = InputEvent::Key;
using Type = InputEvent::Type;
using Button = InputEvent::Button;

void SetMoved(OrbitResult& result, const OrbitView& view, const Pose& X_FC,
              const Projection& projection) {
  if (X_FC == view.pose.X_FC && projection.height == view.camera.projection.height) {
    return;
  }
  result.changed = true;
  result.camera = view.camera;
  result.camera.projection = projection;
  result.camera.mount = CameraMount();
  result.camera.mount.frame = view.pose.frame;
  result.camera.mount.X_FC = X_FC;
}

// What has moved is above the ground and level, and shows `pivot_F` along `ray_C`.
void Settle(OrbitResult& result, const OrbitView& view, const Eigen::Vector3d& pivot_F,
            const Eigen::Vector3d& ray_C) {
  const Projection& projection = view.camera.projection;
  if (!result.changed || !view.ground || projection.kind == Projection::Kind::Orthographic) {
    return;
  }
  Pose& X_FC = result.camera.mount.X_FC;
  X_FC.position =
      AboveGround(*view.ground, X_FC.position, std::max(LeastClearance, projection.Near()));
  if (const auto up = view.ground->Up(X_FC.position)) {
    const auto aimed = LevelAim(X_FC.rotation, ray_C, pivot_F - X_FC.position, *up);
    X_FC.rotation = aimed ? *aimed : LevelSight(X_FC.rotation, *up);
  }
}

Eigen::Vector3d RayTo(const OrbitView& view, const Eigen::Vector3d& p_F) {
  return view.pose.X_FC.Inverse().Apply(p_F);
}

void Dolly(OrbitResult& result, const OrbitView& view, const Eigen::Vector3d& pivot_F,
           double factor) {
  Pose X_FC = view.pose.X_FC;
  Projection projection = view.camera.projection;
  DollyTo(X_FC, projection, pivot_F, factor);
  SetMoved(result, view, X_FC, projection);
  Settle(result, view, pivot_F, RayTo(view, pivot_F));
}

void Pan(OrbitResult& result, const OrbitView& view, const Eigen::Vector3d& point_F, double x,
         double y) {
  const Projection& projection = view.camera.projection;
  SetMoved(result, view, PanTo(view.pose.X_FC, projection, point_F, x, y, view.width, view.height),
           projection);
  Settle(result, view, point_F, projection.PixelRay(x, y, view.width, view.height).direction);
}

void Orbit(OrbitResult& result, const OrbitView& view, const Eigen::Vector3d& pivot_F,
           const Eigen::Vector3d& up_F, double turn_deg, double rise_deg) {
  SetMoved(result, view, OrbitAbout(view.pose.X_FC, pivot_F, up_F, turn_deg, rise_deg),
           view.camera.projection);
  Settle(result, view, pivot_F, RayTo(view, pivot_F));
}

void CheckInput(const InputEvent& event, const OrbitView& view) {
  const std::string object = "camera '" + view.camera.name + "'";
  if (view.width < 1 || view.height < 1) {
    Reject(object, "its picture is " + std::to_string(view.width) + " x " +
                       std::to_string(view.height) + " pixels; accepted: 1 x 1 and more");
  }
  RequireFinite(object, "pointer x", event.x);
  RequireFinite(object, "pointer y", event.y);
  RequireFinite(object, "wheel steps", event.wheelSteps);
  Require(event.seconds >= 0.0 && event.seconds <= 1.0, object, "the time that a key was held",
          event.seconds, "0 to 1 second");
  if (view.pivot_F) {
    RequireFinite(object, "pivot", *view.pivot_F);
  }
}

} // namespace

OrbitController::OrbitController(const Eigen::Vector3d& up) : Up_(up.stableNormalized()) {
  if (!up.allFinite() || up.isZero(0.0)) {
    Reject("orbit controller", "up is " + VectorText(up) + "; accepted: a direction");
  }
}

void OrbitController::SetHome(const Camera& camera) {
  camera.projection.Check(camera.name);
  camera.mount.Check(camera.name);
  this->Home_ = camera;
}

void OrbitController::SetNavigation(const Navigation& navigation) {
  navigation.Check("navigation");
  if (navigation.kind != this->Navigation_.kind) {
    this->Drag_ = Drag::None;
    this->Button_ = Button::None;
  }
  this->Navigation_ = navigation;
}

bool OrbitController::Walks(const OrbitView& view) const {
  return this->Navigation_.kind == Navigation::Kind::Walk &&
         view.camera.projection.kind != Projection::Kind::Orthographic;
}

Eigen::Vector3d OrbitController::UpAt(const OrbitView& view) const {
  const auto up = view.ground ? view.ground->Up(view.pose.X_FC.position) : std::nullopt;
  return up.value_or(this->Up_);
}

bool OrbitController::NeedsPivot(const InputEvent& event, Navigation::Kind kind) {
  if (event.type == Type::DoubleClick) {
    return true;
  }
  if (kind == Navigation::Kind::Walk) {
    return false;
  }
  if (event.type == Type::Key && (event.key == Key::Cancel || event.key >= Key::Forward)) {
    return false;
  }
  return event.type == Type::Press || event.type == Type::Wheel ||
         (event.type == Type::Key && event.key != Key::Frame && event.key != Key::Reset &&
          event.key != Key::None);
}

OrbitResult OrbitController::Handle(const InputEvent& event, const OrbitView& view) {
  CheckInput(event, view);
  if (!this->Home_) {
    this->Home_ = view.camera;
  }
  OrbitResult result;
  switch (event.type) {
  case Type::Press:
    if (this->Drag_ == Drag::None) {
      this->Press(event, view);
    }
    break;
  case Type::Move:
    this->Move(event, view, result);
    break;
  case Type::Release:
    if (event.button == this->Button_) {
      result.picked = this->Clicking_ && this->Drag_ != Drag::None && this->Picks_;
      if (this->Clicking_ && !result.picked && this->Drag_ != Drag::None) {
        result.clicked = event.button;
      }
      result.x = this->PressX_;
      result.y = this->PressY_;
      this->Drag_ = Drag::None;
      this->Button_ = Button::None;
    }
    break;
  case Type::DoubleClick:
    this->Focus(event, view, result);
    break;
  case Type::Wheel:
    if (this->Walks(view)) {
      this->Walk(view,
                 std::clamp(event.wheelSteps, -100.0, 100.0) * NotchSeconds *
                     this->Navigation_.walkSpeed,
                 0.0, result);
      break;
    }
    Dolly(result, view, this->PivotFor(event, view),
          std::pow(StepFactor, -std::clamp(event.wheelSteps, -100.0, 100.0)));
    break;
  case Type::Key:
    this->Key(event, view, result);
    break;
  }
  return result;
}

Eigen::Vector3d OrbitController::PivotFor(const InputEvent& event, const OrbitView& view) {
  const Projection& projection = view.camera.projection;
  const bool pointed = projection.kind != Projection::Kind::Orthographic;
  const Pose X_CF = view.pose.X_FC.Inverse();
  if (view.pivot_F) {
    const double depth = X_CF.Apply(*view.pivot_F).z();
    if (!pointed || depth > 0.0) {
      this->Depth_ = depth;
      return *view.pivot_F;
    }
  }
  double depth = this->Depth_;
  if (depth == 0.0 && view.bounds_F) {
    depth = X_CF.Apply(view.bounds_F->center).z();
  }
  if (!(depth > 0.0) && pointed) {
    depth = std::max(DefaultDepth, 2.0 * projection.Near());
  }
  const Projection::Ray ray = projection.PixelRay(event.x, event.y, view.width, view.height);
  return view.pose.X_FC.Apply(ray.origin + ray.direction * (depth / ray.direction.z()));
}

void OrbitController::Press(const InputEvent& event, const OrbitView& view) {
  switch (event.button) {
  case Button::None:
    return;
  case Button::Left:
    this->Drag_ =
        event.shift || this->Navigation_.kind == Navigation::Kind::Map ? Drag::Pan : Drag::Orbit;
    break;
  case Button::Middle:
    this->Drag_ = Drag::Pan;
    break;
  case Button::Right:
    this->Drag_ = Drag::Dolly;
    break;
  }
  this->Button_ = event.button;
  this->Frame_ = view.pose.frame;
  this->Pressed_ = view.camera;
  if (this->Walks(view)) {
    this->Drag_ = Drag::Look;
    this->Pivot_F_ =
        view.pose.X_FC.rotation *
        view.camera.projection.PixelRay(event.x, event.y, view.width, view.height).direction;
  } else {
    this->Pivot_F_ = this->PivotFor(event, view);
  }
  this->Picks_ = event.button == Button::Left && !event.shift;
  this->PressX_ = this->LastX_ = event.x;
  this->PressY_ = this->LastY_ = event.y;
  this->Clicking_ = true;
}

void OrbitController::Move(const InputEvent& event, const OrbitView& view, OrbitResult& result) {
  if (this->Drag_ == Drag::None) {
    return;
  }
  if (view.pose.frame != this->Frame_) { // another camera since: its points do not apply here
    this->Drag_ = Drag::None;
    this->Button_ = Button::None;
    return;
  }
  if (this->Clicking_ &&
      std::hypot(event.x - this->PressX_, event.y - this->PressY_) <= ClickRadius) {
    return;
  }
  this->Clicking_ = false;
  const double dx = event.x - this->LastX_;
  const double dy = event.y - this->LastY_;
  this->LastX_ = event.x;
  this->LastY_ = event.y;
  const double degrees = DegreesPerImageHeight / view.height;
  switch (this->Drag_) {
  case Drag::Orbit: // the scene follows the pointer, so the camera goes the other way
    Orbit(result, view, this->Pivot_F_, this->UpAt(view), -dx * degrees, -dy * degrees);
    break;
  case Drag::Pan:
    Pan(result, view, this->Pivot_F_, event.x, event.y);
    break;
  case Drag::Look: {
    const auto aimed = LevelAim(
        view.pose.X_FC.rotation,
        view.camera.projection.PixelRay(event.x, event.y, view.width, view.height).direction,
        this->Pivot_F_, this->UpAt(view));
    if (aimed) {
      Pose X_FC = view.pose.X_FC;
      X_FC.rotation = *aimed;
      SetMoved(result, view, X_FC, view.camera.projection);
    }
    break;
  }
  case Drag::Dolly:
    Dolly(result, view, this->Pivot_F_, std::pow(DragFactor, std::clamp(dy, -1e3, 1e3)));
    break;
  case Drag::None:
    break;
  }
}

void OrbitController::Walk(const OrbitView& view, double forward, double right,
                           OrbitResult& result) const {
  SetMoved(result, view,
           WalkStep(view.pose.X_FC, view.ground, this->UpAt(view), forward, right,
                    this->Navigation_.eyeHeight),
           view.camera.projection);
}

void OrbitController::Focus(const InputEvent& event, const OrbitView& view, OrbitResult& result) {
  const Eigen::Vector3d point_F = this->PivotFor(event, view);
  const Projection& projection = view.camera.projection;
  const double x = 0.5 * (view.width - 1);
  const double y = 0.5 * (view.height - 1);
  if (projection.kind == Projection::Kind::Orthographic) {
    Pan(result, view, point_F, x, y);
    return;
  }
  Pose X_FC = view.pose.X_FC;
  const Eigen::Vector3d middle = projection.PixelRay(x, y, view.width, view.height).direction;
  const auto aimed = LevelAim(X_FC.rotation, middle, point_F - X_FC.position, this->UpAt(view));
  if (aimed) {
    X_FC.rotation = *aimed;
    SetMoved(result, view, X_FC, projection);
    Settle(result, view, point_F, middle);
  }
}

void OrbitController::Key(const InputEvent& event, const OrbitView& view, OrbitResult& result) {
  if (event.key == Key::None) {
    result.unused = true;
    return;
  }
  if (event.key == Key::Cancel) {
    result.unused = this->Drag_ == Drag::None;
    if (!result.unused) {
      result.changed = !this->Clicking_;
      result.camera = this->Pressed_;
      this->Drag_ = Drag::None;
      this->Button_ = Button::None;
    }
    return;
  }
  if (event.key == Key::Reset) {
    result.changed = true;
    result.camera = *this->Home_;
    return;
  }
  if (this->Walks(view)) {
    const double distance =
        this->Navigation_.walkSpeed * event.seconds * (event.shift ? HasteFactor : 1.0);
    const bool ahead = event.key == Key::Up || event.key == Key::Forward;
    const bool back = event.key == Key::Down || event.key == Key::Backward;
    const bool left = event.key == Key::Left || event.key == Key::StepLeft;
    const bool right = event.key == Key::Right || event.key == Key::StepRight;
    if (ahead || back || left || right) {
      this->Walk(view, distance * (int(ahead) - int(back)), distance * (int(right) - int(left)),
                 result);
      return;
    }
    if (event.key != Key::Frame) {
      return; // nearer and farther mean nothing
    }
  }
  if (event.key >= Key::Forward) {
    result.unused = true;
    return;
  }
  if (event.key == Key::Frame) {
    if (view.bounds_F) {
      const Camera framed = FrameSphere(view, *view.bounds_F);
      SetMoved(result, view, framed.mount.X_FC, framed.projection);
      Settle(result, view, view.bounds_F->center,
             framed.mount.X_FC.Inverse().Apply(view.bounds_F->center));
    }
    return;
  }
  const Eigen::Vector3d pivot_F = this->PivotFor(event, view);
  const double share = event.seconds / KeySeconds;
  const auto move = [&](double across, double down) {
    if (this->Navigation_.kind != Navigation::Kind::Map) {
      Orbit(result, view, pivot_F, this->UpAt(view), across * KeyTurn_deg * share,
            down * KeyTurn_deg * share);
      return;
    }
    const double step = MapStep * view.height * share; // the picture goes the other way
    Pan(result, view, pivot_F, event.x - across * step, event.y - down * step);
  };
  switch (event.key) {
  case Key::Left: // the camera goes left, the scene turns right
    move(-1.0, 0.0);
    break;
  case Key::Right:
    move(1.0, 0.0);
    break;
  case Key::Up:
    move(0.0, -1.0);
    break;
  case Key::Down:
    move(0.0, 1.0);
    break;
  case Key::Plus:
    Dolly(result, view, pivot_F, std::pow(StepFactor, -share));
    break;
  default:
    Dolly(result, view, pivot_F, std::pow(StepFactor, share));
    break;
  }
}

Camera OrbitController::FrameSphere(const OrbitView& view, const BoundingSphere& sphere_F) {
  const std::string object = "camera '" + view.camera.name + "'";
  Require(sphere_F.radius > 0.0 && std::isfinite(sphere_F.radius), object, "radius to frame",
          sphere_F.radius, "a positive number of metres");
  RequireFinite(object, "centre to frame", sphere_F.center);
  Camera camera = view.camera;
  Projection& projection = camera.projection;
  const double r = FramingMargin * sphere_F.radius;
  const auto ray = [&](double x, double y) {
    return projection.PixelRay(x, y, view.width, view.height);
  };
  Eigen::Vector3d p_C = Eigen::Vector3d::Zero(); // where the sphere's centre is to come
  if (projection.kind == Projection::Kind::Orthographic) {
    projection.height = 2.0 * r * std::max(1.0, double(view.height) / view.width);
    p_C.z() = projection.Near() + 2.0 * r;
    if (projection.farDistance) {
      p_C.z() = std::min(p_C.z(), 0.5 * (projection.Near() + *projection.farDistance));
    }
  } else {
    // Tangents a < b of opposite borders, at angles with cosines ca, cb from Z. The centre, on
    // their bisector, is r away from both at z (b - a) = r / ca + r / cb.
    const Eigen::Vector3d low = ray(-0.5, -0.5).direction;
    const Eigen::Vector3d high = ray(view.width - 0.5, view.height - 0.5).direction;
    const Eigen::Array2d a = low.head<2>().array() / low.z();
    const Eigen::Array2d b = high.head<2>().array() / high.z();
    const Eigen::Array2d ca = (1.0 + a.square()).rsqrt();
    const Eigen::Array2d cb = (1.0 + b.square()).rsqrt();
    const double z = (r * (1.0 / ca + 1.0 / cb) / (b - a)).maxCoeff();
    p_C.z() = std::max(z, r + projection.Near());
    p_C.head<2>() = p_C.z() * (a * ca + b * cb) / (ca + cb);
  }
  camera.mount = CameraMount();
  camera.mount.frame = view.pose.frame;
  camera.mount.X_FC = view.pose.X_FC;
  camera.mount.X_FC.position = sphere_F.center - view.pose.X_FC.rotation * p_C;
  return camera;
}

} // namespace dspace
