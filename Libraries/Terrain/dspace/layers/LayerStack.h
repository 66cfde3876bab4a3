// The colour layers of one terrain, bottom first.
#ifndef DSPACE_LAYERS_LAYERSTACK_H
#define DSPACE_LAYERS_LAYERSTACK_H

#include <cstddef>
#include <cstdint>
#include <memory>
#include <mutex>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include <dspace/layers/ColorLayer.h>
#include <dspace/scene/Membership.h>

namespace dspace {

struct StackedLayer {
  std::string name; // unique in its stack
  std::shared_ptr<const ColorLayer> layer;
  double opacity = 1.0; // 0 to 1
  bool visible = true;
  Membership member = {};
  // Marks what the others show: painted over all of them and over the terrain's style, wherever it
  // stands in the stack.
  bool mark = false;
};

// Which layers of a stack are composed, of those that are visible with an opacity over 0.
struct LayerChoice {
  enum class Part {
    All,      // of the colours
    Unmarked, // without marks
    Marks,    // marks alone
    Normals   // layers of normals, which no other part has
  };
  Part part = Part::All;
  std::set<std::string> hiddenFragments; // layers in these are left out

  bool Takes(const StackedLayer& layer) const;
  bool operator<(const LayerChoice& o) const {
    return this->part != o.part ? this->part < o.part : this->hiddenFragments < o.hiddenFragments;
  }
};

// Any thread may call. Each change makes a new revision.
class LayerStack {
public:
  static constexpr std::size_t Most = 64;

  explicit LayerStack(std::string terrain) : Terrain_(std::move(terrain)) {}

  // On top, or at `position` from the bottom (0). Throws Error(InvalidArgument) naming the terrain
  // for an empty or taken name, an opacity out of range, a position beyond the top, or more than
  // Most layers.
  void Add(StackedLayer layer, std::optional<std::size_t> position = std::nullopt);
  // Changes a layer; absent values stay. Throws as Add does, and NotFound for an unknown name. An
  // error changes nothing. The caller has checked the fragment.
  void Change(const std::string& name, std::optional<double> opacity, std::optional<bool> visible,
              std::optional<std::size_t> position,
              const std::optional<std::string>& fragment = std::nullopt);
  void Remove(const std::string& name); // throws Error(NotFound)

  // A copy, bottom first; into `revision`, where it is given, which one they are of.
  std::vector<StackedLayer> Layers(std::uint64_t* revision = nullptr) const;
  std::uint64_t Revision() const;
  // Whether the choice takes no layer.
  bool Empty(const LayerChoice& choice = {}) const;
  // The least PixelSize() of the layers that the choice takes; infinity without any.
  double PixelSize(const LayerChoice& choice = {}) const;
  // The choice of the same layers that names nothing that makes no difference.
  LayerChoice Reduced(const LayerChoice& choice) const;

private:
  std::size_t Find(const std::string& name) const;

  std::string Terrain_; // for messages
  mutable std::mutex Mutex_;
  std::vector<StackedLayer> Layers_;
  std::uint64_t Revision_ = 0;
};

} // namespace dspace

#endif
