#include <dspace/render/text/ColorBars.h>

#include "vtkActor2D.h"
#include "vtkCellArray.h"
#include "vtkCoordinate.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPoints.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper2D.h"
#include "vtkPropCollection.h"
#include "vtkRenderer.h"
#include "vtkTextActor.h"
#include "vtkTextProperty.h"
#include "vtkUnsignedCharArray.h"

#include <dspace/render/text/Fonts.h>
#include <dspace/render/text/OverlayText.h>

namespace dspace {
namespace {

unsigned char Byte(double fraction) {
  return static_cast<unsigned char>(255.0 * fraction + 0.5);
}

// Boxes of whole pixels, each of one colour.
class Boxes {
public:
  Boxes() { this->Colors_->SetNumberOfComponents(4); }
  void Add(const ColorBarLayout::Box& box, const std::array<double, 4>& color) {
    const double x[4] = {0, double(box.width), double(box.width), 0};
    const double y[4] = {0, 0, double(box.height), double(box.height)};
    this->Quads_->InsertNextCell(4);
    for (int i = 0; i < 4; ++i) {
      this->Quads_->InsertCellPoint(this->Points_->InsertNextPoint(box.x + x[i], box.y + y[i], 0));
      this->Colors_->InsertNextTuple4(Byte(color[0]), Byte(color[1]), Byte(color[2]),
                                      Byte(color[3]));
    }
  }
  vtkSmartPointer<vtkProp> Prop(int x, int y) const {
    vtkNew<vtkPolyData> data;
    data->SetPoints(this->Points_);
    data->SetPolys(this->Quads_);
    data->GetPointData()->SetScalars(this->Colors_);
    vtkNew<vtkPolyDataMapper2D> mapper;
    mapper->SetInputData(data);
    mapper->SetColorModeToDirectScalars();
    auto actor = vtkSmartPointer<vtkActor2D>::New();
    actor->SetMapper(mapper);
    actor->GetPositionCoordinate()->SetCoordinateSystemToDisplay();
    actor->SetPosition(x, y);
    return actor;
  }

private:
  vtkNew<vtkPoints> Points_;
  vtkNew<vtkCellArray> Quads_;
  vtkNew<vtkUnsignedCharArray> Colors_;
};

// Background, frame, the bar pixel by pixel, marks.
vtkSmartPointer<vtkProp> BoxesOf(const ColorBar& bar, const ColorBarLayout& layout, int x, int y) {
  Boxes boxes;
  boxes.Add({0, 0, layout.width, layout.height}, bar.backgroundColor);
  const ColorBarLayout::Box& at = layout.bar;
  boxes.Add({at.x - 1, at.y - 1, at.width + 2, 1}, bar.textColor);
  boxes.Add({at.x - 1, at.y + at.height, at.width + 2, 1}, bar.textColor);
  boxes.Add({at.x - 1, at.y, 1, at.height}, bar.textColor);
  boxes.Add({at.x + at.width, at.y, 1, at.height}, bar.textColor);
  for (int i = 0; i < bar.length; ++i) {
    const auto color = bar.ColorAt(bar.low + (i + 0.5) / bar.length * (bar.high - bar.low));
    boxes.Add(bar.horizontal ? ColorBarLayout::Box{at.x + i, at.y, 1, at.height}
                             : ColorBarLayout::Box{at.x, at.y + i, at.width, 1},
              {color[0], color[1], color[2], 1.0});
  }
  for (const ColorBarLayout::Box& mark : layout.marks) {
    boxes.Add(mark, bar.textColor);
  }
  return boxes.Prop(x, y);
}

vtkSmartPointer<vtkProp> TextOf(const ColorBar& bar, const ColorBarLayout::Text& text, int x,
                                int y) {
  auto actor = MakeOverlayText(text.text, bar.fontSize, bar.textColor);
  vtkTextProperty* look = actor->GetTextProperty();
  text.centered ? look->SetJustificationToCentered() : look->SetJustificationToLeft();
  look->SetVerticalJustificationToCentered();
  actor->SetPosition(x + text.x, y + text.y);
  return actor;
}

// The lower left corner, y up.
std::array<int, 2> CornerOf(const ColorBar& bar, const ColorBarLayout& layout, int width,
                            int height) {
  using Anchor = TextTable::Anchor;
  const bool left = bar.anchor == Anchor::TopLeft || bar.anchor == Anchor::BottomLeft;
  const bool top = bar.anchor == Anchor::TopLeft || bar.anchor == Anchor::TopRight;
  return {left ? bar.margin : width - bar.margin - layout.width,
          top ? height - bar.margin - layout.height : bar.margin};
}

std::vector<vtkSmartPointer<vtkProp>> PropsOf(const ColorBar& bar, int width, int height) {
  const ColorBarLayout layout = LayOut(bar);
  const auto [x, y] = CornerOf(bar, layout, width, height);
  std::vector<vtkSmartPointer<vtkProp>> props = {BoxesOf(bar, layout, x, y)};
  for (const ColorBarLayout::Text& text : layout.texts) {
    props.push_back(TextOf(bar, text, x, y));
  }
  return props;
}

} // namespace

bool ColorBars::Set(const ColorBar& bar, vtkRenderer* overlay, int width, int height) {
  bar.Check();
  const auto found = this->Placed_.find(bar.name);
  if (found != this->Placed_.end() && found->second.bar == bar) {
    return false;
  }
  const std::string object = "colour bar '" + bar.name + "'";
  RequireGlyphs(object, "its title", bar.title, Font::Mono);
  RequireGlyphs(object, "its unit", bar.unit, Font::Mono);
  auto props = PropsOf(bar, width, height);
  this->Remove(bar.name, overlay);
  for (const auto& prop : props) {
    overlay->AddViewProp(prop);
  }
  this->Placed_[bar.name] = {bar, std::move(props)};
  return true;
}

bool ColorBars::Remove(const std::string& name, vtkRenderer* overlay) {
  const auto found = this->Placed_.find(name);
  if (found == this->Placed_.end()) {
    return false;
  }
  for (const auto& prop : found->second.props) {
    overlay->RemoveViewProp(prop);
  }
  this->Placed_.erase(found);
  return true;
}

void ColorBars::Resize(vtkRenderer* overlay, int width, int height) {
  const auto placed = std::move(this->Placed_);
  this->Placed_.clear();
  for (const auto& entry : placed) {
    for (const auto& prop : entry.second.props) {
      overlay->RemoveViewProp(prop);
    }
    this->Set(entry.second.bar, overlay, width, height);
  }
}

void ColorBars::ShowIf(const std::function<bool(const ColorBar&)>& shown) const {
  for (const auto& entry : this->Placed_) {
    const bool visible = shown(entry.second.bar);
    for (const auto& prop : entry.second.props) {
      prop->SetVisibility(visible);
    }
  }
}

std::vector<PictureBox> ColorBars::Covered(int width, int height) const {
  std::vector<PictureBox> boxes;
  for (const auto& entry : this->Placed_) {
    if (entry.second.props.front()->GetVisibility()) {
      const ColorBarLayout layout = LayOut(entry.second.bar);
      const auto [x, y] = CornerOf(entry.second.bar, layout, width, height);
      boxes.push_back({double(x), double(height - y - layout.height), double(x + layout.width),
                       double(height - y)});
    }
  }
  return boxes;
}

void ColorBars::Raise(vtkRenderer* overlay) const {
  vtkPropCollection* all = overlay->GetViewProps(); // RemoveViewProp would release their textures
  for (const auto& entry : this->Placed_) {
    for (const auto& prop : entry.second.props) {
      const vtkSmartPointer<vtkProp> held = prop.Get();
      all->RemoveItem(held);
      all->AddItem(held);
    }
  }
}

} // namespace dspace
