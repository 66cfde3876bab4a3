#include <dspace/render/props/VtkPropDrawer.h>

#include "vtkDspaceHubWindow.h"
#include "vtkProp3D.h"

#include <dspace/render/CustomDrawers.h>
#include <dspace/render/props/PropCanvas.h>
#include <dspace/render/props/VtkPropGeometry.h>

namespace dspace {

void RegisterVtkPropDrawer(CustomDrawers& drawers) {
  const auto shared = std::make_shared<std::weak_ptr<PropCanvas>>();
  drawers.Register(typeid(VtkPropGeometry),
                   [shared](const std::shared_ptr<const CustomGeometry>& geometry)
                       -> std::unique_ptr<CustomDrawer> {
                     return std::make_unique<VtkPropDrawer>(
                         static_cast<const VtkPropGeometry&>(*geometry), shared);
                   });
}

// What VTK has on the GPU for a prop, for all viewports.
struct VtkPropDrawer::Resources {
  vtkSmartPointer<vtkProp3D> prop;
  vtkDspaceHubWindow* window;

  Resources(vtkProp3D* of, vtkDspaceHubWindow* in) : prop(of), window(in) {}
  Resources(const Resources&) = delete;
  Resources& operator=(const Resources&) = delete;
  ~Resources() {
    if (this->window->GetContext()) {
      this->window->MakeCurrent();
      this->prop->ReleaseGraphicsResources(this->window);
    }
  }
};

VtkPropDrawer::VtkPropDrawer(const VtkPropGeometry& geometry, Shared shared)
    : Geometry_(&geometry), Shared_(std::move(shared)) {}

VtkPropDrawer::~VtkPropDrawer() = default;

bool VtkPropDrawer::Prepare(const CustomDrawing& drawing) {
  if (!this->Canvas_) {
    this->Canvas_ = this->Shared_->lock();
    if (!this->Canvas_) {
      this->Canvas_ = std::make_shared<PropCanvas>(drawing.window);
      *this->Shared_ = this->Canvas_;
    }
  }
  if (!this->Resources_) {
    std::weak_ptr<void>& known = this->Geometry_->Resources();
    this->Resources_ = std::static_pointer_cast<Resources>(known.lock());
    if (!this->Resources_) {
      this->Resources_ = std::make_shared<Resources>(this->Geometry_->Prop(), drawing.window);
      known = this->Resources_;
    }
  }
  this->Geometry_->RequireOwned();
  return true;
}

void VtkPropDrawer::DrawColor(const CustomDrawing& drawing) {
  if (this->Geometry_->Prop()->GetVisibility()) {
    this->Geometry_->Revision(); // the user's changes so far
    if (drawing.light) {
      this->Canvas_->DrawLinear(this->Geometry_->Prop(), drawing);
    } else {
      this->Canvas_->DrawOpaque(this->Geometry_->Prop(), drawing);
    }
    this->Geometry_->ForgetChanges();
  }
}

void VtkPropDrawer::DrawTranslucent(const CustomDrawing& drawing, const RenderTarget& target) {
  vtkProp3D* prop = this->Geometry_->Prop();
  if (prop->GetVisibility() && (prop->IsA("vtkVolume") || prop->IsA("vtkAssembly") ||
                                prop->HasTranslucentPolygonalGeometry())) {
    this->Geometry_->Revision();
    this->Canvas_->DrawTranslucent(prop, drawing, target);
    this->Geometry_->ForgetChanges();
  }
}

void VtkPropDrawer::DrawLabels(const CustomDrawing& drawing) {
  vtkProp3D* prop = this->Geometry_->Prop();
  if (prop->GetVisibility() && !prop->IsA("vtkVolume")) {
    this->Geometry_->Revision();
    if (drawing.view.clip) {
      this->Canvas_->DrawShadow(prop, drawing);
      this->Geometry_->ForgetChanges();
      return;
    }
    const bool parts = drawing.list.Filter().partsOf != 0; // labels are those of its parts
    this->Canvas_->DrawLabel(prop, drawing, parts ? 0 : drawing.object.object->id);
    this->Geometry_->ForgetChanges();
  }
}

} // namespace dspace
