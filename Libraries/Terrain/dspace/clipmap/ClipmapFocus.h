// From where a clipmap's levels are chosen: a zoomed view needs them fine where it looks.
#ifndef DSPACE_TERRAIN_CLIPMAPFOCUS_H
#define DSPACE_TERRAIN_CLIPMAPFOCUS_H

#include <functional>
#include <vector>

#include <dspace/posts/PostPlacement.h>

namespace dspace {

// Levels suit a view of this half angle or wider from where the camera stands: 30 degrees.
constexpr double FocusTangent = 0.57735026918962576;

// A view in the terrain's frame.
struct FocusView {
  Eigen::Vector3d camera = Eigen::Vector3d::Zero();
  Eigen::Vector3d forward = Eigen::Vector3d::UnitX(); // unit
  bool parallel = false;
  // Perspective: tangent of the greater of its half angles. Parallel: half of the greater of its
  // sides [m].
  double half = 1.0;
  std::vector<Eigen::Vector3d> rim; // perspective: unit directions along the picture's border
};

// Whether `focus` is elsewhere than at the camera.
inline bool IsZoomed(const FocusView& view) {
  return view.parallel || view.half < FocusTangent;
}

// Where a camera of half angle 30 degrees would stand to see what the view sees about as large:
// towards the ground in the picture's middle, but no further than nearer ground bears. The camera
// itself where the view is that wide or meets no ground. `height` [m] is that of the ground
// at a place in posts.
Eigen::Vector3d FocusOf(const FocusView& view, const PostPlacement& placement,
                        const std::function<double(const Eigen::Vector2d& post)>& height);

} // namespace dspace

#endif
