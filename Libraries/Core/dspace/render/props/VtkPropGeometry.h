// A prop of VTK as an object of a scene: volumes, glyphs, image slices.
#ifndef DSPACE_RENDER_VTK_PROP_GEOMETRY_H
#define DSPACE_RENDER_VTK_PROP_GEOMETRY_H

#include <memory>
#include <string>

#include "vtkNew.h"
#include "vtkObject.h"
#include "vtkSmartPointer.h"
#include "vtkType.h"

#include <dspace/scene/CustomGeometry.h>

class vtkProp3D;

namespace dspace {

// The prop's coordinates, with its own position and user matrix, are the object's. A prop has one
// owner: while this lives, no other object and no renderer may have it.
class VtkPropGeometry : public CustomGeometry {
public:
  // Accepted: vtkActor, vtkVolume with a mapper that draws on the GPU, vtkImageSlice, and
  // vtkAssembly of these. Throws Error(InvalidArgument) or Error(Unsupported) naming `object` for
  // another one, for one without mapper, and for one that something else draws.
  VtkPropGeometry(vtkProp3D* prop, const std::string& object);
  VtkPropGeometry(const VtkPropGeometry&) = delete;
  VtkPropGeometry& operator=(const VtkPropGeometry&) = delete;
  ~VtkPropGeometry() override;

  // Bring the prop's pipeline up to date.
  BoundingSphere Bounds() const override;
  // Sees changes of all inputs of its mappers, such as the source of a vtkGlyph3DMapper, which
  // vtkProp::GetRedrawMTime leaves out.
  std::uint64_t Revision() const override;

  const vtkSmartPointer<vtkProp3D>& Prop() const { return this->Prop_; }
  // Throws Error(InvalidArgument) if a renderer or an assembly has taken the prop, too.
  void RequireOwned() const;
  // Changes of the prop since the last Revision() are those of its drawing, not the user's.
  void ForgetChanges() const;
  // What the drawers of the prop share.
  std::weak_ptr<void>& Resources() const { return this->Resources_; }

private:
  vtkSmartPointer<vtkProp3D> Prop_;
  std::string Object_;
  vtkNew<vtkObject> Owner_; // the prop's consumer
  mutable vtkMTimeType Seen_ = 0;
  mutable std::uint64_t Revision_ = 1;
  mutable std::weak_ptr<void> Resources_;
};

} // namespace dspace

#endif
