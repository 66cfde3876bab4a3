// Cameras: where they stand and how they move, in plain numbers.
#ifndef DSPACE_SCENE_CAMERA_H
#define DSPACE_SCENE_CAMERA_H

#include <string>

#include <Eigen/Geometry>

#include <dspace/FrameTree.h>
#include <dspace/Pose.h>
#include <dspace/scene/Projection.h>

namespace dspace {

// How a camera moves.
struct CameraMount {
  enum class Kind {
    Fixed,   // X_FC in `frame`: placed by hand, by the simulation, or attached to a moving frame
    Chase,   // follows `frame` from an offset and looks at it
    Pointing // stands at X_FC's position in `frame` and keeps pointing at `aim`
  };
  enum class ChaseAxes {
    Followed, // the offset turns with the followed frame
    Heading,  // the offset turns with its heading only (rotation about the parent's Z)
    Parent    // the offset keeps its direction in the followed frame's parent
  };
  Kind kind = Kind::Fixed;
  FrameId frame = 1; // root
  // Chase: what is upright. Axis and Away are the local vertical: the offset's Z is along it, a
  // heading is about it, and it is towards the image's top in place of `up`.
  enum class Vertical {
    Parent, // the followed frame's parent: its Z, and `up`
    Axis,   // the Z axis of the frame `aim`: of a plane
    Away    // away from the origin of the frame `aim`: of a body about its centre
  };
  Pose X_FC;             // Fixed, scale 1; Pointing: only its position, the eye
  FrameId aim = NoFrame; // Pointing: the frame that it points at; `target` is in its axes.
                         // Chase: of `vertical`, else NoFrame
  Vertical vertical = Vertical::Parent;
  // Chase: the camera's offset from the followed frame's origin, and the point looked at, both in
  // the axes chosen [m]; `up` in the parent's axes. Pointing: `up` in the axes of `frame`.
  ChaseAxes axes = ChaseAxes::Heading;
  Eigen::Vector3d offset = Eigen::Vector3d(-5, 0, 2);
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double smoothing_s = 0.0; // time constant of the lag behind the offset (Pointing: behind the
                            // direction to the target), in simulation time; 0 none

  // Throws Error(InvalidArgument) naming `camera` and the value: an invalid pose or one with
  // a scale, a chase whose offset equals its target, an `up` that is zero or always along the line
  // of sight, a negative smoothing. The scene checks whether `frame` exists.
  void Check(const std::string& camera) const;
};

struct Camera {
  std::string name;
  Projection projection;
  CameraMount mount;
};

// What is towards the image's top of a camera that looks along `sight` where nobody says: Z, or Y
// where the camera looks along Z.
Eigen::Vector3d UpFor(const Eigen::Vector3d& sight);

// X_FC of a camera at `eye` looking at `target` (both in F) with `up` towards the image's top.
// Throws Error(InvalidArgument) naming `camera` when eye and target coincide, up is zero or within
// 1e-9 rad of the line of sight, or a value is not finite.
Pose LookAt(const std::string& camera, const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
            const Eigen::Vector3d& up);

// A camera's pose X_FC in `frame`. Rendering composes it through the nearest common ancestor, which
// keeps precision.
struct CameraPose {
  FrameId frame = 1;
  Pose X_FC;
};

// State of the lag of a chase or pointing camera; a function of simulation time only.
struct ChaseState {
  bool started = false;
  double time_s = 0.0;
  FrameId frame = NoFrame;  // the followed frame and the frame of the position;
  FrameId parent = NoFrame; // a change of either restarts the lag. Pointing: `frame` and `aim`
  // Chase: the smoothed camera position in the parent frame. Pointing: the smoothed direction of
  // sight in `frame`, unit.
  Eigen::Vector3d p_PC = Eigen::Vector3d::Zero();
};

// Returns the current pose of `camera`. The pose of a chase camera is in the followed frame's
// parent P; offset and target are in metres of P. `state` is advanced to simulation time `time_s`;
// a step back in time restarts the lag. With d the distance to the position given by the offset,
// d(t + dt) = d(t) exp(-dt / smoothing_s), exact for any dt while that position is constant.
//
// The heading is the direction of the followed frame's X axis in the parent's XY plane; where X
// stands upright, that of the axis which pitching brought there. With a local vertical v, Z of the
// parent is replaced by v at the followed frame's origin (by the parent's Z, where that is at the
// origin of `aim`), and the axes of ChaseAxes::Parent stay the parent's. Where `up` falls on the
// line of sight, the followed frame's X (else Y) axis takes its place; where the lag brings the
// camera onto its target, it keeps the direction of the offset.
//
// The pose of a pointing camera is in its own frame F. With a the angle between the direction of
// sight and the direction to the target in F, a(t + dt) = a(t) exp(-dt / smoothing_s), exact for
// any dt while the latter is constant. Where the target is at the eye, the camera looks along F's
// X axis, or keeps its smoothed direction. Where `up` falls on the line of sight, F's X (else Y)
// axis takes its place.
// Throws Error(NotFound) for a frame that is not in the tree, InvalidArgument for a chase of the
// root.
CameraPose PlaceCamera(const Camera& camera, const FrameTree& frames, double time_s,
                       ChaseState& state);

} // namespace dspace

#endif
