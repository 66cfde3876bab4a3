// What somebody who watches has for himself beside the scenes that he follows.
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

// Viewports, vantages and cameras whose names begin with Prefix. They are made in the interpreter
// that follows a server's, and made again when a snapshot takes its place. What the simulation does
// goes before: a camera whose frame is removed stays where it was, in the root; views of a scene
// that is removed, or not in a snapshot, sleep until there is a scene of that name again with the
// frames (by path) and cameras that they look from; where it has gone on without these, they are
// made where they were. The lag of a chase camera begins anew.
class ViewerViews {
public:
  static constexpr const char* Prefix = "viewer:";

  // Whether the command changes nothing but views of one's own, or makes one.
  bool Owns(const v1::Command& command) const;

  // Carries out a command that Owns() and keeps what it leads to; names a viewport that has no
  // name. An event that moves the camera of a viewport that looks through one of the scene's own
  // cameras first gives the viewport a vantage of its own name with a copy of that camera.
  v1::Reply Execute(Interpreter& interpreter, v1::Command& command);

  // The interpreter that was followed is about to be replaced by one made from a snapshot: notes
  // where cameras stand.
  void BeforeSnapshot(Interpreter& interpreter);
  // The new one is as the snapshot says.
  void AfterSnapshot(Interpreter& interpreter);
  // Makes those again that sleep, and whose time has come. `alone`: nobody drives, so that nothing
  // is to be waited for.
  void Resume(Interpreter& interpreter, bool alone);

  // A command of the simulation was refused. Gets views of one's own out of its way; true: another
  // try is worth while. One that removes a scene is to be given before it is carried out, for it is
  // refused for viewports alone, and vantages would go without a word.
  bool RemoveConflicting(Interpreter& interpreter, const v1::Command& refused);

private:
  using Name = std::pair<std::string, std::string>; // scene and vantage
  struct LastPose {
    v1::Projection projection;
    v1::Mount mount;  // in the root
    std::string path; // of the frame that it was on; empty: the root
  };
  struct Suspended {
    std::vector<v1::Command> commands;
    std::optional<double> time_s; // of the scene when it was seen first
  };

  // The camera as it is; absent where there is none.
  static std::optional<v1::SetCamera> CameraOf(Interpreter& interpreter, const std::string& scene,
                                               const std::string& vantage,
                                               const std::string& camera);
  // Where a camera stands now, in the root.
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
  bool DetachViewports(Interpreter& interpreter, const std::string& scene,
                       const std::string& vantage, const std::string& camera);

  std::set<std::string> Viewports_;
  std::set<std::string> Pressed_; // viewports in which a button is down
  std::set<Name> Vantages_;
  std::map<std::string, LedgerNames> Names_; // of vantages alone, by scene
  LedgerViewports Ledger_;
  std::map<std::string, Suspended> Suspended_; // by scene
  int Last_ = 0;                               // number of the last viewport that was named here
  // Noted when they were last there.
  std::map<std::pair<Name, std::string>, LastPose> Cameras_;
  std::map<std::string, LastPose> Views_; // by viewport
};

} // namespace dspace::session

#endif
