// How a camera projects, in plain numbers.
#ifndef DSPACE_SCENE_PROJECTION_H
#define DSPACE_SCENE_PROJECTION_H

#include <optional>
#include <string>

#include <Eigen/Core>

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
  // Metres along Z, 1e-9 to 1e18 (-1e18 to 1e18 for Orthographic). Absent: follows what is drawn.
  std::optional<double> nearDistance = {};
  // > Near(), up to 1e18 or (but for Orthographic) infinite. Absent: follows what is drawn.
  std::optional<double> farDistance = {};

  // The distances, where they are absent those of a picture of nothing: 0.05 m, and infinity, or
  // 1e4 m for Orthographic.
  double Near() const;
  double Far() const;
  // This projection with near and far set, so that a picture of things at depths from `nearest` to
  // `farthest` [m] shows them whole. A distance that is set stays. Far that is absent becomes
  // infinite for the perspective kinds, and lies behind `farthest` for Orthographic. Near that is
  // absent becomes 0.05 m for the perspective kinds, or less where `nearest` is positive and less,
  // and lies before `nearest` for Orthographic, but not behind the camera.
  // nearest > farthest: there is nothing.
  Projection Seeing(double nearest, double farthest) const;

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

} // namespace dspace

#endif
