#include <dspace/state/State.h>

#include <algorithm>

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

void SceneState::NoteTime(double time_s) {
  this->begin_s = std::min(this->begin_s.value_or(time_s), time_s);
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
  for (auto it = this->trajectories.begin(); it != this->trajectories.end();) {
    if (!gone(it->first)) {
      ++it;
      continue;
    }
    FrameTree& frames = this->scene->Frames();
    if (it->second->Follower() != NoFrame && frames.Contains(it->second->Follower())) {
      frames.SetLocalPose(it->second->Follower(), it->second->PoseBefore());
    }
    it = this->trajectories.erase(it);
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

ObjectId SceneState::FollowedBy(FrameId frame) const {
  for (const auto& [id, trajectory] : this->trajectories) {
    if (frame != NoFrame && trajectory->Follower() == frame) {
      return id;
    }
  }
  return 0;
}

std::vector<std::string> SceneState::MoveTrajectories() {
  std::vector<std::string> warnings;
  std::vector<FrameId> moved;
  std::vector<double> poses;
  for (const auto& [id, trajectory] : this->trajectories) {
    std::string warning = trajectory->SetTime(this->scene->Time());
    if (!warning.empty()) {
      warnings.push_back(std::move(warning));
      warning.clear();
    }
    if (trajectory->Follower() == NoFrame) {
      continue;
    }
    try {
      const Pose X = trajectory->FollowerPose(this->scene->Time(), warning);
      moved.push_back(trajectory->Follower());
      poses.insert(poses.end(), {X.position.x(), X.position.y(), X.position.z(), X.rotation.w(),
                                 X.rotation.x(), X.rotation.y(), X.rotation.z(), X.scale});
    } catch (const Error& error) {
      warning = std::string(error.what()) + "; the frame that follows it stays where it was";
    }
    if (!warning.empty()) {
      warnings.push_back(std::move(warning));
    }
  }
  if (!moved.empty()) {
    this->scene->Frames().SetLocalPoses(moved.data(), poses.data(), moved.size());
  }
  return warnings;
}

} // namespace dspace::session
