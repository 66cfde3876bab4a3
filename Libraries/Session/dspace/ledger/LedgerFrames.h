// The frames and robots of one scene, for the ledger.
#ifndef DSPACE_SESSION_LEDGER_FRAMES_H
#define DSPACE_SESSION_LEDGER_FRAMES_H

#include <array>
#include <map>
#include <optional>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

using LedgerId = std::uint64_t;

// A robot, or a model whose nodes are frames: its nodes are links with fixed joints. Its key among
// the robots is its name, of a model ModelKey of its base frame.
struct LedgerRobot {
  v1::Command load;             // LoadRobot or ImportNodes
  v1::RobotReply about;         // as loaded
  std::vector<double> initial;  // of each joint
  std::vector<double> position; // now
};

std::string ModelKey(LedgerId base); // no robot has such a name

// Sets the frame of a command that loads a robot or model, and drops its fragment if there is none
// of that name.
void PlaceLoad(v1::Command& load, LedgerId frame, const std::vector<std::string>& fragments);

class LedgerFrames {
public:
  using Emit = std::vector<v1::Command>&;

  LedgerFrames();
  void Create(const v1::Command& command);
  void Create(const v1::CreateFrames& command);
  struct Removed {
    std::unordered_set<LedgerId> frames;
    std::map<std::string, v1::Command> robots; // by key, the commands that loaded them
  };
  // Removes the frame with its subtree.
  Removed Remove(LedgerId frame);
  void Reparent(const v1::ReparentFrame& command, const v1::Reply& reply);
  void Rename(const v1::RenameFrame& command);
  void SetPoses(const v1::SetPoses& command);
  void Load(const v1::Command& command, const v1::RobotReply& reply);
  // Returns the model as a robot.
  const v1::RobotReply& Import(const v1::Command& command, const v1::NodesReply& reply);
  void PoseNodes(const v1::PoseNodes& command, const v1::PosesReply& poses);
  void SetJoints(const v1::SetJoints& command);

  const std::map<std::string, LedgerRobot>& Robots() const { return this->Robots_; }
  std::map<std::string, LedgerRobot>& Robots() { return this->Robots_; }
  // Appends the commands for frames, robots, joints and poses of the scene. `fragments` are the
  // existing fragments: if a robot's fragment was removed, later commands move its visuals.
  void Put(const std::string& scene, const std::vector<std::string>& fragments, Emit out) const;
  bool Contains(LedgerId frame) const { return this->Nodes_.count(frame) > 0; }
  // A name that no child of the root uses.
  std::string FreeName() const;

private:
  using Row = std::array<double, 8>;
  struct Node {
    LedgerId parent = 0;
    std::string name;
    std::vector<LedgerId> children;
    v1::Pose created;
    std::optional<Row> pose; // set since
    std::string robot;       // whose base or link it is
  };
  void AddRobot(const std::string& key, LedgerRobot robot, LedgerId frame, const std::string& name);
  void AddNode(LedgerId id, LedgerId parent, const std::string& name, const std::string& robot);
  void PutTree(const std::string& scene, const std::vector<std::string>& fragments, Emit out) const;
  void PutRenames(const std::string& scene, std::vector<std::pair<LedgerId, std::string>> present,
                  Emit out) const;
  void PutJoints(const std::string& scene, Emit out) const;
  void PutPoses(const std::string& scene, Emit out) const;

  std::unordered_map<LedgerId, Node> Nodes_; // stay where they are until removed
  std::map<std::string, LedgerRobot> Robots_;
  // The frames and nodes of the last step: most steps of a simulation name the same frames.
  std::vector<LedgerId> LastIds_;
  std::vector<Node*> LastNodes_;
};

} // namespace dspace::session

#endif
