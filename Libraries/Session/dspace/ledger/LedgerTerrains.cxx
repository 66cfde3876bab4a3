#include <dspace/ledger/LedgerTerrains.h>

#include <algorithm>

#include <dspace/Error.h>
#include <dspace/messages/CommandTraits.h>
#include <dspace/messages/TrackMessages.h>
#include <dspace/state/State.h>

namespace dspace::session {
namespace {

const TrackedGround& GroundOf(const State* state, const std::string& scene,
                              const std::string& terrain) {
  if (state) {
    const auto of = state->scenes.find(scene);
    if (of != state->scenes.end()) {
      const auto found = of->second.terrains.find(terrain);
      if (found != of->second.terrains.end()) {
        return found->second->Ground();
      }
    }
  }
  throw Error(Error::Kind::Internal, "ledger",
              "terrain '" + terrain + "' of scene '" + scene +
                  "' has wheel tracks, but there is no state to read them from");
}

} // namespace

void LedgerTerrains::Open(const v1::Command& command) {
  const v1::OpenTerrain& open = command.open_terrain();
  Terrain& terrain = this->Terrains_[open.name()];
  terrain.open = command;
  if (open.mode() == v1::OpenTerrain::CLIPMAP) {
    if (open.has_drape()) {
      terrain.opened.emplace_back("drape");
    }
    if (open.has_fill_holes()) {
      terrain.opened.emplace_back("filled");
    }
  }
  for (const std::string& name : terrain.opened) {
    terrain.layers.emplace_back().set_name(name);
  }
}

std::optional<std::uint32_t> LedgerTerrains::ObjectOf(const std::string& name) const {
  const auto found = this->Terrains_.find(name);
  if (found == this->Terrains_.end()) {
    return std::nullopt;
  }
  return found->second.open.open_terrain().object_id();
}

bool LedgerTerrains::Change(const v1::Command& command, const v1::Reply& reply) {
  using C = v1::Command;
  const auto terrain = [this](const std::string& name) -> Terrain& {
    return this->Terrains_.at(name);
  };
  const auto layerOf = [](Terrain& of, const std::string& name) {
    const auto found =
        std::find_if(of.layers.begin(), of.layers.end(),
                     [&](const v1::AddTerrainLayer& layer) { return layer.name() == name; });
    if (found == of.layers.end()) {
      throw Error(Error::Kind::Internal, "ledger", "there is no layer '" + name + "'");
    }
    return found;
  };
  const auto insert = [&reply](Terrain& into, const v1::AddTerrainLayer& layer) {
    const std::size_t at =
        std::min<std::size_t>(reply.terrain_layer().position(), into.layers.size());
    v1::AddTerrainLayer& added =
        *into.layers.insert(into.layers.begin() + std::ptrdiff_t(at), layer);
    added.clear_position();
    added.set_opacity(reply.terrain_layer().opacity());
    added.set_hidden(!reply.terrain_layer().visible());
    added.set_fragment(reply.terrain_layer().fragment());
  };
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  if (traits && traits->GetOwner() == CommandTraits::Owner::Terrain && traits->LatestIsKept()) {
    terrain(traits->OwnerName(command)).latest.Set(command);
    return true;
  }
  switch (command.command_case()) {
  case C::kTrackWheels:
    terrain(command.track_wheels().terrain()).tracked = true;
    return true;
  case C::kLoadTracks:
    terrain(command.load_tracks().terrain()).tracked = true;
    return true;
  case C::kRestoreTracks:
    terrain(command.restore_tracks().terrain()).tracked = true;
    return true;
  case C::kClearTracks:
    terrain(command.clear_tracks().terrain()).tracked = false;
    return true;
  case C::kAddTerrainField:
    terrain(command.add_terrain_field().terrain()).fields.push_back(command.add_terrain_field());
    return true;
  case C::kRemoveTerrainField: {
    std::vector<v1::AddTerrainField>& fields =
        terrain(command.remove_terrain_field().terrain()).fields;
    fields.erase(std::remove_if(fields.begin(), fields.end(),
                                [&](const v1::AddTerrainField& field) {
                                  return field.name() == command.remove_terrain_field().name();
                                }),
                 fields.end());
    return true;
  }
  case C::kAddTerrainLayer:
    insert(terrain(command.add_terrain_layer().terrain()), command.add_terrain_layer());
    return true;
  case C::kChangeTerrainLayer: {
    Terrain& of = terrain(command.change_terrain_layer().terrain());
    const auto found = layerOf(of, command.change_terrain_layer().name());
    const v1::AddTerrainLayer layer = *found;
    of.layers.erase(found);
    insert(of, layer);
    return true;
  }
  case C::kRemoveTerrainLayer: {
    Terrain& of = terrain(command.remove_terrain_layer().terrain());
    of.layers.erase(layerOf(of, command.remove_terrain_layer().name()));
    return true;
  }
  default:
    return false;
  }
}

void LedgerTerrains::Put(const std::string& scene, const State* state,
                         const PlacementOf& placementOf, Emit out) const {
  const auto add = [&]() -> v1::Command& {
    out.emplace_back().set_scene(scene);
    return out.back();
  };
  for (const auto& [name, terrain] : this->Terrains_) {
    v1::Command open = terrain.open;
    const Placement placement = placementOf(open.open_terrain().object_id());
    open.mutable_open_terrain()->set_frame(placement.frame);
    open.mutable_open_terrain()->set_fragment(placement.fragment);
    out.push_back(open);
    for (const std::string& opened : terrain.opened) { // unless it has been removed
      if (std::none_of(terrain.layers.begin(), terrain.layers.end(),
                       [&opened](const v1::AddTerrainLayer& layer) {
                         return layer.name() == opened &&
                                layer.kind_case() == v1::AddTerrainLayer::KIND_NOT_SET;
                       })) {
        add().mutable_remove_terrain_layer()->set_terrain(name);
        out.back().mutable_remove_terrain_layer()->set_name(opened);
      }
    }
    for (const v1::AddTerrainField& field : terrain.fields) { // before layers that show them
      *add().mutable_add_terrain_field() = field;
    }
    for (std::size_t i = 0; i < terrain.layers.size(); ++i) {
      const v1::AddTerrainLayer& layer = terrain.layers[i];
      if (layer.kind_case() != v1::AddTerrainLayer::KIND_NOT_SET) {
        v1::AddTerrainLayer* added = add().mutable_add_terrain_layer();
        *added = layer;
        added->set_position(std::uint32_t(i));
      } else if (layer.has_opacity()) { // one that it opens with, changed
        v1::ChangeTerrainLayer* change = add().mutable_change_terrain_layer();
        change->set_terrain(name);
        change->set_name(layer.name());
        change->set_position(std::uint32_t(i));
        change->set_opacity(layer.opacity());
        change->set_visible(!layer.hidden());
        change->set_fragment(layer.fragment());
      }
    }
    terrain.latest.Put(scene, out);
    if (terrain.tracked) {
      PutTracks(GroundOf(state, scene, name), scene, name, out);
    }
  }
}

} // namespace dspace::session
