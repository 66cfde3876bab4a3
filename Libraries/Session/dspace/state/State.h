// The state of an interpreter: scenes, and the data that the core's scenes do not contain.
#ifndef DSPACE_SESSION_STATE_H
#define DSPACE_SESSION_STATE_H

#include <array>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <dspace/messages/CommandFiles.h>
#include <dspace/proto/objects.pb.h>
#include <dspace/scene/Scene.h>
#include <dspace/scene/Trail.h>
#include <dspace/scene/stars/StarField.h>
#include <dspace/state/DrawnGeometries.h>
#include <dspace/state/FrameEventLog.h>
#include <dspace/state/MeshCache.h>
#include <dspace/state/MessageLog.h>
#include <dspace/state/ModelCache.h>
#include <dspace/state/ModelNodes.h>
#include <dspace/state/Pictures.h>
#include <dspace/state/Robot.h>
#include <dspace/state/SkyMotions.h>
#include <dspace/state/Telemetry.h>
#include <dspace/state/TerrainObject.h>
#include <dspace/state/TrajectoryObject.h>

namespace dspace::session {

class Works;

constexpr const char* DefaultVantage = "main";

// An object of CreateDrawn.
struct DrawnObject {
  std::string drawer;
  bool leftOut = false; // this process has no such drawer
  bool IsProp() const { return this->drawer.compare(0, 4, "vtk:") == 0; }
};

// One scene with its robots, terrains and trails, by name or object.
struct SceneState {
  std::shared_ptr<Scene> scene;
  std::optional<double> begin_s; // the least time that was set; none: none was
  void NoteTime(double time_s);  // of a time that was set
  std::map<std::string, std::unique_ptr<Robot>> robots;
  std::map<FrameId, ModelNodes> models; // whose nodes are frames, by their base frame
  std::map<std::string, std::unique_ptr<TerrainObject>> terrains;
  std::map<ObjectId, Trail> trails;
  std::map<ObjectId, std::shared_ptr<StarField>> stars;
  std::map<ObjectId, std::unique_ptr<TrajectoryObject>> trajectories;
  std::set<ObjectId> primitives;                       // objects whose shape may be replaced
  std::set<ObjectId> meshes;                           // objects whose arrays may be replaced
  std::map<ObjectId, std::pair<double, double>> tilts; // warning and limit of tilt markers [deg]
  std::map<ObjectId, v1::CreateText> texts;            // with their style
  std::map<ObjectId, DrawnObject> drawn;
  SkyMotions sky;
  Telemetry telemetry;
  MessageLog messages;
  std::unique_ptr<FrameFollower> follower; // null while the frames are not followed

  // The terrain that an object is; null for others.
  const TerrainObject* TerrainOf(ObjectId object) const;
  // The ground of an object that is a terrain, as TerrainObject::Triangles; empty for others.
  std::vector<Part> GroundOf(const GraphicsObject& object, std::size_t triangleBudget) const;

  // Removes the robots, terrains, trails and primitives whose frames or objects were removed.
  // Frames that followed trajectories go back.
  void EraseRemoved();
  // The trajectory that a frame follows; 0: none.
  ObjectId FollowedBy(FrameId frame) const;
  // Lines and frames of trajectories at the scene's time. Returns warnings.
  std::vector<std::string> MoveTrajectories();
};

// The state of a viewport without its drawing.
struct ViewportState {
  std::string scene;
  std::string vantage;
  std::string camera; // empty: the vantage's active one
  int x = 0;          // pixels, in a window or a sheet of several
  int y = 0;
  bool ornaments = true;
  bool cornerAxes = false;
  std::array<double, 3> background = {0, 0, 0};
  std::array<double, 3> backgroundTop = {0, 0, 0};
  std::set<std::string> hiddenFragments; // in this viewport only
};

struct State {
  FrameEventLog frameEvents; // before the scenes, whose followers write to it
  std::map<std::string, SceneState> scenes;
  std::map<std::string, ViewportState> viewports;
  ModelCache models;
  MeshCache meshes;
  DrawnGeometries drawers;           // that CreateDrawn may name
  std::uint64_t lastTelemetryId = 0; // of all scenes, including removed ones
  CommandFiles files;
  std::shared_ptr<Pictures> pictures; // for measurements; null: this process does not draw
  std::shared_ptr<Works> works;       // requests in threads of their own; never null

  // Throws Error(NotFound) that names the existing scenes.
  SceneState& FindScene(const std::string& name);
};

} // namespace dspace::session

#endif
