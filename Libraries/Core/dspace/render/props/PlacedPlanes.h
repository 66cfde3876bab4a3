// Planes of a prop's mappers, which VTK takes in world coordinates: clipping planes, and the plane
// of an image slice.
#ifndef DSPACE_RENDER_PLACED_PLANES_H
#define DSPACE_RENDER_PLACED_PLANES_H

#include <vector>

#include <Eigen/Geometry>

#include "vtkSmartPointer.h"

class vtkAbstractMapper3D;
class vtkPlane;
class vtkPlaneCollection;
class vtkProp3D;

namespace dspace {

// The planes of a prop and of the parts of an assembly stand in the coordinates of the object.
// While this lives, they are in those of the view.
class PlacedPlanes {
public:
  PlacedPlanes(vtkProp3D* prop, const Eigen::Affine3d& X_VO);
  PlacedPlanes(const PlacedPlanes&) = delete;
  PlacedPlanes& operator=(const PlacedPlanes&) = delete;
  ~PlacedPlanes();

private:
  struct Kept {
    vtkSmartPointer<vtkAbstractMapper3D> mapper;
    vtkSmartPointer<vtkPlaneCollection> clipping; // null: as it was
    vtkSmartPointer<vtkPlane> slice;              // null: as it was
  };
  void Place(vtkProp3D* prop, const Eigen::Affine3d& X_VO);

  std::vector<Kept> Kept_;
};

} // namespace dspace

#endif
