#include <dspace/scene/Camera.h>

#include <cmath>

#include <dspace/Checks.h>
#include <dspace/FrameRules.h>

namespace dspace {

namespace {

constexpr double Parallel = 1e-9; // sine of the angle below which directions count as parallel

// C's axes (X right, Y down, Z forward) as columns; false when `up` is along the line of sight.
bool AxesLookingAlong(const Eigen::Vector3d& forward, const Eigen::Vector3d& up,
                      Eigen::Matrix3d& axes) {
  const Eigen::Vector3d z = forward.stableNormalized();
  const Eigen::Vector3d right = z.cross(up.stableNormalized());
  if (!(right.norm() >= Parallel)) {
    return false;
  }
  axes.col(0) = right.normalized();
  axes.col(1) = z.cross(axes.col(0)).normalized();
  axes.col(2) = z;
  return true;
}

// Rotation about Z by the heading of q_PF (see Camera.h).
Eigen::Matrix3d HeadingOf(const Eigen::Matrix3d& R_PF) {
  Eigen::Vector3d x = R_PF.col(0);
  if (std::hypot(x.x(), x.y()) < Parallel) {
    x = x.z() > 0.0 ? Eigen::Vector3d(-R_PF.col(2)) : Eigen::Vector3d(R_PF.col(2));
  }
  return Eigen::AngleAxisd(std::atan2(x.y(), x.x()), Eigen::Vector3d::UnitZ()).toRotationMatrix();
}

// The same about a unit vector v of P: its Z is v, and its X is across v.
Eigen::Matrix3d HeadingAbout(const Eigen::Vector3d& v, const Eigen::Matrix3d& R_PF) {
  const auto across = [&v](const Eigen::Vector3d& x) { return Eigen::Vector3d(x - x.dot(v) * v); };
  Eigen::Vector3d x = across(R_PF.col(0));
  if (x.norm() < Parallel) {
    x = R_PF.col(0).dot(v) > 0.0 ? across(-R_PF.col(2)) : across(R_PF.col(2));
  }
  Eigen::Matrix3d axes;
  axes.col(0) = x.normalized();
  axes.col(1) = v.cross(axes.col(0));
  axes.col(2) = v;
  return axes;
}

// The local vertical at the followed frame's origin, in its parent; unit.
Eigen::Vector3d VerticalOf(const CameraMount& mount, const FrameTree& frames) {
  const Pose X_PA = frames.RelativePose(frames.Parent(mount.frame), mount.aim);
  if (mount.vertical == CameraMount::Vertical::Axis) {
    return X_PA.rotation * Eigen::Vector3d::UnitZ();
  }
  const Eigen::Vector3d away = frames.LocalPose(mount.frame).position - X_PA.position;
  return away.isZero(0.0) ? Eigen::Vector3d::UnitZ() : away.stableNormalized();
}

Eigen::Matrix3d OffsetAxes(CameraMount::ChaseAxes axes, const Eigen::Matrix3d& R_PF) {
  switch (axes) {
  case CameraMount::ChaseAxes::Followed:
    return R_PF;
  case CameraMount::ChaseAxes::Heading:
    return HeadingOf(R_PF);
  case CameraMount::ChaseAxes::Parent:
    break;
  }
  return Eigen::Matrix3d::Identity();
}

bool Continues(const ChaseState& state, double time_s, double smoothing_s, FrameId frame,
               FrameId parent) {
  return state.started && state.frame == frame && state.parent == parent &&
         time_s >= state.time_s && smoothing_s > 0.0;
}

// Advances the lag to `time_s`, when the camera should be at `wanted`.
void Advance(ChaseState& state, double time_s, double smoothing_s, FrameId frame, FrameId parent,
             const Eigen::Vector3d& wanted) {
  if (Continues(state, time_s, smoothing_s, frame, parent)) {
    const double left = std::exp(-(time_s - state.time_s) / smoothing_s);
    state.p_PC = wanted + left * (state.p_PC - wanted);
  } else {
    state.p_PC = wanted;
  }
  state.started = true;
  state.time_s = time_s;
  state.frame = frame;
  state.parent = parent;
}

// Advances the lag of a direction to `time_s`, when it should be `wanted` (unit).
void AdvanceDirection(ChaseState& state, double time_s, double smoothing_s, FrameId frame,
                      FrameId aim, const Eigen::Vector3d& wanted) {
  Eigen::Vector3d now = wanted;
  if (Continues(state, time_s, smoothing_s, frame, aim) && state.p_PC.norm() > 0.5) {
    const Eigen::Vector3d old = state.p_PC.normalized();
    Eigen::Vector3d axis = wanted.cross(old);
    const double angle = std::atan2(axis.norm(), wanted.dot(old));
    if (axis.norm() < Parallel) { // of opposite directions: any axis across them
      axis = wanted.unitOrthogonal();
    }
    const double left = angle * std::exp(-(time_s - state.time_s) / smoothing_s);
    now = Eigen::AngleAxisd(left, axis.normalized()) * wanted;
  }
  state = {true, time_s, frame, aim, now};
}

CameraPose PlacePointing(const CameraMount& mount, const std::string& object,
                         const FrameTree& frames, double time_s, ChaseState& state) {
  for (const FrameId frame : {mount.frame, mount.aim}) {
    if (!frames.Contains(frame)) {
      throw Error(Error::Kind::NotFound, object,
                  "frame " + std::to_string(frame) + " is not in the tree");
    }
  }
  const Eigen::Vector3d& eye = mount.X_FC.position;
  const Eigen::Vector3d target = frames.RelativePose(mount.frame, mount.aim).Apply(mount.target);
  Eigen::Vector3d sight = target - eye;
  const bool there = sight.norm() <= 1e-15 * (target.norm() + eye.norm());
  if (!there) {
    sight = sight.stableNormalized();
  } else if (Continues(state, time_s, mount.smoothing_s, mount.frame, mount.aim)) {
    sight = state.p_PC;
  } else {
    sight = Eigen::Vector3d::UnitX();
  }
  AdvanceDirection(state, time_s, mount.smoothing_s, mount.frame, mount.aim, sight);
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (!AxesLookingAlong(state.p_PC, mount.up, axes) &&
      !AxesLookingAlong(state.p_PC, Eigen::Vector3d::UnitX(), axes)) {
    AxesLookingAlong(state.p_PC, Eigen::Vector3d::UnitY(), axes);
  }
  Pose X_FC;
  X_FC.position = eye;
  X_FC.rotation = Eigen::Quaterniond(axes).normalized();
  return {mount.frame, X_FC};
}

} // namespace

void CameraMount::Check(const std::string& camera) const {
  const std::string object = "camera '" + camera + "'";
  if (this->kind == Kind::Fixed) {
    if (!IsValidPose(this->X_FC)) {
      RejectPose(object, this->X_FC);
    }
    Require(this->X_FC.scale == 1.0, object, "scale", this->X_FC.scale, "1");
    return;
  }
  const bool pointing = this->kind == Kind::Pointing;
  if (pointing) {
    RequirePosition(object, "eye", this->X_FC.position);
  } else {
    RequirePosition(object, "offset", this->offset);
  }
  RequirePosition(object, "target", this->target);
  RequireFinite(object, "up", this->up);
  Require(this->smoothing_s >= 0.0 && std::isfinite(this->smoothing_s), object, "smoothing",
          this->smoothing_s, "0 seconds and more");
  if (pointing && this->aim == this->frame && this->target == this->X_FC.position) {
    Reject(object, "it points at its own eye, " + VectorText(this->target) +
                       "; accepted: another target, or another frame");
  }
  if (!pointing && this->offset == this->target) {
    Reject(object, "its offset and its target are both " + VectorText(this->offset) +
                       "; accepted: an offset away from the target");
  }
  if (this->up.isZero(0.0)) {
    Reject(object, "up is (0, 0, 0); accepted: a direction");
  }
  if (pointing || this->vertical != Vertical::Parent) {
    return; // the direction changes with the frames
  }
  // Followed axes turn against `up`, and headings against any that is not upright.
  const Eigen::Vector3d up = this->up.stableNormalized();
  const bool fixedAxes = this->axes == ChaseAxes::Parent || (this->axes == ChaseAxes::Heading &&
                                                             std::hypot(up.x(), up.y()) < Parallel);
  Eigen::Matrix3d unused;
  if (fixedAxes && !AxesLookingAlong(this->target - this->offset, this->up, unused)) {
    Reject(object, "up " + VectorText(this->up) + " is along the line of sight from " +
                       VectorText(this->offset) + " to " + VectorText(this->target) +
                       "; accepted: any other direction");
  }
}

Eigen::Vector3d UpFor(const Eigen::Vector3d& sight) {
  Eigen::Matrix3d unused;
  return AxesLookingAlong(sight, Eigen::Vector3d::UnitZ(), unused) ? Eigen::Vector3d::UnitZ()
                                                                   : Eigen::Vector3d::UnitY();
}

Pose LookAt(const std::string& camera, const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
            const Eigen::Vector3d& up) {
  const std::string object = "camera '" + camera + "'";
  RequirePosition(object, "eye", eye);
  RequirePosition(object, "target", target);
  RequireFinite(object, "up", up);
  if (eye == target) {
    Reject(object,
           "eye and target are both " + VectorText(eye) + "; accepted: a target away from the eye");
  }
  if (up.isZero(0.0)) {
    Reject(object, "up is (0, 0, 0); accepted: a direction");
  }
  Eigen::Matrix3d axes;
  if (!AxesLookingAlong(target - eye, up, axes)) {
    Reject(object, "up " + VectorText(up) + " is along the line of sight from " + VectorText(eye) +
                       " to " + VectorText(target) + "; accepted: any other direction");
  }
  Pose X_FC;
  X_FC.position = eye;
  X_FC.rotation = Eigen::Quaterniond(axes).normalized();
  return X_FC;
}

CameraPose PlaceCamera(const Camera& camera, const FrameTree& frames, double time_s,
                       ChaseState& state) {
  const CameraMount& mount = camera.mount;
  if (mount.kind == CameraMount::Kind::Fixed) {
    if (!frames.Contains(mount.frame)) {
      throw Error(Error::Kind::NotFound, "camera '" + camera.name + "'",
                  "frame " + std::to_string(mount.frame) + " is not in the tree");
    }
    return {mount.frame, mount.X_FC};
  }
  if (mount.kind == CameraMount::Kind::Pointing) {
    return PlacePointing(mount, "camera '" + camera.name + "'", frames, time_s, state);
  }
  if (mount.frame == RootFrame) {
    Reject("camera '" + camera.name + "'",
           "it follows the root frame, which does not move; accepted: any other frame");
  }
  const Pose& X_PF = frames.LocalPose(mount.frame);
  const FrameId parent = frames.Parent(mount.frame);
  const Eigen::Matrix3d R_PF = X_PF.rotation.toRotationMatrix();
  const bool local = mount.vertical != CameraMount::Vertical::Parent;
  if (local && !frames.Contains(mount.aim)) {
    throw Error(Error::Kind::NotFound, "camera '" + camera.name + "'",
                "frame " + std::to_string(mount.aim) + " is not in the tree");
  }
  const Eigen::Vector3d up = local ? VerticalOf(mount, frames) : mount.up;
  const Eigen::Matrix3d R_PA = local && mount.axes == CameraMount::ChaseAxes::Heading
                                   ? HeadingAbout(up, R_PF)
                                   : OffsetAxes(mount.axes, R_PF);
  const Eigen::Vector3d wanted = X_PF.position + R_PA * mount.offset;
  const Eigen::Vector3d target = X_PF.position + R_PA * mount.target;
  Advance(state, time_s, mount.smoothing_s, mount.frame, parent, wanted);

  Eigen::Vector3d sight = target - state.p_PC;
  const double asked = (mount.target - mount.offset).norm();
  if (sight.norm() < Parallel * asked) {
    sight = R_PA * (mount.target - mount.offset);
  }
  Eigen::Matrix3d axes = Eigen::Matrix3d::Identity();
  if (!AxesLookingAlong(sight, up, axes) && !AxesLookingAlong(sight, R_PF.col(0), axes)) {
    AxesLookingAlong(sight, R_PF.col(1), axes);
  }
  Pose X_PC;
  X_PC.position = state.p_PC;
  X_PC.rotation = Eigen::Quaterniond(axes).normalized();
  return {parent, X_PC};
}

} // namespace dspace
