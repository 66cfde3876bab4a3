// The colour layers of a clipmap with the data for commands: their kind and file.
#ifndef DSPACE_SESSION_TERRAIN_LAYERS_H
#define DSPACE_SESSION_TERRAIN_LAYERS_H

#include <cstddef>
#include <map>
#include <memory>
#include <optional>
#include <string>

#include <dspace/layers/LayerStack.h>
#include <dspace/proto/layers.pb.h>

namespace dspace::session {

class TerrainLayers {
public:
  // `terrain` is its name, for messages.
  TerrainLayers(std::string terrain, std::shared_ptr<LayerStack> stack)
      : Terrain_(std::move(terrain)), Stack_(std::move(stack)) {}

  LayerStack& Stack() { return *this->Stack_; }
  bool Has(const std::string& name) const { return this->About_.count(name) != 0; }
  // `wanted`, or with " 2", " 3", ... appended the first name that no layer has.
  std::string FreeName(const std::string& wanted) const;

  // `about` has the data that the stack does not store: kind, path, the ramp and its unit. Both
  // functions throw what LayerStack throws, and change nothing then.
  void Add(StackedLayer layer, std::optional<std::size_t> position, v1::TerrainLayerReply about);
  void Remove(const std::string& name);

  // Throws Error(NotFound) that names the existing layers.
  v1::TerrainLayerReply Describe(const std::string& name) const;
  void Describe(v1::TerrainLayerList& list) const; // bottom first

private:
  v1::TerrainLayerReply Describe(const StackedLayer& layer, std::size_t position) const;

  std::string Terrain_;
  std::shared_ptr<LayerStack> Stack_;
  std::map<std::string, v1::TerrainLayerReply> About_; // by name
};

} // namespace dspace::session

#endif
