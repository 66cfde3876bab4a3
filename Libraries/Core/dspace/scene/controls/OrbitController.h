// A camera moved by hand: orbit, pan, dolly, walk, focus, frame, reset, and clicks that pick.
#ifndef DSPACE_SCENE_ORBIT_CONTROLLER_H
#define DSPACE_SCENE_ORBIT_CONTROLLER_H

#include <optional>

#include <dspace/scene/Camera.h>
#include <dspace/scene/GraphicsObject.h>
#include <dspace/scene/controls/InputEvent.h>
#include <dspace/scene/controls/Navigation.h>

namespace dspace {

// State of a viewport at the time of an event. F is pose.frame.
struct OrbitView {
  Camera camera;   // as it is now
  CameraPose pose; // where it stands (PlaceCamera): X_FC
  int width = 1;   // pixels
  int height = 1;
  std::optional<Eigen::Vector3d> pivot_F;   // the point under the pointer; used when NeedsPivot()
  std::optional<BoundingSphere> bounds_F;   // what the F key frames
  const NavigationGround* ground = nullptr; // null: there is none
};

struct OrbitResult {
  bool changed = false;
  Camera camera;       // when changed: the mount is Fixed in F, so that a chase camera comes loose
  bool picked = false; // a left click (no drag): pick the pixel (x, y)
  double x = 0.0;
  double y = 0.0;
  // A click of another button, or with Shift; pixel as above. None: there was none.
  InputEvent::Button clicked = InputEvent::Button::None;
  bool unused = false; // a key that means nothing now
};

// Left drag orbits about the point under the pointer; right is +X of the picture, and the horizon
// stays level: turns are about F's `up` and the camera's own X axis, and stop at straight up and
// straight down. Middle drag, or left with Shift, pans: the point grabbed stays under the pointer.
// Wheel and right drag (up: nearer) go towards the point under the pointer, which keeps its pixel;
// an orthographic camera changes its height instead. Arrow keys orbit by 5°, + and - go nearer and
// farther by a fifth, both about the point under the pointer; Frame shows bounds_F whole, Reset
// returns to the home camera.
// If there is no point under the pointer, the controller uses the point on the pointer's ray at the
// depth of the last pivot (initially the depth of the bounds' centre, or 10 m).
// A double click turns the camera so that the point under the pointer comes to the middle of the
// picture, of an orthographic camera with a move; the point's depth is then that of the last pivot.
// Cancel (Escape) during a drag returns to the camera at its beginning.
//
// Above ground (OrbitView::ground, not for orthographic cameras): `up` is the local vertical at the
// eye. After each of these motions the eye is at least 0.1 m, or the near distance, above the
// ground, and the camera is level; the point under the pointer still keeps its pixel (where no
// level camera can do that, the line of sight is kept).
//
// Walk: the eye is at the eye height above the ground. Up, Down or Forward, Backward walk, Left,
// Right or StepLeft, StepRight step sideways at the walking speed, four times as fast with Shift;
// without ground, in the level plane of the eye. A drag of any button looks around: the direction
// grabbed stays under the pointer. A notch of the wheel walks for half a second. An orthographic
// camera cannot walk: it orbits.
// Map: left drag pans, arrow keys move by a twentieth of the picture's height; nothing turns.
class OrbitController {
public:
  static constexpr double StepFactor = 1.2; // nearer by a notch of the wheel or a key

  // `up` in F, any length but 0. Throws Error(InvalidArgument).
  explicit OrbitController(const Eigen::Vector3d& up = Eigen::Vector3d::UnitZ());

  // Sets the camera that Reset returns to; default: the camera at the first event. A home camera in
  // another frame moves the camera to that frame.
  void SetHome(const Camera& camera);

  // Ends a drag if the kind is another. Throws Error(InvalidArgument).
  void SetNavigation(const Navigation& navigation);

  // Whether `event` uses OrbitView::pivot_F. If not, the caller need not pick.
  static bool NeedsPivot(const InputEvent& event, Navigation::Kind kind = Navigation::Kind::Orbit);

  // Throws Error(InvalidArgument) naming the camera for a size below 1 × 1 or a value that is not
  // finite; nothing has changed then.
  OrbitResult Handle(const InputEvent& event, const OrbitView& view);

  // The camera moved so that it shows the sphere whole in the middle of its picture, looking the
  // way it looks now: 5 % smaller than it could be, and behind the near plane. Throws
  // Error(InvalidArgument) for a radius that is not positive and finite.
  static Camera FrameSphere(const OrbitView& view, const BoundingSphere& sphere_F);

private:
  enum class Drag { None, Orbit, Pan, Dolly, Look };
  Eigen::Vector3d PivotFor(const InputEvent& event, const OrbitView& view);
  void Press(const InputEvent& event, const OrbitView& view);
  void Move(const InputEvent& event, const OrbitView& view, OrbitResult& result);
  void Key(const InputEvent& event, const OrbitView& view, OrbitResult& result);
  void Focus(const InputEvent& event, const OrbitView& view, OrbitResult& result);
  void Walk(const OrbitView& view, double forward, double right, OrbitResult& result) const;
  bool Walks(const OrbitView& view) const;
  Eigen::Vector3d UpAt(const OrbitView& view) const;

  Eigen::Vector3d Up_; // unit, in F
  Navigation Navigation_;
  std::optional<Camera> Home_;
  double Depth_ = 0.0; // of the last pivot [m]; 0 before the first
  Drag Drag_ = Drag::None;
  InputEvent::Button Button_ = InputEvent::Button::None;
  FrameId Frame_ = NoFrame;                           // in which the drag's pivot is
  Eigen::Vector3d Pivot_F_ = Eigen::Vector3d::Zero(); // Look: the direction grabbed
  Camera Pressed_;                                    // when the drag began
  double PressX_ = 0.0, PressY_ = 0.0;                // where the button went down
  double LastX_ = 0.0, LastY_ = 0.0;                  // where the last event was
  bool Picks_ = false;                                // a click picks
  bool Clicking_ = false;                             // the pointer has not left the press point
};

} // namespace dspace

#endif
