// Which way the map axes of a CRS run on the ground. Not for public headers.
#ifndef DSPACE_LAYERS_GROUNDAXES_H
#define DSPACE_LAYERS_GROUNDAXES_H

#include <memory>
#include <vector>

#include <Eigen/Core>

#include <dspace/crs/CrsTransform.h>

namespace dspace {

class GroundAxes {
public:
  // Throws Error(Unsupported) for a CRS in which longitude and latitude have no meaning.
  explicit GroundAxes(const Crs& crs);

  // At map places: the unit directions of map x (first column) and y, each as (east, north). NaN
  // where the projection has no value.
  std::vector<Eigen::Matrix2d> At(const Eigen::Matrix2Xd& places) const;

private:
  Crs Crs_;
  Crs Below_;                               // the geographic one
  std::unique_ptr<CrsTransform> Transform_; // to it; null: it is geographic itself
};

} // namespace dspace

#endif
