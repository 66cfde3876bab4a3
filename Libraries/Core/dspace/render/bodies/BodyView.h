// A body as one picture sees it, in plain numbers: the rays of its pixels in the body's own axes.
#ifndef DSPACE_RENDER_BODY_VIEW_H
#define DSPACE_RENDER_BODY_VIEW_H

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <dspace/render/DrawList.h>

namespace dspace {

// A ray of the window's place (x, y) from the pivot: its origin and direction are linear in (1, x,
// y). Lengths along it count from the camera where that is within a few radii; else, and for
// orthographic views, from the plane through the body's centre. Floats then lose no digits that a
// picture shows.
struct BodyView {
  Eigen::Vector2d pivot = Eigen::Vector2d::Zero(); // window coordinates [samples], y upwards
  Eigen::Matrix3d viewOrigin;                      // view axes [m]
  Eigen::Matrix3d viewDirection;                   // its z is -1
  Eigen::Matrix3d rayOrigin; // in axes in which the ellipsoid is a unit sphere
  Eigen::Matrix3d rayDirection;
  bool near = false;   // lengths count from the camera
  double gap = 0.0;    // near: the camera's squared distance from the centre there, less 1
  double radius = 0.0; // of the apparent disc [samples], about; infinity: near or inside
  // Of the ellipsoid in the window from the pivot: left, bottom, right, top; the whole picture
  // where it is near.
  Eigen::Vector4d box;
  double nearest = 0.0; // depth of its nearest point, about [m]
  bool seen = false;    // the camera is outside
  bool inside = false;  // of the ellipsoid

  // `X_VO`: view axes from the body's; `radii` of the ellipsoid [m].
  BodyView(const Eigen::Affine3d& X_VO, const Eigen::Vector3d& radii, const DrawView& view);

  // The box in normalised device coordinates, `margin` samples wider on each side.
  Eigen::Vector4d BoxNDC(const DrawView& view, double margin = 1.0) const;
};

} // namespace dspace

#endif
