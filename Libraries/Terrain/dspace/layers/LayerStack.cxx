#include <dspace/layers/LayerStack.h>

#include <algorithm>
#include <limits>

#include <dspace/Error.h>

namespace dspace {
namespace {

std::string Object(const std::string& terrain) {
  return "colour layers of " + terrain;
}

void CheckOpacity(const std::string& terrain, const std::string& name, double opacity) {
  if (!(opacity >= 0.0 && opacity <= 1.0)) {
    throw Error(Error::Kind::InvalidArgument, Object(terrain),
                "an opacity of " + std::to_string(opacity) + " for '" + name +
                    "' is rejected; accepted is 0 to 1");
  }
}

void CheckPosition(const std::string& terrain, const std::string& name, std::size_t position,
                   std::size_t top) {
  if (position > top) {
    throw Error(Error::Kind::InvalidArgument, Object(terrain),
                "position " + std::to_string(position) + " for '" + name +
                    "' is rejected; accepted is 0 (bottom) to " + std::to_string(top) + " (top)");
  }
}

bool Seen(const StackedLayer& layer) {
  return layer.visible && layer.opacity > 0.0;
}

bool HasContent(const LayerChoice& choice, const StackedLayer& layer) {
  return (choice.part == LayerChoice::Part::Normals) ==
         (layer.layer->Content() == LayerContent::Normals);
}

} // namespace

bool LayerChoice::Takes(const StackedLayer& layer) const {
  return Seen(layer) && HasContent(*this, layer) &&
         (this->part == Part::All || this->part == Part::Normals ||
          (this->part == Part::Marks) == layer.mark) &&
         this->hiddenFragments.count(layer.member.fragment) == 0;
}

void LayerStack::Add(StackedLayer layer, std::optional<std::size_t> position) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  const std::size_t count = this->Layers_.size();
  if (layer.name.empty()) {
    throw Error(Error::Kind::InvalidArgument, Object(this->Terrain_),
                "a layer has no name; accepted: a name that no other layer has");
  }
  for (const StackedLayer& other : this->Layers_) {
    if (other.name == layer.name) {
      throw Error(Error::Kind::InvalidArgument, Object(this->Terrain_),
                  "the name '" + layer.name +
                      "' is taken; accepted: one that other layers do not "
                      "have");
    }
  }
  if (!layer.layer) {
    throw Error(Error::Kind::InvalidArgument, Object(this->Terrain_),
                "'" + layer.name + "' has nothing to show; a layer is needed");
  }
  CheckOpacity(this->Terrain_, layer.name, layer.opacity);
  if (count >= Most) {
    throw Error(Error::Kind::InvalidArgument, Object(this->Terrain_),
                "'" + layer.name + "' would be one too many; accepted are " + std::to_string(Most) +
                    " layers");
  }
  const std::size_t at = position.value_or(count);
  CheckPosition(this->Terrain_, layer.name, at, count);
  this->Layers_.insert(this->Layers_.begin() + static_cast<std::ptrdiff_t>(at), std::move(layer));
  ++this->Revision_;
}

void LayerStack::Change(const std::string& name, std::optional<double> opacity,
                        std::optional<bool> visible, std::optional<std::size_t> position,
                        const std::optional<std::string>& fragment) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  const std::size_t from = this->Find(name);
  const std::size_t to = position.value_or(from);
  CheckPosition(this->Terrain_, name, to, this->Layers_.size() - 1);
  StackedLayer& layer = this->Layers_[from];
  CheckOpacity(this->Terrain_, name, opacity.value_or(layer.opacity));
  layer.opacity = opacity.value_or(layer.opacity);
  layer.visible = visible.value_or(layer.visible);
  layer.member.fragment = fragment.value_or(layer.member.fragment);
  const auto begin = this->Layers_.begin();
  const auto at = [&](std::size_t i) { return begin + static_cast<std::ptrdiff_t>(i); };
  if (to > from) {
    std::rotate(at(from), at(from + 1), at(to + 1));
  } else {
    std::rotate(at(to), at(from), at(from + 1));
  }
  ++this->Revision_;
}

void LayerStack::Remove(const std::string& name) {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Layers_.erase(this->Layers_.begin() + static_cast<std::ptrdiff_t>(this->Find(name)));
  ++this->Revision_;
}

std::vector<StackedLayer> LayerStack::Layers(std::uint64_t* revision) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  if (revision) {
    *revision = this->Revision_;
  }
  return this->Layers_;
}

std::uint64_t LayerStack::Revision() const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return this->Revision_;
}

bool LayerStack::Empty(const LayerChoice& choice) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  return std::none_of(this->Layers_.begin(), this->Layers_.end(),
                      [&](const StackedLayer& layer) { return choice.Takes(layer); });
}

LayerChoice LayerStack::Reduced(const LayerChoice& choice) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  LayerChoice reduced;
  bool marks = false;
  for (const StackedLayer& layer : this->Layers_) {
    if (!Seen(layer) || !HasContent(choice, layer)) {
      continue;
    }
    marks = marks || layer.mark;
    if (choice.hiddenFragments.count(layer.member.fragment)) {
      reduced.hiddenFragments.insert(layer.member.fragment);
    }
  }
  const bool same = choice.part == LayerChoice::Part::Unmarked && !marks;
  reduced.part = same ? LayerChoice::Part::All : choice.part;
  return reduced;
}

double LayerStack::PixelSize(const LayerChoice& choice) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  double finest = std::numeric_limits<double>::infinity();
  for (const StackedLayer& layer : this->Layers_) {
    if (choice.Takes(layer)) {
      finest = std::min(finest, layer.layer->PixelSize());
    }
  }
  return finest;
}

// With the lock held.
std::size_t LayerStack::Find(const std::string& name) const {
  const auto found = std::find_if(this->Layers_.begin(), this->Layers_.end(),
                                  [&](const StackedLayer& layer) { return layer.name == name; });
  if (found != this->Layers_.end()) {
    return static_cast<std::size_t>(found - this->Layers_.begin());
  }
  std::string names;
  for (const StackedLayer& layer : this->Layers_) {
    names += (names.empty() ? "'" : ", '") + layer.name + "'";
  }
  throw Error(Error::Kind::NotFound, Object(this->Terrain_),
              "it has none named '" + name + "'; " +
                  (names.empty() ? std::string("it has none at all") : "it has " + names));
}

} // namespace dspace
