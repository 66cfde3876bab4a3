// A place from which the ground is seen.
#ifndef DSPACE_MAPS_VIEWSHEDEYE_H
#define DSPACE_MAPS_VIEWSHEDEYE_H

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

#include <dspace/horizon/HorizonKernel.h>
#include <dspace/horizon/HorizonPath.h>
#include <dspace/maps/MapGround.h>
#include <dspace/maps/Viewshed.h>

namespace dspace {

class HeldPosts;

// The line of sight to a target is followed over the triangles of level 0 at every edge that it
// crosses, in double precision; a body's curvature counts. The line is divided into stretches. The
// search skips those whose greatest height cannot raise what was found, singly or in groups. It
// begins with the stretch that hid the previous target.
class ViewshedEye {
public:
  // What one line leaves to the next, which is faster where their targets are neighbours. In one
  // thread at a time. The same lines in the same order give the same numbers to the bit.
  struct Memory {
    int stretch = 0;
    std::vector<std::optional<HorizonPath::Point>> points; // of the present line
  };

  // Both must outlive it. `held`: of every post.
  ViewshedEye(const MapGround& ground, const HeldPosts& held, const ViewshedObserver& observer);

  // Whether the observer stands on data; else nothing below may be asked.
  bool HasGround() const;

  // The height [m] above the ground at the post `to` of the lowest target that is seen there, 0 or
  // more; NaN without data there and beyond the radius [m] along the ground.
  double Least(const Eigen::Vector2d& to, double radius, Memory& memory) const;
  // Whether a target of this height above that ground is seen. Empty where Least() is NaN. Faster
  // than Least().
  std::optional<bool> Sees(const Eigen::Vector2d& to, double radius, double targetHeight,
                           Memory& memory) const;

private:
  class PlaneLine;
  class BodyLine;
  template<class Line>
  bool Search(Line& line, double& steepest, std::optional<double> target, Memory& memory) const;

  double HeightAt(std::int64_t c, std::int64_t r) const;
  double HeightOn(std::int64_t c, std::int64_t r, int right, int down, double share) const;
  HeightSpan SpanOf(const Eigen::Vector2d& a, const Eigen::Vector2d& b, int margin) const;

  const MapGround& Ground_;
  const HeldPosts& Held_;
  Eigen::Vector2d Post_;
  double Floor_ = 0.0;
  double Height_ = 0.0;
};

} // namespace dspace

#endif
