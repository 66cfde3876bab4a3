#include <dspace/render/props/VtkPropGeometry.h>

#include <algorithm>

#include "vtkAbstractVolumeMapper.h"
#include "vtkActor.h"
#include "vtkAlgorithmOutput.h"
#include "vtkAssembly.h"
#include "vtkBoundingBox.h"
#include "vtkDemandDrivenPipeline.h"
#include "vtkImageMapper3D.h"
#include "vtkImageSlice.h"
#include "vtkMapper.h"
#include "vtkPlane.h"
#include "vtkPlaneCollection.h"
#include "vtkProp3D.h"
#include "vtkProp3DCollection.h"
#include "vtkShaderProperty.h"
#include "vtkVolume.h"

#include <dspace/Error.h>
#include <dspace/render/props/PropMapper.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {
namespace {

[[noreturn]] void RejectClass(const std::string& object, const std::string& found,
                              const char* accepted) {
  throw Error(Error::Kind::Unsupported, object, found + "; accepted: " + accepted);
}

void RequireMapper(const std::string& object, vtkProp3D* prop, bool mapper) {
  if (!mapper) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::string("its ") + prop->GetClassName() +
                    " has no mapper; accepted: one that has data to draw");
  }
}

void RequireInput(const std::string& object, vtkProp3D* prop) {
  vtkAbstractMapper3D* mapper = MapperOf(prop);
  if (mapper && mapper->GetNumberOfInputPorts() > 0 &&
      mapper->GetNumberOfInputConnections(0) == 0) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::string("its ") + mapper->GetClassName() +
                    " has no input; accepted: one that has data to draw");
  }
}

// Volumes are drawn with another depth than the scene's, by shaders that read it.
void CheckVolume(const std::string& object, vtkVolume* volume) {
  vtkAbstractVolumeMapper* mapper = volume->GetMapper();
  RequireMapper(object, volume, mapper != nullptr);
  if (!mapper->IsA("vtkGPUVolumeRayCastMapper") && !mapper->IsA("vtkSmartVolumeMapper")) {
    RejectClass(object, std::string("its volume has a ") + mapper->GetClassName(),
                "vtkGPUVolumeRayCastMapper, vtkSmartVolumeMapper");
  }
}

void CheckSlice(const std::string& object, vtkImageSlice* slice) {
  vtkImageMapper3D* mapper = slice->GetMapper();
  RequireMapper(object, slice, mapper != nullptr);
  if (mapper->GetSliceFacesCamera() || mapper->GetSliceAtFocalPoint()) {
    RejectClass(object, "its image slice follows the camera",
                "SliceFacesCameraOff() and SliceAtFocalPointOff()");
  }
}

void CheckProp(const std::string& object, vtkProp3D* prop) {
  static const char* const followers[] = {
      "vtkFollower", "vtkProp3DFollower",       "vtkAxisActor",      "vtkCubeAxesActor",
      "vtkSkybox",   "vtkBillboardTextActor3D", "vtkGridAxesActor3D"};
  for (const char* name : followers) {
    if (prop->IsA(name)) {
      RejectClass(object,
                  std::string(prop->GetClassName()) + " depends on the camera of a renderer",
                  "props that do not; labels and axes of the scene");
    }
  }
  if (auto* volume = vtkVolume::SafeDownCast(prop)) {
    CheckVolume(object, volume);
  } else if (auto* slice = vtkImageSlice::SafeDownCast(prop)) {
    if (slice->IsA("vtkImageStack")) {
      RejectClass(object, "it is a vtkImageStack", "its slices, one by one");
    }
    CheckSlice(object, slice);
  } else if (auto* actor = vtkActor::SafeDownCast(prop)) {
    vtkMapper* mapper = actor->GetMapper();
    RequireMapper(object, actor, mapper != nullptr);
    if (mapper->IsA("vtkOpenGLSphereMapper") || mapper->IsA("vtkOpenGLStickMapper")) {
      RejectClass(object, std::string("its ") + mapper->GetClassName() + " computes its own depth",
                  "mappers of polygons, vtkGlyph3DMapper");
    }
  } else if (auto* assembly = vtkAssembly::SafeDownCast(prop)) {
    vtkProp3DCollection* parts = assembly->GetParts();
    vtkCollectionSimpleIterator at;
    parts->InitTraversal(at);
    while (vtkProp3D* part = parts->GetNextProp3D(at)) {
      CheckProp(object, part);
    }
  } else {
    RejectClass(object, std::string("it is a ") + prop->GetClassName(),
                "vtkActor, vtkVolume, vtkImageSlice, vtkAssembly");
  }
  RequireInput(object, prop);
}

