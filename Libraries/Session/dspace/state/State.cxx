#include <dspace/state/State.h>

#include <dspace/Error.h>

namespace dspace::session {
namespace {

template<class Map, class Gone> void EraseKeys(Map& map, const Gone& gone) {
  for (auto it = map.begin(); it != map.end();) {
    it = gone(it->first) ? map.erase(it) : std::next(it);
  }
}

} // namespace

SceneState& State::FindScene(const std::string& name) {
  const auto found = this->scenes.find(name);
  if (found == this->scenes.end()) {
    std::string names;
    for (const auto& [each, state] : this->scenes) {
      names += (names.empty() ? "'" : ", '") + each + "'";
    }
    throw Error(Error::Kind::NotFound, "scene '" + name + "'",
                "there is no such scene; there are: " + (names.empty() ? "none" : names));
  }
  return found->second;
}

const TerrainObject* SceneState::TerrainOf(ObjectId object) const {
  for (const auto& [name, terrain] : this->terrains) {
    if (terrain->Object() == object) {
      return terrain.get();
    }
  }
  return nullptr;
}

std::vector<Part> SceneState::GroundOf(const GraphicsObject& object,
                                       std::size_t triangleBudget) const {
  const TerrainObject* terrain = this->TerrainOf(object.id);
  return terrain ? terrain->Triangles(triangleBudget) : std::vector<Part>();
}

void SceneState::EraseRemoved() {
  this->sky.EraseRemoved(this->scene->Frames());
  const auto& objects = this->scene->Objects();
  const auto gone = [&objects](ObjectId id) { return objects.count(id) == 0; };
  for (auto it = this->robots.begin(); it != this->robots.end();) {
    const bool stays = this->scene->Frames().Contains(it->second->Base());
    it = stays ? std::next(it) : this->robots.erase(it);
  }
  for (auto it = this->models.begin(); it != this->models.end();) {
    const bool stays = this->scene->Frames().Contains(it->first);
    it = stays ? std::next(it) : this->models.erase(it);
  }
  for (auto it = this->terrains.begin(); it != this->terrains.end();) {
    it = gone(it->second->Object()) ? this->terrains.erase(it) : std::next(it);
  }
  EraseKeys(this->trails, gone);
  EraseKeys(this->stars, gone);
  EraseKeys(this->tilts, gone);
  EraseKeys(this->texts, gone);
  EraseKeys(this->drawn, gone);
  for (std::set<ObjectId>* set : {&this->primitives, &this->meshes}) {
    for (auto it = set->begin(); it != set->end();) {
      it = gone(*it) ? set->erase(it) : std::next(it);
    }
  }
}

} // namespace dspace::session
