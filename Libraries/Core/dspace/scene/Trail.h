// The path of a moving object, as a line of bounded length.
#ifndef DSPACE_SCENE_TRAIL_H
#define DSPACE_SCENE_TRAIL_H

#include <cstddef>
#include <vector>

#include <Eigen/Core>

#include <dspace/import/model/Model.h>

namespace dspace {

// Positions p_F [m] in double precision, in the frame F of the trail's object. A full ring drops
// its oldest position. A position closer than the minimum spacing to the last stored one is not
// stored; it only moves the end of the line, so that the line always ends at the object.
class Trail {
public:
  // capacity 2 to 10,000,000 positions; minimumSpacing [m] >= 0. With `fade` the line's opacity
  // grows from 0 at the oldest position to 1 at the newest.
  // Throws Error(InvalidArgument) naming the trail and the value.
  Trail(std::size_t capacity, double minimumSpacing, bool fade = false);

  // Returns whether the position was kept. Throws Error(InvalidArgument) beyond 1e18 m.
  bool Add(const Eigen::Vector3d& p_F);
  void Clear();

  std::size_t Capacity() const { return this->Ring_.size(); }
  // Positions kept, at most Capacity().
  std::size_t Size() const { return this->Size_; }
  // Kept positions, 0 the oldest. Throws Error(InvalidArgument) from Size() on.
  const Eigen::Vector3d& Position(std::size_t i) const;
  // Where the line ends; the origin of F before the first Add.
  const Eigen::Vector3d& End() const { return this->End_; }

  // The line relative to `origin_F`, oldest first: vertices are p_F - origin_F, rounded to float
  // after the subtraction. With an origin near the trail (End(), as a rule) they stay small; the
  // object's offset X_FO then is the translation by that origin.
  // Fewer than two positions: vertices, and no line.
  Mesh LineMesh(const Eigen::Vector3d& origin_F) const;

private:
  std::vector<Eigen::Vector3d> Ring_;
  std::size_t First_ = 0; // of the oldest
  std::size_t Size_ = 0;
  double MinimumSpacing_;
  bool Fade_;
  bool EndKept_ = true; // End_ is the newest kept position
  Eigen::Vector3d End_ = Eigen::Vector3d::Zero();
};

} // namespace dspace

#endif
