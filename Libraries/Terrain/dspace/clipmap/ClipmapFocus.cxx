#include <dspace/clipmap/ClipmapFocus.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dspace {
namespace {

constexpr double Never = std::numeric_limits<double>::infinity();

// Height above the ground.
double Above(const Eigen::Vector3d& p, const PostPlacement& placement,
             const std::function<double(const Eigen::Vector2d&)>& height) {
  const Eigen::Vector3d post = placement.ToPosts(p);
  return post.z() - height(post.head<2>());
}

// [m] along a ray to the ground, to about a tenth; infinity where it does not go there.
double ToGround(const Eigen::Vector3d& from, const Eigen::Vector3d& along,
                const PostPlacement& placement,
                const std::function<double(const Eigen::Vector2d&)>& height) {
  double before = Above(from, placement, height);
  if (before <= 0.0) {
    return Never; // from below
  }
  double t = 0.0;
  double step = 0.25 * before;
  for (int i = 0; i < 200; ++i) {
    const double above = Above(from + (t + step) * along, placement, height);
    if (above <= 0.0) {
      return t + step * before / (before - above);
    }
    t += step;
    before = above;
    step = std::max({0.1 * t, 0.25 * above});
  }
  return Never;
}

} // namespace

Eigen::Vector3d FocusOf(const FocusView& view, const PostPlacement& placement,
                        const std::function<double(const Eigen::Vector2d& post)>& height) {
  if (!IsZoomed(view)) {
    return view.camera;
  }
  const double ahead = ToGround(view.camera, view.forward, placement, height);
  if (view.parallel) {
    return ahead == Never
               ? view.camera
               : Eigen::Vector3d(view.camera + (ahead - view.half / FocusTangent) * view.forward);
  }
  double nearest = ahead;
  double farthest = ahead;
  for (const Eigen::Vector3d& direction : view.rim) {
    const double along = ToGround(view.camera, direction, placement, height);
    nearest = std::min(nearest, along);
    farthest = std::max(farthest, along);
  }
  if (nearest == Never) {
    return view.camera;
  }
  // Cells grow with the way from the focus, pixels with that from the camera: the harmonic mean
  // gives the nearest and the farthest ground the same ratio of the two, which is at most 1.
  const double even = 2.0 / (1.0 / nearest + 1.0 / farthest);
  const double nearer = 1.0 - view.half / FocusTangent;
  return view.camera + std::min(nearer * ahead, even) * view.forward;
}

} // namespace dspace
