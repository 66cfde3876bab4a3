#include <dspace/render/bodies/BodyView.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dspace {
namespace {

constexpr double NearRadii = 3.0; // from the centre, where lengths count from the camera

// The matrix M with value = M (1, x, y), of a value that is linear in normalised device
// coordinates: atPivot + x byX + y byY.
Eigen::Matrix3d Linear(const Eigen::Vector3d& atPivot, const Eigen::Vector3d& byX,
                       const Eigen::Vector3d& byY) {
  Eigen::Matrix3d made;
  made << atPivot, byX, byY;
  return made;
}

} // namespace

BodyView::BodyView(const Eigen::Affine3d& X_VO, const Eigen::Vector3d& radii,
                   const DrawView& view) {
  const Eigen::Matrix4d clip = view.ClipFromView();
  const bool parallel = view.projection.kind == Projection::Kind::Orthographic;
  const Eigen::Vector3d center = X_VO.translation();
  const Eigen::Matrix3d unit = (X_VO.linear() * radii.asDiagonal()).inverse();
  const Eigen::Vector3d camera = unit * -center; // in the sphere's axes
  const double away = camera.norm();
  const double stretched = 1.0 / unit.jacobiSvd().singularValues().minCoeff(); // largest radius [m]
  const double depth = -center.z();
  this->near = !parallel && (away < NearRadii || depth < 1.5 * stretched);
  this->gap = camera.squaredNorm() - 1.0;
  this->inside = !parallel && this->gap <= 0.0;
  // Window coordinates to slopes (perspective) or places (parallel) of a ray in view axes.
  const double w = view.width;
  const double h = view.height;
  const Eigen::Vector2d step(2.0 / (w * clip(0, 0)), 2.0 / (h * clip(1, 1)));
  const auto slopeAt = [&](const Eigen::Vector2d& window) {
    const Eigen::Vector2d ndc(2.0 * window.x() / w - 1.0, 2.0 * window.y() / h - 1.0);
    return parallel ? Eigen::Vector2d((ndc.x() - clip(0, 3)) / clip(0, 0),
                                      (ndc.y() - clip(1, 3)) / clip(1, 1))
                    : Eigen::Vector2d((ndc.x() + clip(0, 2)) / clip(0, 0),
                                      (ndc.y() + clip(1, 2)) / clip(1, 1));
  };
  const Eigen::Vector2d origin = slopeAt(Eigen::Vector2d::Zero());
  if (this->near) {
    this->pivot = Eigen::Vector2d(std::floor(0.5 * w), std::floor(0.5 * h));
  } else {
    const Eigen::Vector2d middle = parallel ? Eigen::Vector2d(center.x(), center.y())
                                            : Eigen::Vector2d(center.head<2>() / depth);
    this->pivot = (middle - origin).cwiseQuotient(step).array().floor();
    // A float has it exactly, or it is far out of the picture.
    this->pivot = this->pivot.cwiseMax(-1e6).cwiseMin(1e6);
  }
  const Eigen::Vector2d atPivot = slopeAt(this->pivot);
  const Eigen::Vector3d forward(0.0, 0.0, -1.0);
  const Eigen::Vector3d alongX(step.x(), 0.0, 0.0);
  const Eigen::Vector3d alongY(0.0, step.y(), 0.0);
  const Eigen::Vector3d here(atPivot.x(), atPivot.y(), 0.0);
  const Eigen::Vector3d zero = Eigen::Vector3d::Zero();
  if (parallel) {
    this->viewOrigin = Linear(here + Eigen::Vector3d(0, 0, center.z()), alongX, alongY);
    this->viewDirection = Linear(forward, zero, zero);
    this->rayOrigin = Linear(unit * (here - Eigen::Vector3d(center.x(), center.y(), 0.0)),
                             unit * alongX, unit * alongY);
  } else if (this->near) {
    this->viewOrigin = Eigen::Matrix3d::Zero();
    this->viewDirection = Linear(here + forward, alongX, alongY);
    this->rayOrigin = Linear(camera, zero, zero);
  } else {
    this->viewOrigin = depth * Linear(here + forward, alongX, alongY);
    this->viewDirection = Linear(here + forward, alongX, alongY);
    const Eigen::Vector3d aside(depth * atPivot.x() - center.x(), depth * atPivot.y() - center.y(),
                                0.0);
    this->rayOrigin = Linear(unit * aside, unit * alongX * depth, unit * alongY * depth);
  }
  this->rayDirection = unit * this->viewDirection;

  // The limb's box: tangent planes through the camera and each axis of the picture. For a sphere in
  // other axes: the plane x = s (-z) touches where |n'| = distance of the centre.
  const Eigen::Matrix3d shape = unit.inverse(); // columns: half axes, view axes [m]
  const Eigen::Matrix3d q = shape * shape.transpose();
  const auto limits = [&](int axis) -> std::array<double, 2> {
    if (parallel) {
      const double half = std::sqrt(q(axis, axis));
      return {center[axis] - half, center[axis] + half};
    }
    // n = e_axis + s e_z (the plane n . p = 0 with s = slope); touches: (n . c)^2 = n' Q n.
    const double a = center.z() * center.z() - q(2, 2);
    const double b = center[axis] * center.z() - q(axis, 2);
    const double c = center[axis] * center[axis] - q(axis, axis);
    const double square = b * b - a * c;
    if (a <= 0.0 || square < 0.0) {
      return {-std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    }
    const double root = std::sqrt(square);
    const double one = (-b - root) / a;
    const double other = (-b + root) / a;
    return {std::min(one, other), std::max(one, other)};
  };
  const std::array<double, 2> x = limits(0);
  const std::array<double, 2> y = limits(1);
  this->nearest = std::max(0.0, depth - stretched);
  if (!this->near && std::isfinite(x[0]) && std::isfinite(y[0])) {
    this->box = {(x[0] - atPivot.x()) / step.x(), (y[0] - atPivot.y()) / step.y(),
                 (x[1] - atPivot.x()) / step.x(), (y[1] - atPivot.y()) / step.y()};
    this->radius = 0.5 * std::max(this->box[2] - this->box[0], this->box[3] - this->box[1]);
    this->seen = true;
  } else {
    this->box = {-this->pivot.x(), -this->pivot.y(), w - this->pivot.x(), h - this->pivot.y()};
    this->radius = std::numeric_limits<double>::infinity();
    this->seen = !this->inside;
  }
}

Eigen::Vector4d BodyView::BoxNDC(const DrawView& view, double margin) const {
  Eigen::Vector4d ndc;
  for (int i = 0; i < 4; ++i) {
    const double size = i % 2 == 0 ? view.width : view.height;
    const double place = this->box[i] + this->pivot[i % 2] + (i < 2 ? -margin : margin);
    ndc[i] = std::clamp(2.0 * place / size - 1.0, -1.0, 1.0);
  }
  return ndc;
}

} // namespace dspace
