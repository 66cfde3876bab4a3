#include <dspace/scene/controls/OrbitMotion.h>

#include <algorithm>
#include <cmath>

namespace dspace {

namespace {

constexpr double DegreesPerRadian = 180.0 / 3.14159265358979323846;

// A level camera's axes in F as columns, from its right and the elevation of its sight.
Eigen::Matrix3d LevelAxes(const Eigen::Vector3d& right, const Eigen::Vector3d& up,
                          double elevation_deg) {
  const double e = elevation_deg / DegreesPerRadian;
  const Eigen::Vector3d level = up.cross(right);
  Eigen::Matrix3d axes;
  axes.col(0) = right;
  axes.col(2) = std::cos(e) * level + std::sin(e) * up;
  axes.col(1) = axes.col(2).cross(right);
  return axes;
}

} // namespace

Pose OrbitAbout(const Pose& X_FC, const Eigen::Vector3d& pivot_F, const Eigen::Vector3d& up_F,
                double turn_deg, double rise_deg) {
  const Eigen::Matrix3d R_FC = X_FC.rotation.toRotationMatrix();
  const Eigen::Vector3d sight = R_FC.col(2);
  Eigen::Vector3d right = sight.cross(up_F);
  if (right.norm() < NearlyUpright) {
    right = R_FC.col(0) - R_FC.col(0).dot(up_F) * up_F;
  }
  right.normalize();
  const double elevation =
      std::atan2(sight.dot(up_F), sight.dot(up_F.cross(right))) * DegreesPerRadian;
  const Eigen::Matrix3d before = LevelAxes(right, up_F, elevation);
  const Eigen::Vector3d turned = Eigen::AngleAxisd(turn_deg / DegreesPerRadian, up_F) * right;
  const Eigen::Matrix3d after =
      LevelAxes(turned, up_F, std::clamp(elevation + rise_deg, -90.0, 90.0));
  Pose X;
  X.rotation = Eigen::Quaterniond(after).normalized();
  X.position = pivot_F + after * (before.transpose() * (X_FC.position - pivot_F));
  return X;
}

Pose PanTo(const Pose& X_FC, const Projection& projection, const Eigen::Vector3d& point_F, double x,
           double y, int width, int height) {
  const Eigen::Vector3d now = X_FC.Inverse().Apply(point_F);
  const Projection::Ray ray = projection.PixelRay(x, y, width, height);
  const Eigen::Vector3d wanted =
      ray.origin + ray.direction * ((now.z() - ray.origin.z()) / ray.direction.z());
  Pose X = X_FC;
  X.position += X_FC.rotation * (now - wanted);
  return X;
}

void DollyTo(Pose& X_FC, Projection& projection, const Eigen::Vector3d& pivot_F, double factor) {
  const Eigen::Vector3d p_C = X_FC.Inverse().Apply(pivot_F);
  if (projection.kind == Projection::Kind::Orthographic) {
    const double height = std::clamp(projection.height * factor, 1e-9, 1e15);
    const double share = 1.0 - height / projection.height;
    X_FC.position += X_FC.rotation * Eigen::Vector3d(share * p_C.x(), share * p_C.y(), 0.0);
    projection.height = height;
    return;
  }
  if (!(p_C.z() > 0.0)) {
    return; // behind the camera: there is no pixel to keep
  }
  const double nearest = std::min(p_C.z(), 2.0 * projection.Near());
  const double farthest = std::max(p_C.z(), 1e15);
  const double depth = std::clamp(p_C.z() * factor, nearest, farthest);
  X_FC.position = pivot_F + (X_FC.position - pivot_F) * (depth / p_C.z());
}

} // namespace dspace
