// The terrains of one scene, for the ledger.
#ifndef DSPACE_SESSION_LEDGER_TERRAINS_H
#define DSPACE_SESSION_LEDGER_TERRAINS_H

#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <dspace/ledger/LatestCommands.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {

struct State;

// Not a public header.
class LedgerTerrains {
public:
  using Emit = std::vector<v1::Command>&;

  void Open(const v1::Command& command);
  void Remove(const std::string& name) { this->Terrains_.erase(name); }
  // The id of the object that draws the terrain. Empty: there is no such terrain.
  std::optional<std::uint32_t> ObjectOf(const std::string& name) const;
  // Applies a command that changes one terrain. False for other commands.
  bool Change(const v1::Command& command, const v1::Reply& reply);

  // Where the object of a terrain is now.
  struct Placement {
    std::uint64_t frame = 0;
    std::string fragment;
  };
  using PlacementOf = std::function<Placement(std::uint32_t object)>;
  // `state`: as the ledger's.
  void Put(const std::string& scene, const State* state, const PlacementOf& placementOf,
           Emit out) const;

private:
  struct Terrain {
    v1::Command open;
    LatestCommands latest;
    bool tracked = false; // it has wheel tracks
    std::vector<v1::AddTerrainField> fields;
    // Bottom first. A layer without a kind is one that the terrain opened with.
    std::vector<v1::AddTerrainLayer> layers;
    std::vector<std::string> opened; // names of the layers that it opened with: "drape", "filled"
  };
  std::map<std::string, Terrain> Terrains_;
};

} // namespace dspace::session

#endif
