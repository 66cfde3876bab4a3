// Cameras: where they stand, what they project, in plain numbers.
#ifndef DSPACE_SCENE_CAMERA_H
#define DSPACE_SCENE_CAMERA_H

#include <limits>
#include <string>

#include <Eigen/Geometry>

#include <dspace/FrameTree.h>
#include <dspace/Pose.h>

namespace dspace {

// How a camera maps its frame to pixels. The camera frame C is a sensor's: X right, Y down,
// Z forward. Pixel (0, 0) is the centre of the top-left pixel, so that the image covers
// [-0.5, width - 0.5] × [-0.5, height - 0.5].
struct Projection {
  enum class Kind { Perspective, Orthographic, Frustum };
  Kind kind = Kind::Perspective;
  double verticalFov_deg = 45.0; // Perspective: full angle top to bottom, 1e-6 to 180 - 1e-6
  double height = 10.0;          // Orthographic: metres from top to bottom, 1e-9 to 1e18
  // Frustum (off-axis): tangents of the half angles, right and bottom positive along X and Y;
  // left < right, top < bottom, by 1e-9 and more; up to 1e6.
  double left = -0.5, right = 0.5, top = -0.5, bottom = 0.5;
  double nearDistance = 0.05; // metres along Z, 1e-9 to 1e18 (-1e18 to 1e18 for Orthographic)
  // > nearDistance, up to 1e18 or (but for Orthographic) infinite.
  double farDistance = std::numeric_limits<double>::infinity();
  // Throws Error(InvalidArgument) naming `camera` and the value (fov, height, near >= far, ...).
  void Check(const std::string& camera) const;

  // Clip from view coordinates (OpenGL's: X right, Y up, looking along -Z), reversed depth:
  // near maps to 1, far to 0, clip control zero-to-one. Column vectors on the right.
  // Perspective and Orthographic take their horizontal extent from width / height; Frustum
  // stretches over the whole image.
  Eigen::Matrix4d ClipFromView(int width, int height) const;

  // Pixel coordinates and depth (along Z, metres) of a point in C; `visible` is false behind the
  // camera (perspective kinds), where pixel is NaN. Independent of ClipFromView's depth mapping.
  struct PixelPoint {
    double x, y, depth;
    bool visible;
  };
  PixelPoint Project(const Eigen::Vector3d& p_C, int width, int height) const;

  // The ray of a pixel in C; direction is unit. For Orthographic the origin moves, at Z = 0.
  struct Ray {
    Eigen::Vector3d origin, direction;
  };
  Ray PixelRay(double x, double y, int width, int height) const;

  // Depth along Z [m] of a reversed-depth buffer value; +infinity for 0 (nothing hit).
  double DepthFromBuffer(double value) const;

  // Width of one pixel [m] at `depth` along Z: for levels of detail and markers.
  double MetresPerPixel(double depth, int height) const;
};

// How a camera moves.
struct CameraMount {
  enum class Kind {
    Fixed, // X_FC in `frame`: placed by hand, by the simulation, or attached to a moving frame
    Chase  // follows `frame` from an offset and looks at it
  };
  enum class ChaseAxes {
    Followed, // the offset turns with the followed frame
    Heading,  // the offset turns with its heading only (rotation about the parent's Z)
    Parent    // the offset keeps its direction in the followed frame's parent
  };
  Kind kind = Kind::Fixed;
  FrameId frame = 1; // root
  Pose X_FC;         // Fixed only; scale 1
  // Chase: the camera's offset from the followed frame's origin, and the point looked at, both in
  // the axes chosen [m]; `up` in the parent's axes.
  ChaseAxes axes = ChaseAxes::Heading;
  Eigen::Vector3d offset = Eigen::Vector3d(-5, 0, 2);
  Eigen::Vector3d target = Eigen::Vector3d::Zero();
  Eigen::Vector3d up = Eigen::Vector3d::UnitZ();
  double smoothing_s =
      0.0; // time constant of the lag behind the offset, in simulation time; 0 none

  // Throws Error(InvalidArgument) naming `camera` and the value: a pose that is no pose or has a
  // scale, a chase whose offset is its target, an `up` that is zero or always along the line of
  // sight, a negative smoothing. Whether `frame` exists is for the scene to say.
  void Check(const std::string& camera) const;
};

struct Camera {
  std::string name;
  Projection projection;
  CameraMount mount;
};

// X_FC of a camera at `eye` looking at `target` (both in F) with `up` towards the image's top.
// Throws Error(InvalidArgument) naming `camera` when eye and target coincide, up is zero or within
// 1e-9 rad of the line of sight, or a value is not finite.
Pose LookAt(const std::string& camera, const Eigen::Vector3d& eye, const Eigen::Vector3d& target,
            const Eigen::Vector3d& up);

// A camera's pose as frame and local pose, so that whoever draws goes through the nearest common
// ancestor: X_FC in `frame`.
struct CameraPose {
  FrameId frame = 1;
  Pose X_FC;
};

// State of a chase camera's lag; a function of simulation time only.
struct ChaseState {
  bool started = false;
  double time_s = 0.0;
  FrameId frame = NoFrame;  // the frame followed, and the frame in which the position is:
  FrameId parent = NoFrame; // the lag starts anew when either is another
  Eigen::Vector3d p_PC = Eigen::Vector3d::Zero(); // smoothed camera position in the parent frame
};

// Where `camera` stands now. Chase cameras are given in the followed frame's parent P, whose metres
// the offset and the target count. `state` is advanced to simulation time `time_s` (a step back in
// time starts the lag anew): with d the distance from the place that the offset asks for,
// d(t + dt) = d(t) exp(-dt / smoothing_s), exact for any dt while that place rests.
//
// The heading is the direction of the followed frame's X axis in the parent's XY plane; where X
// stands upright, that of the axis which pitching brought there. Where `up` falls on the line of
// sight, the followed frame's X (else Y) axis takes its place; where the lag brings the camera onto
// its target, it keeps the direction of the offset.
// Throws Error(NotFound) for a frame that is not in the tree, InvalidArgument for a chase of the
// root.
CameraPose PlaceCamera(const Camera& camera, const FrameTree& frames, double time_s,
                       ChaseState& state);

} // namespace dspace

#endif