// The latest change of all that leads to any input of the mapper.
vtkMTimeType InputTime(vtkAlgorithm* mapper) {
  vtkMTimeType time = 0;
  for (int port = 0; port < mapper->GetNumberOfInputPorts(); ++port) {
    for (int i = 0; i < mapper->GetNumberOfInputConnections(port); ++i) {
      vtkAlgorithm* producer = mapper->GetInputConnection(port, i)->GetProducer();
      if (auto* pipeline = vtkDemandDrivenPipeline::SafeDownCast(producer->GetExecutive())) {
        pipeline->UpdatePipelineMTime();
        time = std::max(time, pipeline->GetPipelineMTime());
      }
    }
  }
  return time;
}

// VTK's time leaves out the planes that a mapper clips with, and a prop's shader code.
vtkMTimeType RedrawTime(vtkProp3D* prop) {
  vtkMTimeType time = prop->GetRedrawMTime();
  if (vtkAbstractMapper3D* mapper = MapperOf(prop)) {
    time = std::max(time, InputTime(mapper));
    if (vtkPlaneCollection* planes = mapper->GetClippingPlanes()) {
      vtkCollectionSimpleIterator at;
      planes->InitTraversal(at);
      while (vtkPlane* plane = planes->GetNextPlane(at)) {
        time = std::max(time, plane->GetMTime());
      }
    }
    time = std::max(time, prop->GetShaderProperty()->GetShaderMTime());
  }
  if (auto* assembly = vtkAssembly::SafeDownCast(prop)) {
    vtkProp3DCollection* parts = assembly->GetParts();
    vtkCollectionSimpleIterator at;
    parts->InitTraversal(at);
    while (vtkProp3D* part = parts->GetNextProp3D(at)) {
      time = std::max(time, RedrawTime(part));
    }
  }
  return time;
}

} // namespace

VtkPropGeometry::VtkPropGeometry(vtkProp3D* prop, const std::string& object)
    : Prop_(prop), Object_(object) {
  if (!prop) {
    throw Error(Error::Kind::InvalidArgument, object, "there is no prop; accepted: a vtkProp3D");
  }
  if (prop->GetNumberOfConsumers() > 0) {
    throw Error(Error::Kind::InvalidArgument, object,
                std::string("its ") + prop->GetClassName() +
                    " is also in a renderer, an assembly or a scene; accepted: one that nothing "
                    "else draws (vtkRenderer::RemoveViewProp)");
  }
  CheckProp(object, prop);
  prop->AddConsumer(this->Owner_);
  this->Seen_ = RedrawTime(prop);
}

VtkPropGeometry::~VtkPropGeometry() {
  this->Prop_->RemoveConsumer(this->Owner_);
}

BoundingSphere VtkPropGeometry::Bounds() const {
  // An assembly places its parts to compute its bounds, which VTK counts as changes of them.
  const bool seen = RedrawTime(this->Prop_) <= this->Seen_;
  const double* bounds = this->Prop_->GetBounds();
  if (seen) {
    this->ForgetChanges();
  }
  BoundingSphere sphere{};
  if (bounds && vtkBoundingBox::IsValid(bounds)) {
    const Eigen::Vector3d low(bounds[0], bounds[2], bounds[4]);
    const Eigen::Vector3d high(bounds[1], bounds[3], bounds[5]);
    sphere.center = 0.5 * (low + high);
    sphere.radius = 0.5 * (high - low).norm();
  }
  return sphere;
}

std::uint64_t VtkPropGeometry::Revision() const {
  const vtkMTimeType now = RedrawTime(this->Prop_);
  if (now > this->Seen_) {
    this->Seen_ = now;
    ++this->Revision_;
  }
  return this->Revision_;
}

void VtkPropGeometry::RequireOwned() const {
  if (this->Prop_->GetNumberOfConsumers() != 1) {
    throw Error(Error::Kind::InvalidArgument, this->Object_,
                std::string("its ") + this->Prop_->GetClassName() +
                    " has been added to a renderer, too; accepted: one that nothing else draws");
  }
}

void VtkPropGeometry::ForgetChanges() const {
  this->Seen_ = RedrawTime(this->Prop_);
}

} // namespace dspace
