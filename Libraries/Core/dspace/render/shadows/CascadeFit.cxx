#include <dspace/render/shadows/CascadeFit.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dspace {
namespace {

// How far the maps reach by themselves, in units of the nearest depth.
constexpr double Reach = 2048.0;
// A camera whose nearest depth is more than this part of the farthest one.
constexpr double LongLens = 0.5;
// By how much each map of a parallel view is wider than the one before.
constexpr double Wider = 4.0;

// The rays through the corners of a picture, in OpenGL's view axes, by depth along the view's axis.
struct CornerRays {
  std::array<Eigen::Vector3d, 4> start;
  std::array<Eigen::Vector3d, 4> slope; // a metre of depth

  CornerRays(const Projection& projection, int width, int height) {
    for (int i = 0; i < 4; ++i) {
      const Projection::Ray ray =
          projection.PixelRay((i & 1 ? width : 0) - 0.5, (i & 2 ? height : 0) - 0.5, width, height);
      const Eigen::Vector3d view(1.0, -1.0, -1.0);
      this->start[i] = view.cwiseProduct(ray.origin);
      this->slope[i] = view.cwiseProduct(ray.direction) / ray.direction.z();
    }
  }
  Eigen::Vector3d At(int corner, double depth) const {
    return this->start[corner] + depth * this->slope[corner];
  }
};

} // namespace

Eigen::Matrix3d LightAxes(const Eigen::Vector3d& toSun) {
  // The shortest turn that takes Z to S takes X to U and Y to V (J. R. Frisvad 2012).
  const Eigen::Vector3d s = toSun.normalized();
  Eigen::Matrix3d axes;
  if (s.z() < -1.0 + 1e-12) {
    axes << 0, -1, 0, -1, 0, 0, 0, 0, -1;
    return axes;
  }
  const double a = 1.0 / (1.0 + s.z());
  const double b = -s.x() * s.y() * a;
  axes.row(0) << 1.0 - s.x() * s.x() * a, b, -s.x();
  axes.row(1) << b, 1.0 - s.y() * s.y() * a, -s.y();
  axes.row(2) = s;
  return axes;
}

double CascadeFit::Reach(const Cascade& cascade) const {
  constexpr double Texels = 7.0; // half the widest penumbra
  return Texels * cascade.Texel(this->size) /
         std::max(std::tan(std::min(this->sun.radius, 1.5)), 1e-9);
}

double CascadeFit::Beginning(std::size_t k) const {
  constexpr double Share = 0.75;
  return k > 0 ? Share * this->Reach(this->cascades[k - 1]) : 0.0;
}

Eigen::Matrix4d CascadeFit::ClipFromView(const Cascade& cascade) const {
  Eigen::Matrix4d clip = Eigen::Matrix4d::Zero();
  for (const int axis : {0, 1}) {
    clip.row(axis).head<3>() = this->sun.axes.row(axis) / cascade.radius;
    clip(axis, 3) = -cascade.center[axis] / cascade.radius;
  }
  const double extent = cascade.high - cascade.low;
  clip.row(2).head<3>() = this->sun.axes.row(2) / extent;
  clip(2, 3) = -cascade.low / extent;
  clip(3, 3) = 1.0;
  return clip;
}

CascadeFit FitCascades(const Projection& projection, int width, int height, const SunPlace& sun,
                       double nearest, double farthest, const ShadowLook& look) {
  CascadeFit fit;
  fit.sun = sun;
  fit.size = look.size;
  const bool parallel = projection.kind == Projection::Kind::Orthographic;
  double first = std::exp2(0.5 * std::floor(2.0 * std::log2(std::max(nearest, 1e-3))));
  // Rounded, too: a farthest thing that moves changes nothing until it has moved by half.
  double last =
      look.distance > 0.0
          ? look.distance
          : std::min(std::exp2(0.5 * std::ceil(2.0 * std::log2(std::max(farthest, first)))),
                     Reach * first);
  const CornerRays rays(projection, width, height);
  double start = parallel ? nearest : 0.0;
  const bool reaches = look.distance == 0.0 || look.distance > nearest;
  if (!parallel && nearest > LongLens * farthest && reaches) {
    // Up to what it looks at, a camera with a long lens sees nothing that takes shadows: the maps
    // begin there, in steps of a part of what it sees.
    const double step = std::exp2(std::floor(std::log2(std::max(farthest - nearest, 1e-3)))) / 8.0;
    start = (std::floor(nearest / step) - 1.0) * step;
    first = start;
    last = look.distance > 0.0 ? look.distance : (std::ceil(farthest / step) + 1.0) * step;
  }
  for (int k = 0; k < look.cascades; ++k) {
    CascadeFit::Cascade cascade;
    cascade.end =
        last > first ? first * std::pow(last / first, double(k + 1) / look.cascades) : last;
    if (parallel) {
      cascade.end = farthest;
    }
    Eigen::Vector3d back = Eigen::Vector3d::Zero(); // middles of the rays' ends
    Eigen::Vector3d front = Eigen::Vector3d::Zero();
    for (int i = 0; i < 4; ++i) {
      back += 0.25 * rays.At(i, start);
      front += 0.25 * rays.At(i, cascade.end);
    }
    double nearRadius = 0.0;
    double farRadius = 0.0;
    for (int i = 0; i < 4; ++i) {
      nearRadius = std::max(nearRadius, (rays.At(i, start) - back).norm());
      farRadius = std::max(farRadius, (rays.At(i, cascade.end) - front).norm());
    }
    // The point of the axis that is as far from the near corners as from the far ones.
    const double length = std::max((front - back).norm(), 1e-12);
    const double along = std::clamp(
        0.5 * (length * length + farRadius * farRadius - nearRadius * nearRadius) / length, 0.0,
        length);
    const Eigen::Vector3d center = back + along / length * (front - back);
    for (int i = 0; i < 4; ++i) {
      cascade.radius = std::max({cascade.radius, (rays.At(i, start) - center).norm(),
                                 (rays.At(i, cascade.end) - center).norm()});
    }
    // Room for the rounding of the centre, and for the filter at the sides.
    cascade.radius *= 1.0 + 24.0 / look.size;
    if (parallel) {
      // Of parallel rays all parts of a view are equally wide: the first map has it all, and the
      // others are for the wide penumbrae of what is far above. Sizes are rounded, as `nearest` is.
      cascade.radius =
          std::exp2(0.5 * std::ceil(2.0 * std::log2(cascade.radius))) * std::pow(Wider, double(k));
    }
    const double texel = cascade.Texel(look.size);
    const Eigen::Vector3d light = sun.axes * center;
    for (int axis = 0; axis < 2; ++axis) {
      const double place = sun.camera[axis] + light[axis];
      cascade.center[axis] = std::round(place / texel) * texel - sun.camera[axis];
    }
    cascade.low = light.z() - cascade.radius;
    cascade.high = light.z() + cascade.radius;
    fit.cascades.push_back(cascade);
  }
  return fit;
}

} // namespace dspace
