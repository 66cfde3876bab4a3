// Viewports, vantages and cameras that belong to one viewer.
#ifndef DSPACE_SESSION_VIEWER_VIEWS_H
#define DSPACE_SESSION_VIEWER_VIEWS_H

#include <map>
#include <optional>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <dspace/interpreter/Interpreter.h>
#include <dspace/ledger/LedgerNames.h>
#include <dspace/ledger/LedgerViewports.h>

namespace dspace::session {

// Viewports, vantages and cameras whose names begin with Prefix. They exist in the interpreter that
// follows a server, and are restored after a snapshot. The simulation has priority: if the frame of
// a camera is removed, the camera keeps its pose in the root. If a scene is removed or missing in a
// snapshot, its views are suspended until a scene of this name has the frames (by path) and cameras
// that they use. If its time advances without these, the views are restored at their last poses.
// The lag of a chase camera is reset.
class ViewerViews {
public:
  static constexpr const char* Prefix = "viewer:";

  // Whether the command creates a view of the viewer or changes only such views.
  bool Owns(const v1::Command& command) const;

  // Executes a command for which Owns() is true and tracks its effect. Chooses a name for an
  // unnamed viewport. If an event moves a viewport that uses a camera of the scene, the viewport
  // first gets a vantage of its own name with a copy of that camera.
  v1::Reply Execute(Interpreter& interpreter, v1::Command& command);

  // Stores the poses of cameras before a snapshot replaces the interpreter.
  void BeforeSnapshot(Interpreter& interpreter);
  // Suspends the views after the snapshot was applied to the new interpreter.
  void AfterSnapshot(Interpreter& interpreter);
  // Restores suspended views that are ready. `alone`: there is no driver, so that views do not wait
  // for missing frames.
  void Resume(Interpreter& interpreter, bool alone);

  // Removes views that conflict with a rejected command of the simulation. True: retry the command.
  // Call it before a command that removes a scene, because only viewports make that command fail,
  // and vantages would be lost.
  bool RemoveConflicting(Interpreter& interpreter, const v1::Command& rejected);

private:
  using Name = std::pair<std::string, std::string>; // scene and vantage
  struct LastPose {
    v1::Projection projection;
    v1::Mount mount;  // pose in the root
    std::string path; // of its frame; empty: the root
    std::string aim;  // path of the frame that it points at or has its vertical from; empty: none,
                      // or the root
  };
  struct Suspended {
    std::vector<v1::Command> commands;
    std::optional<double> time_s; // the scene's time when it reappeared
  };

  // The present state of a camera; empty: there is none.
  static std::optional<v1::SetCamera> CameraOf(Interpreter& interpreter, const std::string& scene,
                                               const std::string& vantage,
                                               const std::string& camera);
  // The present pose of a camera in the root.
  static v1::Mount RootMount(const Scene& scene, const std::string& vantage,
                             const std::string& camera);
  bool OwnsVantage(const std::string& scene, const std::string& vantage) const;
  void Track(const v1::Command& command, const v1::Reply& reply);
  v1::Reply ExecuteEvent(Interpreter& interpreter, v1::Command& command);
  bool GiveCamera(Interpreter& interpreter, const std::string& viewport, const v1::SetCamera& to);
  bool IsReady(const Scene& scene, const Suspended& views) const;
  void Restore(Interpreter& interpreter, v1::Command& command);
  void Forget(const std::string& scene, const std::string& name);
  void Suspend(Interpreter& interpreter, const std::string& scene);
  std::vector<v1::Command> Commands(Interpreter& interpreter) const;
  std::vector<std::string> ViewportsIn(Interpreter& interpreter, const std::string& scene) const;
  bool DetachCameras(Interpreter& interpreter, const std::string& scene, std::uint64_t frame);
  bool RemoveStyles(Interpreter& interpreter, const std::string& scene,
                    const std::string& fragment);
  bool DetachViewports(Interpreter& interpreter, const std::string& scene,
                       const std::string& vantage, const std::string& camera);

  std::set<std::string> Viewports_;
  std::set<std::string> Pressed_; // viewports with a pressed button
  std::set<Name> Vantages_;
  std::map<std::string, LedgerNames> Names_; // of vantages only, by scene
  LedgerViewports Ledger_;
  std::map<std::string, Suspended> Suspended_; // by scene
  int Last_ = 0;                               // number in the last chosen viewport name
  // The last known poses.
  std::map<std::pair<Name, std::string>, LastPose> Cameras_;
  std::map<std::string, LastPose> Views_; // by viewport
};

} // namespace dspace::session

#endif
