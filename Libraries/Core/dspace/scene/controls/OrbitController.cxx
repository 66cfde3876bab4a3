#include <dspace/scene/controls/OrbitController.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/scene/controls/OrbitMotion.h>

namespace dspace {

namespace {

constexpr double DegreesPerImageHeight = 180.0; // of an orbit drag
constexpr double KeyTurn_deg = 5.0;
constexpr double StepFactor = 1.2;    // of a wheel notch and a key
constexpr double DragFactor = 1.01;   // of a pixel of dolly drag
constexpr double ClickRadius = 3.0;   // pixels a hand may shake
constexpr double DefaultDepth = 10.0; // metres, where nothing else is known
constexpr double FramingMargin = 1.05;

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

void Dolly(OrbitResult& result, const OrbitView& view, const Eigen::Vector3d& pivot_F,
           double factor) {
  Pose X_FC = view.pose.X_FC;
  Projection projection = view.camera.projection;
  DollyTo(X_FC, projection, pivot_F, factor);
  SetMoved(result, view, X_FC, projection);
}

void Orbit(OrbitResult& result, const OrbitView& view, const Eigen::Vector3d& pivot_F,
           const Eigen::Vector3d& up_F, double turn_deg, double rise_deg) {
  SetMoved(result, view, OrbitAbout(view.pose.X_FC, pivot_F, up_F, turn_deg, rise_deg),
           view.camera.projection);
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

bool OrbitController::NeedsPivot(const InputEvent& event) {
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
      result.picked = this->Clicking_ && this->Drag_ == Drag::Orbit;
      if (this->Clicking_ && !result.picked && this->Drag_ != Drag::None) {
        result.clicked = event.button;
      }
      result.x = this->PressX_;
      result.y = this->PressY_;
      this->Drag_ = Drag::None;
      this->Button_ = Button::None;
    }
    break;
  case Type::Wheel:
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
    this->Drag_ = event.shift ? Drag::Pan : Drag::Orbit;
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
  this->Pivot_F_ = this->PivotFor(event, view);
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
    Orbit(result, view, this->Pivot_F_, this->Up_, -dx * degrees, -dy * degrees);
    break;
  case Drag::Pan:
    SetMoved(result, view,
             PanTo(view.pose.X_FC, view.camera.projection, this->Pivot_F_, event.x, event.y,
                   view.width, view.height),
             view.camera.projection);
    break;
  case Drag::Dolly:
    Dolly(result, view, this->Pivot_F_, std::pow(DragFactor, std::clamp(dy, -1e3, 1e3)));
    break;
  case Drag::None:
    break;
  }
}

void OrbitController::Key(const InputEvent& event, const OrbitView& view, OrbitResult& result) {
  if (event.key == Key::None) {
    return;
  }
  if (event.key == Key::Frame) {
    if (view.bounds_F) {
      const Camera framed = FrameSphere(view, *view.bounds_F);
      SetMoved(result, view, framed.mount.X_FC, framed.projection);
    }
    return;
  }
  if (event.key == Key::Reset) {
    result.changed = true;
    result.camera = *this->Home_;
    return;
  }
  const Eigen::Vector3d pivot_F = this->PivotFor(event, view);
  switch (event.key) {
  case Key::Left: // the camera goes left, the scene turns right
    Orbit(result, view, pivot_F, this->Up_, -KeyTurn_deg, 0.0);
    break;
  case Key::Right:
    Orbit(result, view, pivot_F, this->Up_, KeyTurn_deg, 0.0);
    break;
  case Key::Up:
    Orbit(result, view, pivot_F, this->Up_, 0.0, -KeyTurn_deg);
    break;
  case Key::Down:
    Orbit(result, view, pivot_F, this->Up_, 0.0, KeyTurn_deg);
    break;
  case Key::Plus:
    Dolly(result, view, pivot_F, 1.0 / StepFactor);
    break;
  default:
    Dolly(result, view, pivot_F, StepFactor);
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
