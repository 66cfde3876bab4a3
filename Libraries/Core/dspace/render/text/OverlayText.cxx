#include <dspace/render/text/OverlayText.h>

#include "vtkCoordinate.h"
#include "vtkObjectFactory.h"
#include "vtkTextActor.h"
#include "vtkTextProperty.h"

#include <dspace/render/text/Fonts.h>

namespace dspace {
namespace {

class OverlayText : public vtkTextActor {
public:
  static OverlayText* New();
  vtkTypeMacro(OverlayText, vtkTextActor);

protected:
  bool RenderImage(vtkTextProperty* look, vtkViewport* viewport) override {
    const auto lock = LockTextRenderer();
    return this->Superclass::RenderImage(look, viewport);
  }
  bool GetImageBoundingBox(vtkTextProperty* look, vtkViewport* viewport, int box[4]) override {
    const auto lock = LockTextRenderer();
    return this->Superclass::GetImageBoundingBox(look, viewport, box);
  }
};

vtkStandardNewMacro(OverlayText);

} // namespace

std::unique_lock<std::recursive_mutex> LockTextRenderer() {
  static std::recursive_mutex one;
  return std::unique_lock<std::recursive_mutex>(one);
}

vtkSmartPointer<vtkTextActor> MakeOverlayText(const std::string& text, int fontSize,
                                              const std::array<double, 4>& color) {
  vtkSmartPointer<vtkTextActor> actor = vtkSmartPointer<OverlayText>::New();
  actor->SetInput(text.c_str());
  actor->SetTextScaleModeToNone();
  vtkTextProperty* look = actor->GetTextProperty();
  UseFont(look, Font::Mono);
  look->SetFontSize(fontSize);
  look->SetColor(color[0], color[1], color[2]);
  look->SetOpacity(color[3]);
  actor->GetPositionCoordinate()->SetCoordinateSystemToDisplay();
  return actor;
}

} // namespace dspace
