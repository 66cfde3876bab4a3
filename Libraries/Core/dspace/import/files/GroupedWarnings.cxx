#include <dspace/import/files/GroupedWarnings.h>

#include <algorithm>

namespace dspace {

void GroupedWarnings::Add(const std::string& kind, const std::string& place) {
  constexpr std::size_t mostPlaces = 5;
  auto found = std::find_if(this->Kinds_.begin(), this->Kinds_.end(),
                            [&](const Kind& each) { return each.text == kind; });
  if (found == this->Kinds_.end()) {
    this->Kinds_.push_back({kind, {}, 0});
    found = std::prev(this->Kinds_.end());
  }
  ++found->count;
  if (found->places.size() < mostPlaces) {
    found->places.push_back(place);
  }
}

std::vector<std::string> GroupedWarnings::Texts() const {
  std::vector<std::string> texts;
  for (const Kind& kind : this->Kinds_) {
    std::string text = kind.text + ": ";
    for (std::size_t i = 0; i < kind.places.size(); ++i) {
      text += (i == 0 ? "" : ", ") + kind.places[i];
    }
    const std::size_t more = kind.count - kind.places.size();
    texts.push_back(text + (more > 0 ? " and " + std::to_string(more) + " more" : ""));
  }
  return texts;
}

} // namespace dspace
