#include <dspace/scene/controls/CameraFit.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr double Infinity = std::numeric_limits<double>::infinity();

// Tangents of the borders across (0) and down (1), for a picture without its free space.
struct Borders {
  double low[2];
  double high[2];
};

Borders BordersOf(const Projection& projection, double margin, double aspect) {
  // Of a picture one pixel high the rays through the outer edges of the corner pixels.
  const int height = 1000000;
  const int width = std::max(1, int(std::lround(std::min(aspect, 1e3) * height)));
  const Eigen::Vector3d first = projection.PixelRay(-0.5, -0.5, width, height).direction;
  const Eigen::Vector3d last =
      projection.PixelRay(width - 0.5, height - 0.5, width, height).direction;
  Borders borders;
  for (int i = 0; i < 2; ++i) {
    const double a = first[i] / first.z();
    const double b = last[i] / last.z();
    const double half = 0.5 * (b - a) / (1.0 + 2.0 * margin);
    borders.low[i] = 0.5 * (a + b) - half;
    borders.high[i] = 0.5 * (a + b) + half;
  }
  return borders;
}

// Position of the camera in its own axes now, for the perspective kinds.
Eigen::Vector3d PlaceForPerspective(const std::vector<BoundingSphere>& spheres, const Borders& in,
                                    double near) {
  // A sphere lies left of the high border where x - high z + r √(1 + high²) <= X - high Z, with
  // (X, Y, Z) the camera; and right of the low one accordingly.
  double inner[2] = {-Infinity, -Infinity};
  double outer[2] = {Infinity, Infinity};
  double nearest = Infinity;
  for (const BoundingSphere& sphere : spheres) {
    for (int i = 0; i < 2; ++i) {
      const double high = in.high[i];
      const double low = in.low[i];
      const double x = sphere.center[i];
      const double z = sphere.center.z();
      inner[i] = std::max(inner[i], x - high * z + sphere.radius * std::hypot(1.0, high));
      outer[i] = std::min(outer[i], x - low * z - sphere.radius * std::hypot(1.0, low));
    }
    nearest = std::min(nearest, sphere.center.z() - sphere.radius);
  }
  Eigen::Vector3d place;
  place.z() = nearest - near;
  for (int i = 0; i < 2; ++i) {
    place.z() = std::min(place.z(), (outer[i] - inner[i]) / (in.high[i] - in.low[i]));
  }
  for (int i = 0; i < 2; ++i) {
    place[i] = 0.5 * (inner[i] + in.high[i] * place.z() + outer[i] + in.low[i] * place.z());
  }
  return place;
}

Eigen::Vector3d PlaceForOrthographic(const std::vector<BoundingSphere>& spheres, double margin,
                                     double aspect, Projection& projection) {
  Eigen::AlignedBox3d box;
  for (const BoundingSphere& sphere : spheres) {
    box.extend(Eigen::Vector3d(sphere.center.array() - sphere.radius));
    box.extend(Eigen::Vector3d(sphere.center.array() + sphere.radius));
  }
  const Eigen::Vector3d size = box.sizes();
  const double height = std::max(size.y(), size.x() / aspect);
  projection.height =
      std::clamp((1.0 + 2.0 * margin) * (height > 0.0 ? height : size.z()), 1e-9, 1e18);
  Eigen::Vector3d place = box.center();
  place.z() = 0.0;
  const double near = projection.nearDistance.value_or(0.0);
  const double far = projection.farDistance.value_or(Infinity);
  if (box.min().z() < near || box.max().z() > far) {
    const double spare = projection.farDistance ? std::max(0.0, 0.5 * (far - near - size.z()))
                                                : std::max(0.05, 0.5 * size.z());
    place.z() = box.min().z() - near - spare;
  }
  return place;
}

} // namespace

Camera FitCamera(const Camera& camera, const CameraPose& pose,
                 const std::vector<BoundingSphere>& spheres_F, double margin, double aspect) {
  const std::string object = "camera '" + camera.name + "'";
  Require(margin >= 0.0 && margin <= 10.0, object, "margin", margin, "0 to 10 times the size");
  Require(aspect >= 1e-6 && aspect <= 1e6, object, "aspect", aspect, "1e-6 to 1e6");
  if (spheres_F.empty()) {
    Reject(object, "there is nothing to show; accepted: one object or more that has a size");
  }
  const Pose X_CF = pose.X_FC.Inverse();
  std::vector<BoundingSphere> spheres; // in C
  double reach = 0.0;
  for (const BoundingSphere& sphere : spheres_F) {
    RequireFinite(object, "a centre to show", sphere.center);
    Require(sphere.radius >= 0.0 && std::isfinite(sphere.radius), object, "a radius to show",
            sphere.radius, "0 metres and more");
    spheres.push_back({X_CF.Apply(sphere.center), sphere.radius});
    reach = std::max({reach, sphere.radius, (sphere.center - spheres_F.front().center).norm()});
  }
  Require(reach > 0.0, object, "the size of what it is to show", reach, "more than 0 metres");
  Camera fitted = camera;
  const Eigen::Vector3d place =
      camera.projection.kind == Projection::Kind::Orthographic
          ? PlaceForOrthographic(spheres, margin, aspect, fitted.projection)
          : PlaceForPerspective(spheres, BordersOf(camera.projection, margin, aspect),
                                camera.projection.Near());
  fitted.mount = CameraMount();
  fitted.mount.frame = pose.frame;
  fitted.mount.X_FC = pose.X_FC;
  fitted.mount.X_FC.position = pose.X_FC.Apply(place);
  return fitted;
}

} // namespace dspace
