// Conversion between two coordinate reference systems of one body (PROJ).
#ifndef DSPACE_TERRAIN_CRSTRANSFORM_H
#define DSPACE_TERRAIN_CRSTRANSFORM_H

#include <Eigen/Core>
#include <memory>

#include <dspace/crs/Crs.h>

namespace dspace {

// Map coordinates of one CRS to those of another on the same body. Calls may come from any thread
// and are serialized.
class CrsTransform {
public:
  // Throws Error(Unsupported) when PROJ has no way between the two, as between two bodies.
  CrsTransform(const Crs& from, const Crs& to);
  ~CrsTransform();

  // Throws Error(InvalidArgument) naming the point where the projection has no value for it.
  Eigen::Vector2d Apply(const Eigen::Vector2d& p) const;
  Eigen::Vector2d ApplyInverse(const Eigen::Vector2d& p) const;
  // Many points at once; NaN where the projection has no value.
  void TryApply(Eigen::Matrix2Xd& points) const;

private:
  struct Implementation;
  std::unique_ptr<Implementation> Impl_;
};

} // namespace dspace

#endif
