// The terrains among the ledger's objects.
#include <algorithm>

#include <dspace/Error.h>
#include <dspace/commands/terrain/ClipmapTerrainObject.h>
#include <dspace/ledger/LedgerObjects.h>
#include <dspace/messages/CommandTraits.h>
#include <dspace/messages/TrackMessages.h>
#include <dspace/state/State.h>

namespace dspace::session {
namespace {

const WheelTracks& TracksOf(const State* state, const std::string& scene,
                            const std::string& terrain) {
  if (state) {
    const auto of = state->scenes.find(scene);
    if (of != state->scenes.end()) {
      const auto found = of->second.terrains.find(terrain);
      if (found != of->second.terrains.end()) {
        if (const auto* clipmap = dynamic_cast<ClipmapTerrainObject*>(found->second.get())) {
          return clipmap->Surface().Tracks();
        }
      }
    }
  }
  throw Error(Error::Kind::Internal, "ledger",
              "terrain '" + terrain + "' of scene '" + scene +
                  "' has wheel tracks, and there is no state that holds them");
}

} // namespace

bool LedgerObjects::ChangeTerrain(const v1::Command& command, const v1::Reply& reply) {
  using C = v1::Command;
  const auto ground = [this](const std::string& name) -> Ground& {
    return this->Grounds_.at(name);
  };
  const auto layerOf = [](Ground& of, const std::string& name) {
    const auto found =
        std::find_if(of.layers.begin(), of.layers.end(),
                     [&](const v1::AddTerrainLayer& layer) { return layer.name() == name; });
    if (found == of.layers.end()) {
      throw Error(Error::Kind::Internal, "ledger", "it knows no layer '" + name + "'");
    }
    return found;
  };
  const auto insert = [&reply](Ground& into, const v1::AddTerrainLayer& layer) {
    const std::size_t at =
        std::min<std::size_t>(reply.terrain_layer().position(), into.layers.size());
    v1::AddTerrainLayer& added =
        *into.layers.insert(into.layers.begin() + std::ptrdiff_t(at), layer);
    added.clear_position();
    added.set_opacity(reply.terrain_layer().opacity());
    added.set_hidden(!reply.terrain_layer().visible());
  };
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  if (traits && traits->GetOwner() == CommandTraits::Owner::Terrain && traits->LatestIsKept()) {
    ground(traits->OwnerName(command)).latest.Keep(command);
    return true;
  }
  switch (command.command_case()) {
  case C::kTrackWheels:
    ground(command.track_wheels().terrain()).tracked = true;
    return true;
  case C::kLoadTracks:
    ground(command.load_tracks().terrain()).tracked = true;
    return true;
  case C::kRestoreTracks:
    ground(command.restore_tracks().terrain()).tracked = true;
    return true;
  case C::kClearTracks:
    ground(command.clear_tracks().terrain()).tracked = false;
    return true;
  case C::kAddTerrainLayer:
    insert(ground(command.add_terrain_layer().terrain()), command.add_terrain_layer());
    return true;
  case C::kChangeTerrainLayer: {
    Ground& of = ground(command.change_terrain_layer().terrain());
    const auto found = layerOf(of, command.change_terrain_layer().name());
    const v1::AddTerrainLayer layer = *found;
    of.layers.erase(found);
    insert(of, layer);
    return true;
  }
  case C::kRemoveTerrainLayer: {
    Ground& of = ground(command.remove_terrain_layer().terrain());
    of.layers.erase(layerOf(of, command.remove_terrain_layer().name()));
    return true;
  }
  default:
    return false;
  }
}

void LedgerObjects::PutTerrains(const std::string& scene, const State* state, Emit out) const {
  const auto add = [&]() -> v1::Command& {
    out.emplace_back().set_scene(scene);
    return out.back();
  };
  for (const auto& [name, ground] : this->Grounds_) {
    v1::Command open = ground.open;
    const Thing& thing = this->Things_.at(open.open_terrain().object_id());
    open.mutable_open_terrain()->set_frame(thing.frame);
    open.mutable_open_terrain()->set_fragment(thing.fragment);
    out.push_back(open);
    for (const std::string& opened : ground.opened) { // unless it has been removed
      if (std::none_of(ground.layers.begin(), ground.layers.end(),
                       [&opened](const v1::AddTerrainLayer& layer) {
                         return layer.name() == opened &&
                                layer.kind_case() == v1::AddTerrainLayer::KIND_NOT_SET;
                       })) {
        add().mutable_remove_terrain_layer()->set_terrain(name);
        out.back().mutable_remove_terrain_layer()->set_name(opened);
      }
    }
    for (std::size_t i = 0; i < ground.layers.size(); ++i) {
      const v1::AddTerrainLayer& layer = ground.layers[i];
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
      }
    }
    ground.latest.Put(scene, out);
    if (ground.tracked) {
      PutTracks(TracksOf(state, scene, name), scene, name, out);
    }
  }
}

} // namespace dspace::session
