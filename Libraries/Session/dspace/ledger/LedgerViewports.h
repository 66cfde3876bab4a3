// The viewports of a session, for the ledger.
#ifndef DSPACE_SESSION_LEDGER_VIEWPORTS_H
#define DSPACE_SESSION_LEDGER_VIEWPORTS_H

#include <cstdint>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <dspace/ledger/LatestCommands.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Not a public header.
class LedgerViewports {
public:
  using Emit = std::vector<v1::Command>&;
  // The id of the object that draws a terrain; 0: there is no such terrain.
  using TerrainObject = std::function<std::uint32_t(const std::string& terrain)>;
  // What the viewports of a scene need to know of it.
  struct SceneView {
    std::vector<std::string> fragments;
    TerrainObject terrain;
  };
  // `terrain`: of the scene of the viewport that the command changes; empty: not known.
  bool Add(const v1::Command& command, const TerrainObject& terrain = {});
  // The scene of a viewport; empty: the default scene.
  std::string SceneOf(const std::string& viewport) const;
  // Styles of terrains that have an element in a fragment of the scene.
  std::vector<v1::StyleTerrainInViewport> StylesIn(const std::string& scene,
                                                   const std::string& fragment) const;
  // `scene` returns the SceneView for the name of a scene.
  template<class Scenes> void Put(const Scenes& scene, Emit out) const {
    for (const auto& [name, viewport] : this->Viewports_) {
      PutOne(name, viewport, scene(viewport.create.scene()), out);
    }
  }

private:
  struct Viewport {
    v1::Command create;
    v1::SetViewport set; // without what `create` has: vantage, camera, visibility, samples
    LatestCommands latest;
    std::set<std::string> hidden;
    std::vector<v1::SetTextTable> tables;
    std::vector<v1::SetColorBar> bars;
    // By terrain, with the id of its object (0: not known): another terrain of this name is
    // another.
    std::map<std::string, std::pair<v1::StyleTerrainInViewport, std::uint32_t>> styles;
  };
  static void Set(Viewport& viewport, const v1::SetViewport& command);
  static void PutOne(const std::string& name, const Viewport& viewport, const SceneView& scene,
                     Emit out);
  Viewport& Find(const std::string& name) { return this->Viewports_[name]; }

  std::map<std::string, Viewport> Viewports_;
};

} // namespace dspace::session

#endif
