// Fields of view of instruments, from instrument kernels.
#ifndef DSPACE_KERNELS_FIELD_OF_VIEW_H
#define DSPACE_KERNELS_FIELD_OF_VIEW_H

#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/kernels/KernelPool.h>

namespace dspace {

enum class FieldShape { Polygon, Rectangle, Circle, Ellipse };
const char* FieldShapeName(FieldShape shape); // "POLYGON", ...

// What an instrument sees (NAIF, "IK Required Reading"), in its frame.
struct FieldOfView {
  int instrument = 0; // NAIF id, -82360
  FieldShape shape = FieldShape::Polygon;
  std::string frame;                                    // in which the vectors are given
  Eigen::Vector3d boresight = Eigen::Vector3d::UnitZ(); // unit
  // Unit vectors: the corners of a polygon or rectangle, in order around it; one vector on the rim
  // of a circle; the ends of the two semi-axes of an ellipse.
  std::vector<Eigen::Vector3d> boundary;

  // The angle between boresight and the farthest boundary vector [deg].
  double RadiusDeg() const;
};

// The ids of all instruments of a pool with a field of view, ascending.
std::vector<int> Instruments(const KernelPool& pool);

// Throws Error(NotFound) where the pool has none for the instrument, Error(Corrupt), naming the
// variable, for an incomplete one or one of 90 degrees and more from the boresight that is not a
// circle.
FieldOfView FieldOfViewOf(const KernelPool& pool, int instrument);

} // namespace dspace

#endif
