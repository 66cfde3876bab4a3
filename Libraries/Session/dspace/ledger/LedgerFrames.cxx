#include <dspace/ledger/LedgerFrames.h>

#include <algorithm>
#include <cstring>

#include <dspace/FrameTree.h>

namespace dspace::session {
namespace {

constexpr int PoseSize = 8;
constexpr int PosesACommand = 4096;

v1::Command& New(const std::string& scene, std::vector<v1::Command>& out) {
  out.emplace_back().set_scene(scene);
  return out.back();
}

void PutRename(const std::string& scene, LedgerId frame, const std::string& name,
               std::vector<v1::Command>& out) {
  v1::RenameFrame* rename = New(scene, out).mutable_rename_frame();
  rename->set_frame(frame);
  rename->set_name(name);
}

// The name that its base frame gets.
const std::string& LoadedName(const v1::Command& load) {
  return load.has_load_robot() ? load.load_robot().name()
                               : load.import_nodes().import().object().name();
}

// Has the effect of Robot::FollowMimics.
void FollowMimics(const v1::RobotReply& robot, std::vector<double>& positions) {
  std::vector<char> done(positions.size(), 0);
  for (std::size_t left = positions.size(); left > 0;) {
    const std::size_t before = left;
    for (int i = 0; i < robot.joint_size(); ++i) {
      const v1::JointInfo& joint = robot.joint(i);
      if (done[std::size_t(i)] || (joint.has_mimic() && !done[joint.mimic()])) {
        continue;
      }
      if (joint.has_mimic()) {
        positions[std::size_t(i)] =
            joint.mimic_multiplier() * positions[joint.mimic()] + joint.mimic_offset();
      }
      done[std::size_t(i)] = 1;
      --left;
    }
    if (left == before) {
      return; // a cycle, which no loaded robot has
    }
  }
}

} // namespace

void PlaceLoad(v1::Command& load, LedgerId frame, const std::vector<std::string>& fragments) {
  const auto place = [&](auto& settings) {
    settings.set_frame(frame);
    if (std::find(fragments.begin(), fragments.end(), settings.fragment()) == fragments.end()) {
      settings.clear_fragment();
    }
  };
  if (load.has_load_robot()) {
    place(*load.mutable_load_robot());
  } else {
    place(*load.mutable_import_nodes()->mutable_import()->mutable_object());
  }
}

std::string ModelKey(LedgerId base) {
  return "\n" + std::to_string(base); // a line break is in no name of a frame
}

LedgerFrames::LedgerFrames() {
  this->Nodes_[RootFrame];
}

void LedgerFrames::AddNode(LedgerId id, LedgerId parent, const std::string& name,
                           const std::string& robot) {
  Node& node = this->Nodes_[id];
  node.parent = parent == NoFrame ? RootFrame : parent;
  node.name = name;
  node.robot = robot;
  this->Nodes_[node.parent].children.push_back(id);
}

void LedgerFrames::Create(const v1::Command& command) {
  const v1::CreateFrame& create = command.create_frame();
  this->AddNode(create.id(), create.parent(), create.name(), {});
  this->Nodes_[create.id()].created = create.pose();
}

void LedgerFrames::Create(const v1::CreateFrames& command) {
  for (int i = 0; i < command.name_size(); ++i) {
    const LedgerId id = command.id() + LedgerId(i);
    const LedgerId parent =
        command.parent().empty() ? RootFrame : command.parent(command.parent_size() == 1 ? 0 : i);
    this->AddNode(id, parent, command.name(i), {});
    if (!command.pose().empty()) {
      const double* row = command.pose().data() + std::ptrdiff_t(PoseSize) * i;
      std::copy(row, row + PoseSize, this->Nodes_[id].pose.emplace().begin());
    }
  }
}

LedgerFrames::Removed LedgerFrames::Remove(LedgerId frame) {
  std::vector<LedgerId>& siblings = this->Nodes_[this->Nodes_[frame].parent].children;
  siblings.erase(std::remove(siblings.begin(), siblings.end(), frame), siblings.end());
  Removed removed;
  std::vector<LedgerId> open = {frame};
  while (!open.empty()) {
    const auto found = this->Nodes_.find(open.back());
    removed.frames.insert(open.back());
    open.pop_back();
    open.insert(open.end(), found->second.children.begin(), found->second.children.end());
    this->Nodes_.erase(found);
  }
  for (auto it = this->Robots_.begin(); it != this->Robots_.end();) {
    if (removed.frames.count(it->second.about.base()) == 0) {
      ++it;
      continue;
    }
    removed.robots.emplace(it->first, it->second.load);
    it = this->Robots_.erase(it);
  }
  this->LastIds_.clear();
  return removed;
}

void LedgerFrames::Reparent(const v1::ReparentFrame& command, const v1::Reply& reply) {
  Node& node = this->Nodes_[command.frame()];
  const LedgerId parent = command.parent() == NoFrame ? RootFrame : command.parent();
  if (node.parent != parent) { // the present parent is no change
    std::vector<LedgerId>& siblings = this->Nodes_[node.parent].children;
    siblings.erase(std::remove(siblings.begin(), siblings.end(), command.frame()), siblings.end());
    this->Nodes_[parent].children.push_back(command.frame());
    node.parent = parent;
  }
  if (reply.poses().pose_size() == PoseSize) {
    std::copy(reply.poses().pose().begin(), reply.poses().pose().end(),
              node.pose.emplace().begin());
  }
}

void LedgerFrames::Rename(const v1::RenameFrame& command) {
  this->Nodes_[command.frame()].name = command.name();
}

void LedgerFrames::SetPoses(const v1::SetPoses& command) {
  const std::size_t n = std::size_t(command.frame_size());
  const LedgerId* ids = command.frame().data();
  if (this->LastIds_.size() != n || !std::equal(ids, ids + n, this->LastIds_.begin())) {
    this->LastIds_.assign(ids, ids + n);
    this->LastNodes_.clear();
    for (const LedgerId id : this->LastIds_) {
      this->LastNodes_.push_back(&this->Nodes_[id]);
    }
  }
  for (std::size_t i = 0; i < n; ++i) {
    Node& node = *this->LastNodes_[i];
    if (!node.pose) {
      node.pose.emplace();
    }
    std::memcpy(node.pose->data(), command.pose().data() + i * PoseSize, sizeof(Row));
  }
}

void LedgerFrames::Load(const v1::Command& command, const v1::RobotReply& reply) {
  const v1::LoadRobot& load = command.load_robot();
  LedgerRobot robot;
  robot.load = command;
  robot.about = reply;
  for (const v1::JointInfo& joint : reply.joint()) {
    robot.initial.push_back(joint.position());
  }
  robot.position = robot.initial;
  this->AddRobot(load.name(), std::move(robot), load.frame(), load.name());
}

const v1::RobotReply& LedgerFrames::Import(const v1::Command& command,
                                           const v1::NodesReply& reply) {
  LedgerRobot model;
  model.load = command;
  model.load.mutable_import_nodes()->clear_lights(); // they are stored as lights
  model.about.set_base(reply.base());
  for (int i = 0; i < reply.node_size(); ++i) {
    const v1::NodesReply::Node& node = reply.node(i);
    v1::LinkInfo* link = model.about.add_link();
    link->set_name(node.frame_name());
    link->set_frame(node.frame());
    if (node.object() != 0) {
      link->add_object(node.object());
    }
    if (node.parent() >= 0) {
      v1::JointInfo* joint = model.about.add_joint();
      joint->set_parent_link(std::uint32_t(node.parent()));
      joint->set_child_link(std::uint32_t(i));
      model.initial.push_back(0.0);
    }
  }
  model.position = model.initial;
  const v1::ObjectSettings& settings = command.import_nodes().import().object();
  const std::string key = ModelKey(reply.base());
  this->AddRobot(key, std::move(model), settings.frame(), settings.name());
  return this->Robots_.at(key).about;
}

void LedgerFrames::PoseNodes(const v1::PoseNodes& command, const v1::PosesReply& poses) {
  const v1::RobotReply& model = this->Robots_.at(ModelKey(command.base())).about;
  for (int i = 0; i < model.link_size() && PoseSize * (i + 1) <= poses.pose_size(); ++i) {
    const double* row = poses.pose().data() + std::ptrdiff_t(PoseSize) * i;
    std::copy(row, row + PoseSize, this->Nodes_[model.link(i).frame()].pose.emplace().begin());
  }
}

void LedgerFrames::AddRobot(const std::string& key, LedgerRobot robot, LedgerId frame,
                            const std::string& name) {
  v1::RobotReply& about = robot.about;
  this->AddNode(about.base(), frame, name, key);
  if (robot.load.has_load_robot()) {
    this->Nodes_[about.base()].created = robot.load.load_robot().pose();
  }
  std::vector<LedgerId> parents(std::size_t(about.link_size()), about.base());
  for (const v1::JointInfo& joint : about.joint()) {
    parents[joint.child_link()] = about.link(int(joint.parent_link())).frame();
  }
  for (int i = 0; i < about.link_size(); ++i) { // the order in which the interpreter makes them
    this->AddNode(about.link(i).frame(), parents[std::size_t(i)], about.link(i).name(), key);
  }
  this->Robots_[key] = std::move(robot);
}

void LedgerFrames::SetJoints(const v1::SetJoints& command) {
  LedgerRobot& robot = this->Robots_[command.robot()];
  std::vector<double> next = robot.position;
  for (int i = 0; i < command.joint_size(); ++i) {
    const v1::JointInfo& joint = robot.about.joint(int(command.joint(i)));
    double position = command.position(i);
    if (joint.has_lower()) {
      position = std::min(std::max(position, joint.lower()), joint.upper());
    }
    next[command.joint(i)] = position;
  }
  FollowMimics(robot.about, next);
  for (std::size_t i = 0; i < next.size(); ++i) {
    if (next[i] != robot.position[i]) { // the interpreter moves the links of these joints
      const v1::JointInfo& joint = robot.about.joint(int(i));
      this->Nodes_[robot.about.link(int(joint.child_link())).frame()].pose.reset();
    }
  }
  robot.position = std::move(next);
}

std::string LedgerFrames::FreeName() const {
  std::string name = "~";
  const auto taken = [&](LedgerId id) { return this->Nodes_.at(id).name == name; };
  const std::vector<LedgerId>& children = this->Nodes_.at(RootFrame).children;
  while (std::any_of(children.begin(), children.end(), taken)) {
    name += "~";
  }
  return name;
}

void LedgerFrames::Put(const std::string& scene, const std::vector<std::string>& fragments,
                       Emit out) const {
  this->PutTree(scene, fragments, out);
  this->PutJoints(scene, out);
  this->PutPoses(scene, out);
}

// Parents before children and siblings in their order. A robot is loaded under its own name, which
// its base need not bear any more and another frame may: that one is named when all are there.
void LedgerFrames::PutTree(const std::string& scene, const std::vector<std::string>& fragments,
                           Emit out) const {
  std::vector<LedgerId> open = {RootFrame};
  while (!open.empty()) {
    const LedgerId parent = open.back();
    open.pop_back();
    const Node& node = this->Nodes_.at(parent);
    std::vector<std::pair<LedgerId, std::string>> present; // the names that they bear for now
    std::unordered_set<std::string> loaded;
    std::unordered_set<std::string> names;
    for (const LedgerId id : node.children) {
      const Node& child = this->Nodes_.at(id);
      names.insert(child.name);
      if (!child.robot.empty() && this->Robots_.at(child.robot).about.base() == id) {
        loaded.insert(LoadedName(this->Robots_.at(child.robot).load));
      }
    }
    names.insert(loaded.begin(), loaded.end());
    for (const LedgerId id : node.children) {
      const Node& child = this->Nodes_.at(id);
      if (child.robot.empty()) {
        std::string name = child.name;
        if (loaded.count(name)) {
          do {
            name += "~";
          } while (!names.insert(name).second);
        }
        v1::CreateFrame* create = New(scene, out).mutable_create_frame();
        create->set_id(id);
        create->set_parent(parent);
        create->set_name(name);
        if (!child.pose && child.created.ByteSizeLong() > 0) {
          *create->mutable_pose() = child.created;
        }
        present.emplace_back(id, name);
        continue;
      }
      const LedgerRobot& robot = this->Robots_.at(child.robot);
      if (robot.about.base() == id) {
        v1::Command& load = out.emplace_back(robot.load);
        load.set_scene(scene);
        PlaceLoad(load, parent, fragments);
        present.emplace_back(id, LoadedName(load));
        continue;
      }
      for (const v1::LinkInfo& link : robot.about.link()) {
        if (link.frame() == id) {
          present.emplace_back(id, link.name());
        }
      }
    }
    this->PutRenames(scene, std::move(present), out);
    open.insert(open.end(), node.children.rbegin(), node.children.rend());
  }
}

// Renames frames to their final names. A frame that occupies the final name of another one first
// gets a temporary name.
void LedgerFrames::PutRenames(const std::string& scene,
                              std::vector<std::pair<LedgerId, std::string>> present,
                              Emit out) const {
  std::unordered_set<std::string> names;
  for (const auto& [id, name] : present) {
    names.insert(name);
    names.insert(this->Nodes_.at(id).name);
  }
  for (auto& [id, name] : present) {
    const std::string& final = this->Nodes_.at(id).name;
    const auto wants = [&, &taken = name](const auto& other) {
      return this->Nodes_.at(other.first).name == taken;
    };
    if (name != final && std::any_of(present.begin(), present.end(), wants)) {
      std::string other = final + "~";
      while (!names.insert(other).second) {
        other += "~";
      }
      PutRename(scene, id, other, out);
      name = other;
    }
  }
  for (const auto& [id, name] : present) {
    if (name != this->Nodes_.at(id).name) {
      PutRename(scene, id, this->Nodes_.at(id).name, out);
    }
  }
}

void LedgerFrames::PutJoints(const std::string& scene, Emit out) const {
  for (const auto& [name, robot] : this->Robots_) {
    v1::Command command;
    v1::SetJoints* set = command.mutable_set_joints();
    set->set_robot(name);
    for (std::size_t i = 0; i < robot.position.size(); ++i) {
      if (!robot.about.joint(int(i)).has_mimic() && robot.position[i] != robot.initial[i]) {
        set->add_joint(std::uint32_t(i));
        set->add_position(robot.position[i]);
      }
    }
    if (set->joint_size() > 0) {
      command.set_scene(scene);
      out.push_back(std::move(command));
    }
  }
}

void LedgerFrames::PutPoses(const std::string& scene, Emit out) const {
  std::vector<LedgerId> ids;
  for (const auto& [id, node] : this->Nodes_) {
    if (node.pose) {
      ids.push_back(id);
    }
  }
  std::sort(ids.begin(), ids.end());
  v1::SetPoses* set = nullptr;
  for (const LedgerId id : ids) {
    if (!set || set->frame_size() == PosesACommand) {
      set = New(scene, out).mutable_set_poses();
    }
    set->add_frame(id);
    const Row& row = *this->Nodes_.at(id).pose;
    set->mutable_pose()->Add(row.begin(), row.end());
  }
}

} // namespace dspace::session
