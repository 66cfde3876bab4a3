#include <dspace/render/VtkErrors.h>

#include "vtkObjectFactory.h"
#include "vtkOutputWindow.h"
#include "vtkSmartPointer.h"

#include <dspace/Error.h>

namespace dspace {
namespace {

class KeepingWindow : public vtkOutputWindow {
public:
  static KeepingWindow* New();
  vtkTypeMacro(KeepingWindow, vtkOutputWindow);
  void DisplayText(const char*) override {}
  void DisplayErrorText(const char* text) override {
    if (this->FirstError.empty()) {
      this->FirstError = text;
    }
  }
  void DisplayWarningText(const char*) override {}
  void DisplayGenericWarningText(const char*) override {}
  void DisplayDebugText(const char*) override {}
  std::string FirstError;
};
vtkStandardNewMacro(KeepingWindow);

} // namespace

struct VtkErrorTrap::Internals {
  vtkSmartPointer<vtkOutputWindow> before;
  vtkSmartPointer<KeepingWindow> window;
};

VtkErrorTrap::VtkErrorTrap() : Impl_(std::make_unique<Internals>()) {
  this->Impl_->before = vtkOutputWindow::GetInstance();
  this->Impl_->window = vtkSmartPointer<KeepingWindow>::New();
  vtkOutputWindow::SetInstance(this->Impl_->window);
}

VtkErrorTrap::~VtkErrorTrap() {
  vtkOutputWindow::SetInstance(this->Impl_->before);
}

void VtkErrorTrap::Check(const std::string& object) const {
  if (!this->Impl_->window->FirstError.empty()) {
    throw Error(Error::Kind::Internal, object, "VTK reported: " + this->Impl_->window->FirstError);
  }
}

} // namespace dspace
