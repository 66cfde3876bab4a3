#include <dspace/commands/terrain/TerrainLayers.h>

#include <utility>
#include <vector>

#include <dspace/Error.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {

std::string TerrainLayers::FreeName(const std::string& wanted) const {
  std::string name = wanted;
  for (int n = 2; this->Has(name); ++n) {
    name = wanted + " " + std::to_string(n);
  }
  return name;
}

void TerrainLayers::Add(StackedLayer layer, std::optional<std::size_t> position,
                        v1::TerrainLayerReply about) {
  const std::string name = layer.name;
  this->Stack_->Add(std::move(layer), position);
  this->About_[name] = std::move(about);
}

void TerrainLayers::Remove(const std::string& name) {
  this->Stack_->Remove(name);
  this->About_.erase(name);
}

v1::TerrainLayerReply TerrainLayers::Describe(const StackedLayer& layer,
                                              std::size_t position) const {
  v1::TerrainLayerReply reply = this->About_.at(layer.name);
  reply.set_name(layer.name);
  reply.set_opacity(layer.opacity);
  reply.set_visible(layer.visible);
  reply.set_position(std::uint32_t(position));
  reply.set_nature(FromNature(layer.member.nature));
  reply.set_fragment(layer.member.fragment);
  reply.set_pixel_size(layer.layer->PixelSize());
  return reply;
}

v1::TerrainLayerReply TerrainLayers::Describe(const std::string& name) const {
  const std::vector<StackedLayer> layers = this->Stack_->Layers();
  std::string names;
  for (std::size_t i = 0; i < layers.size(); ++i) {
    if (layers[i].name == name) {
      return this->Describe(layers[i], i);
    }
    names += (i ? ", '" : "'") + layers[i].name + "'";
  }
  throw Error(Error::Kind::NotFound, "terrain '" + this->Terrain_ + "'",
              "it has no layer '" + name + "'; there are: " + (names.empty() ? "none" : names));
}

void TerrainLayers::Describe(v1::TerrainLayerList& list) const {
  const std::vector<StackedLayer> layers = this->Stack_->Layers();
  for (std::size_t i = 0; i < layers.size(); ++i) {
    *list.add_layer() = this->Describe(layers[i], i);
  }
}

} // namespace dspace::session
