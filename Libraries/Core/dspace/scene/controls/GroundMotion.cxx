#include <dspace/scene/controls/GroundMotion.h>

#include <algorithm>
#include <cmath>

#include <dspace/scene/controls/OrbitMotion.h>

namespace dspace {
namespace {

constexpr double RightAngle = 1.57079632679489661923;

// Of a camera: X right, Y down, Z along the sight, from its level heading (unit) and elevation.
Eigen::Quaterniond LevelRotation(const Eigen::Vector3d& heading, const Eigen::Vector3d& up,
                                 double elevation) {
  Eigen::Matrix3d axes;
  axes.col(0) = heading.cross(up).normalized();
  axes.col(2) = (std::cos(elevation) * heading + std::sin(elevation) * up).normalized();
  axes.col(1) = axes.col(2).cross(axes.col(0));
  return Eigen::Quaterniond(axes).normalized();
}

Eigen::Vector3d HeadingOf(const Eigen::Matrix3d& axes, const Eigen::Vector3d& up) {
  Eigen::Vector3d right = axes.col(2).cross(up);
  if (right.norm() < NearlyUpright) {
    right = axes.col(0) - axes.col(0).dot(up) * up;
  }
  return up.cross(right.normalized());
}

double ElevationOf(const Eigen::Matrix3d& axes, const Eigen::Vector3d& up) {
  const Eigen::Vector3d sight = axes.col(2);
  return std::atan2(sight.dot(up), sight.dot(HeadingOf(axes, up)));
}

} // namespace

std::optional<Eigen::Quaterniond> LevelAim(const Eigen::Quaterniond& before,
                                           const Eigen::Vector3d& ray_C,
                                           const Eigen::Vector3d& aim_F,
                                           const Eigen::Vector3d& up_F) {
  const Eigen::Vector3d d = ray_C.stableNormalized();
  const Eigen::Vector3d aim = aim_F.stableNormalized();
  // With heading h and elevation e, Z = h cos e + up sin e and Y = h sin e - up cos e, so that the
  // direction's part along `up` is d.z sin e - d.y cos e = A sin(e - phase).
  const double rise = aim.dot(up_F);
  const double amplitude = std::hypot(d.y(), d.z());
  if (!(amplitude > 0.0) || std::abs(rise) > amplitude) {
    return std::nullopt;
  }
  const double phase = std::atan2(d.y(), d.z());
  const double angle = std::asin(rise / amplitude);
  const double now = ElevationOf(before.toRotationMatrix(), up_F);
  std::optional<double> elevation;
  for (double e : {phase + angle, phase + 2.0 * RightAngle - angle}) {
    e = std::remainder(e, 4.0 * RightAngle);
    if (std::abs(e) <= RightAngle &&
        (!elevation || std::abs(e - now) < std::abs(*elevation - now))) {
      elevation = e;
    }
  }
  if (!elevation) {
    return std::nullopt;
  }
  const double along = d.y() * std::sin(*elevation) + d.z() * std::cos(*elevation);
  const double square = along * along + d.x() * d.x();
  if (square < NearlyUpright * NearlyUpright) {
    return std::nullopt;
  }
  const Eigen::Vector3d level = aim - rise * up_F;
  const Eigen::Vector3d heading = (along * level - d.x() * level.cross(up_F)) / square;
  return LevelRotation(heading.normalized(), up_F, *elevation);
}

Eigen::Quaterniond LevelSight(const Eigen::Quaterniond& before, const Eigen::Vector3d& up_F) {
  const Eigen::Matrix3d axes = before.toRotationMatrix();
  return LevelRotation(HeadingOf(axes, up_F), up_F, ElevationOf(axes, up_F));
}

Eigen::Vector3d AboveGround(const NavigationGround& ground, const Eigen::Vector3d& p_F,
                            double clearance) {
  const auto below = ground.Below(p_F);
  const auto up = ground.Up(p_F);
  if (!below || !up || (p_F - *below).dot(*up) >= clearance) {
    return p_F;
  }
  return *below + clearance * *up;
}

Pose WalkStep(const Pose& X_FC, const NavigationGround* ground, const Eigen::Vector3d& up_F,
              double forward, double right, double eyeHeight) {
  const Eigen::Matrix3d axes = X_FC.rotation.toRotationMatrix();
  const Eigen::Vector3d heading = HeadingOf(axes, up_F);
  double elevation = ElevationOf(axes, up_F);
  Pose X = X_FC;
  X.position += forward * heading + right * heading.cross(up_F);
  Eigen::Vector3d up = up_F;
  if (ground) {
    auto below = ground->Below(X.position);
    if (!below && ground->Below(X_FC.position)) { // beyond the edge
      X.position = X_FC.position;
      below = ground->Below(X.position);
    }
    up = ground->Up(X.position).value_or(up_F);
    if (below) {
      const double drop = (X.position - *below).dot(up) - eyeHeight;
      X.position = *below + eyeHeight * up;
      if (std::abs(drop) > std::max(1.0, eyeHeight) + std::abs(forward) + std::abs(right)) {
        elevation = 0.0; // from the air: it looked down
      }
    }
  }
  const Eigen::Vector3d level = heading - heading.dot(up) * up;
  X.rotation = LevelRotation(level.normalized(), up, elevation);
  return X;
}

} // namespace dspace
