// The objects of one scene, for the ledger.
#ifndef DSPACE_SESSION_LEDGER_OBJECTS_H
#define DSPACE_SESSION_LEDGER_OBJECTS_H

#include <map>
#include <optional>
#include <set>
#include <string>
#include <unordered_set>
#include <vector>

#include <dspace/ledger/LatestCommands.h>
#include <dspace/ledger/LedgerFrames.h>
#include <dspace/ledger/LedgerTerrains.h>
#include <dspace/scene/Trail.h>

namespace dspace::session {

struct State;

class LedgerObjects {
public:
  using Emit = std::vector<v1::Command>&;

  // Adds an import, primitive, mesh, text or trail.
  void Create(const v1::Command& command, v1::ObjectSettings settings);
  // The objects of a robot, or of a model, with its key (LedgerRobot).
  void Load(const std::string& key, const v1::Command& load, const v1::RobotReply& about);
  void Open(const v1::Command& command);
  void RemoveObject(std::uint32_t id);
  void RemoveTerrain(const std::string& name);
  void RemoveOn(const LedgerFrames::Removed& removed);
  // Applies a command that changes one object or terrain. False for other commands.
  bool Change(const v1::Command& command, const v1::Reply& reply);

  // The id of the object that draws the terrain. Empty: there is no such terrain.
  std::optional<std::uint32_t> TerrainObject(const std::string& terrain) const {
    return this->Terrains_.ObjectOf(terrain);
  }

  // Appends the commands for visuals of removed robots. They come before those for frames.
  void PutOrphanedVisuals(const std::string& scene, const std::vector<std::string>& fragments,
                          Emit out) const;
  // `state`: the ledger's.
  void Put(const std::string& scene, const LedgerFrames& frames,
           const std::vector<std::string>& fragments, const State* state, Emit out) const;

private:
  struct ObjectEntry {
    std::optional<v1::Command> create; // absent: a robot or a terrain created it
    std::string robot;
    std::string terrain;
    LedgerId frame = 0;
    LedgerId createdOn = 0;    // a robot's
    std::string askedFragment; // fragment that a robot's command names
    v1::Nature nature = v1::PHYSICAL;
    std::string fragment;
    LatestCommands latest;
    std::optional<v1::SetMaterial> material;
    std::optional<v1::SetTilt> tilt; // after the material
    std::map<std::string, v1::SetPart> parts;
    std::optional<Trail> trail;
  };
  // A removed robot whose visuals stay because they are attached to other frames.
  struct OrphanedVisuals {
    v1::Command load;
    std::set<std::uint32_t> ids;
  };
  bool ChangeLook(ObjectEntry& entry, const v1::Command& command);
  void PutObject(const std::string& scene, std::uint32_t id, const ObjectEntry& entry,
                 Emit out) const;
  void PutLostVisuals(const std::string& scene, const LedgerFrames& frames, Emit out) const;
  ObjectEntry* Find(std::uint32_t id);

  std::map<std::uint32_t, ObjectEntry> Objects_;
  LedgerTerrains Terrains_;
  std::vector<OrphanedVisuals> Orphans_;
  // By robot: visuals that were removed with a frame outside their robot, and that frame.
  std::multimap<std::string, std::pair<std::uint32_t, LedgerId>> LostVisuals_;
};

} // namespace dspace::session

#endif
