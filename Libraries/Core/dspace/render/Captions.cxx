#include <dspace/render/Captions.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "vtkRenderer.h"
#include "vtkTextActor.h"
#include "vtkTextProperty.h"

#include <dspace/overlay/TextLimits.h>
#include <dspace/render/SceneDrawer.h>
#include <dspace/render/text/OverlayText.h>

namespace dspace {
namespace {

std::string KeyOf(const Caption& caption) {
  std::string key = std::to_string(caption.fontSize);
  for (const auto& color : {caption.color, caption.background}) {
    for (const double c : color) {
      key += ' ' + NumberText(c);
    }
  }
  return key + ' ' + caption.text;
}

vtkSmartPointer<vtkTextActor> MakeActor(const Caption& caption) {
  auto actor = MakeOverlayText(" " + caption.text + " ", caption.fontSize, caption.color);
  vtkTextProperty* look = actor->GetTextProperty();
  look->SetBackgroundColor(caption.background[0], caption.background[1], caption.background[2]);
  look->SetBackgroundOpacity(caption.background[3]);
  look->SetJustificationToCentered();
  look->SetVerticalJustificationToCentered();
  return actor;
}

} // namespace

std::array<double, 2> HalfSize(const Caption& caption) {
  const double characters = double(CharacterCount(caption.text)) + 2.0; // a blank at both ends
  return {0.5 * 0.61 * caption.fontSize * characters + 2.0, 0.65 * caption.fontSize + 2.0};
}

void LeaveOutOverlaps(std::vector<Caption>& captions) {
  std::vector<Caption> kept;
  kept.reserve(captions.size());
  for (Caption& caption : captions) {
    const std::array<double, 2> half = HalfSize(caption);
    const auto over = [&](const Caption& other) {
      const std::array<double, 2> others = HalfSize(other);
      return std::abs(caption.at[0] - other.at[0]) < half[0] + others[0] &&
             std::abs(caption.at[1] - other.at[1]) < half[1] + others[1];
    };
    if (!caption.yields || std::none_of(kept.begin(), kept.end(), over)) {
      kept.push_back(std::move(caption));
    }
  }
  captions = std::move(kept);
}

void LeaveOutCovered(std::vector<Caption>& captions, const std::vector<PictureBox>& boxes) {
  const auto covered = [&boxes](const Caption& caption) {
    const std::array<double, 2> half = HalfSize(caption);
    return std::any_of(boxes.begin(), boxes.end(), [&](const PictureBox& box) {
      return caption.at[0] + half[0] > box.left && caption.at[0] - half[0] < box.right &&
             caption.at[1] + half[1] > box.top && caption.at[1] - half[1] < box.bottom;
    });
  };
  captions.erase(std::remove_if(captions.begin(), captions.end(), covered), captions.end());
}

void CaptionActors::Show(const std::vector<Caption>& captions, vtkRenderer* overlay, int height) {
  auto before = std::move(this->Shown_);
  this->Shown_.clear();
  for (const Caption& caption : captions) {
    const std::string key = KeyOf(caption);
    vtkSmartPointer<vtkTextActor> actor;
    const auto found = before.find(key);
    if (found != before.end()) {
      actor = found->second;
      before.erase(found);
    } else {
      actor = MakeActor(caption);
      overlay->AddViewProp(actor);
    }
    // Display coordinates are pixels' lower left corners, y up.
    actor->SetPosition(caption.at[0] + 0.5, height - 0.5 - caption.at[1]);
    this->Shown_.emplace(key, actor);
  }
  for (const auto& old : before) {
    overlay->RemoveViewProp(old.second);
  }
}

std::vector<Caption> SceneDrawer::Captions(const DrawList& list, const DrawView& view,
                                           const RenderTarget& target, int samples) {
  std::vector<Caption> all;
  for (const DrawCustom& object : list.Customs()) {
    const std::vector<Caption> its = this->Customs_[object.object->custom.get()].drawer->Captions(
        this->Drawing(object, list, view, samples), target);
    all.insert(all.end(), its.begin(), its.end());
  }
  LeaveOutOverlaps(all);
  return all;
}

} // namespace dspace
