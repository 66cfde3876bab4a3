#include <dspace/render/props/PlacedPlanes.h>

#include "vtkAssembly.h"
#include "vtkImageResliceMapper.h"
#include "vtkNew.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkProp3DCollection.h"

#include <dspace/render/props/PropMapper.h>

namespace dspace {
namespace {

vtkSmartPointer<vtkPlane> Placed(vtkPlane* plane, const Eigen::Affine3d& X_VO) {
  const Eigen::Vector3d origin = X_VO * Eigen::Map<const Eigen::Vector3d>(plane->GetOrigin());
  const Eigen::Vector3d normal =
      X_VO.linear().inverse().transpose() * Eigen::Map<const Eigen::Vector3d>(plane->GetNormal());
  auto placed = vtkSmartPointer<vtkPlane>::New();
  placed->SetOrigin(origin.x(), origin.y(), origin.z());
  const Eigen::Vector3d unit = normal.normalized();
  placed->SetNormal(unit.x(), unit.y(), unit.z());
  return placed;
}

// By its name, without its module: both functions below are virtual.
vtkImageResliceMapper* ResliceOf(vtkAbstractMapper3D* mapper) {
  return mapper->IsA("vtkImageResliceMapper") ? static_cast<vtkImageResliceMapper*>(mapper)
                                              : nullptr;
}

} // namespace

PlacedPlanes::PlacedPlanes(vtkProp3D* prop, const Eigen::Affine3d& X_VO) {
  this->Place(prop, X_VO);
}

PlacedPlanes::~PlacedPlanes() {
  for (const Kept& kept : this->Kept_) {
    if (kept.clipping) {
      kept.mapper->SetClippingPlanes(kept.clipping);
    }
    if (kept.slice) {
      ResliceOf(kept.mapper)->SetSlicePlane(kept.slice);
    }
  }
}

void PlacedPlanes::Place(vtkProp3D* prop, const Eigen::Affine3d& X_VO) {
  if (auto* assembly = vtkAssembly::SafeDownCast(prop)) {
    vtkProp3DCollection* parts = assembly->GetParts();
    vtkCollectionSimpleIterator at;
    parts->InitTraversal(at);
    while (vtkProp3D* part = parts->GetNextProp3D(at)) {
      this->Place(part, X_VO);
    }
    return;
  }
  vtkAbstractMapper3D* mapper = MapperOf(prop);
  if (!mapper) {
    return;
  }
  Kept kept;
  kept.mapper = mapper;
  kept.clipping = mapper->GetClippingPlanes();
  if (kept.clipping) {
    vtkNew<vtkPlaneCollection> placed;
    vtkCollectionSimpleIterator at;
    kept.clipping->InitTraversal(at);
    while (vtkPlane* plane = kept.clipping->GetNextPlane(at)) {
      placed->AddItem(Placed(plane, X_VO));
    }
    mapper->SetClippingPlanes(placed);
  }
  if (auto* reslice = ResliceOf(mapper)) {
    kept.slice = reslice->GetSlicePlane();
    if (kept.slice) {
      reslice->SetSlicePlane(Placed(kept.slice, X_VO));
    }
  }
  if (kept.clipping || kept.slice) {
    this->Kept_.push_back(kept);
  }
}

} // namespace dspace
