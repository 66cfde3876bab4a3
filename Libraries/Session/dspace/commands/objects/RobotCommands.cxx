// Robots: loaded from URDF, moved by their joints.
#include <filesystem>

#include <dspace/Checks.h>
#include <dspace/FrameRules.h>
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/objects/RobotLevels.h>
#include <dspace/import/worker/ModelImport.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

std::string RobotLabel(const std::string& name) {
  return "robot '" + name + "'";
}

Robot& FindRobot(const Context& context, const std::string& name) {
  const auto found = context.scene->robots.find(name);
  if (found == context.scene->robots.end()) {
    throw Error(Error::Kind::NotFound, RobotLabel(name),
                "there is no such robot in scene '" + context.sceneName + "'");
  }
  return *found->second;
}

v1::JointInfo::Type FromType(UrdfJoint::Type type) {
  switch (type) {
  case UrdfJoint::Type::Revolute:
    return v1::JointInfo::REVOLUTE;
  case UrdfJoint::Type::Continuous:
    return v1::JointInfo::CONTINUOUS;
  case UrdfJoint::Type::Prismatic:
    return v1::JointInfo::PRISMATIC;
  case UrdfJoint::Type::Floating:
    return v1::JointInfo::FLOATING;
  case UrdfJoint::Type::Planar:
    return v1::JointInfo::PLANAR;
  case UrdfJoint::Type::Fixed:
    break;
  }
  return v1::JointInfo::FIXED;
}

void Describe(const Robot& robot, v1::RobotReply* reply) {
  const Urdf& urdf = robot.Description();
  reply->set_name(robot.Name());
  reply->set_base(robot.Base());
  for (std::size_t i = 0; i < urdf.links.size(); ++i) {
    v1::LinkInfo* link = reply->add_link();
    link->set_name(urdf.links[i].name);
    link->set_original_name(urdf.links[i].originalName);
    link->set_frame(robot.LinkFrame(i));
    for (const ObjectId id : robot.LinkObjects(i)) {
      link->add_object(id);
    }
  }
  for (std::size_t i = 0; i < urdf.joints.size(); ++i) {
    const UrdfJoint& from = urdf.joints[i];
    v1::JointInfo* joint = reply->add_joint();
    joint->set_name(from.name);
    joint->set_type(FromType(from.type));
    joint->set_parent_link(std::uint32_t(from.parentLink));
    joint->set_child_link(std::uint32_t(from.childLink));
    Put(from.axis, joint->mutable_axis());
    if (from.hasLimits) {
      joint->set_lower(from.lower);
      joint->set_upper(from.upper);
    }
    joint->set_position(robot.Position(i));
    if (from.mimic >= 0) {
      joint->set_mimic(std::uint32_t(from.mimic));
      joint->set_mimic_multiplier(from.mimicMultiplier);
      joint->set_mimic_offset(from.mimicOffset);
    }
  }
}

std::size_t VisualCount(const Urdf& urdf) {
  std::size_t count = 0;
  for (const UrdfLink& link : urdf.links) {
    count += link.visuals.size();
  }
  return count;
}

// Ids either are all chosen by the interpreter or all stand in the command.
void CheckIds(const v1::LoadRobot& command, const Urdf& urdf, const std::string& label) {
  const bool given =
      command.base_id() != 0 || command.link_id_size() > 0 || command.object_id_size() > 0;
  if (command.object_name_size() != 0 &&
      std::size_t(command.object_name_size()) != VisualCount(urdf)) {
    Reject(label, "object_name does not fit the file; accepted: none, or " +
                      std::to_string(VisualCount(urdf)) + " of them");
  }
  if (given &&
      (command.base_id() == 0 || std::size_t(command.link_id_size()) != urdf.links.size() ||
       std::size_t(command.object_id_size()) != VisualCount(urdf))) {
    Reject(label, "base_id, link_id and object_id do not fit the file; accepted: none of them, or "
                  "1, " +
                      std::to_string(urdf.links.size()) + " and " +
                      std::to_string(VisualCount(urdf)) + " of them");
  }
}

// A visual of a link: its object in the link's frame, and its levels of detail.
struct RobotVisual {
  Eigen::Affine3d X_LO;
  std::vector<DetailLevel> levels;
};

// Creates the frames and objects of a robot with loaded geometry.
class RobotBuilder {
public:
  RobotBuilder(const Context& context, v1::LoadRobot& command, const Urdf& urdf)
      : Context_(context), Command_(command), Urdf_(urdf), LinkFrames_(urdf.links.size()),
        LinkObjects_(urdf.links.size()) {}

  std::unique_ptr<Robot> Build(std::vector<std::vector<RobotVisual>> visuals, const Pose& X_FB) {
    FrameTree& frames = this->Context_.Frames();
    const std::string& name = this->Command_.name();
    const FrameId base =
        frames.Create(ToFrame(this->Command_.frame()), name, X_FB, this->Command_.base_id());
    try {
      for (std::size_t i = 0; i < this->Urdf_.links.size(); ++i) {
        this->AddLink(i, base, std::move(visuals[i]));
      }
      auto robot =
          std::make_unique<Robot>(name, this->Urdf_, base, this->LinkFrames_, this->LinkObjects_);
      robot->Pose(frames);
      this->RecordIds(base);
      return robot;
    } catch (...) {
      this->Context_.GetScene().RemoveFrame(base); // its links and their objects go with it
      throw;
    }
  }

private:
  void AddLink(std::size_t index, FrameId base, std::vector<RobotVisual> visuals) {
    const UrdfLink& link = this->Urdf_.links[index];
    const FrameId parent = link.parentJoint < 0
                               ? base
                               : this->LinkFrames_[std::size_t(
                                     this->Urdf_.joints[std::size_t(link.parentJoint)].parentLink)];
    const int at = int(index);
    const FrameId id = at < this->Command_.link_id_size() ? this->Command_.link_id(at) : NoFrame;
    this->LinkFrames_[index] = this->Context_.Frames().Create(parent, link.name, {}, id);
    for (RobotVisual& visual : visuals) {
      this->LinkObjects_[index].push_back(this->AddVisual(index, std::move(visual)));
    }
  }

  ObjectId AddVisual(std::size_t link, RobotVisual visual) {
    Scene& scene = this->Context_.GetScene();
    GraphicsObject object;
    object.id = this->NextVisual_ < this->Command_.object_id_size()
                    ? this->Command_.object_id(this->NextVisual_)
                    : 0;
    const bool named = this->NextVisual_ < this->Command_.object_name_size();
    object.name =
        named ? this->Command_.object_name(this->NextVisual_)
              : scene.FreeObjectName(this->Command_.name() + "/" + this->Urdf_.links[link].name);
    ++this->NextVisual_;
    object.frame = this->LinkFrames_[link];
    object.nature = ToNature(this->Command_.nature(), RobotLabel(this->Command_.name()));
    object.fragment = this->Command_.fragment();
    object.X_FO = visual.X_LO;
    object.levels = std::move(visual.levels);
    return scene.AddObject(std::move(object));
  }

  void RecordIds(FrameId base) {
    this->Command_.set_base_id(base);
    this->Command_.clear_link_id();
    this->Command_.clear_object_id();
    this->Command_.clear_object_name();
    for (std::size_t i = 0; i < this->LinkFrames_.size(); ++i) {
      this->Command_.add_link_id(this->LinkFrames_[i]);
      for (const ObjectId id : this->LinkObjects_[i]) {
        this->Command_.add_object_id(id);
        this->Command_.add_object_name(this->Context_.GetScene().Object(id).name);
      }
    }
  }

  const Context& Context_;
  v1::LoadRobot& Command_;
  const Urdf& Urdf_;
  std::vector<FrameId> LinkFrames_;
  std::vector<std::vector<ObjectId>> LinkObjects_;
  int NextVisual_ = 0;
};

void LoadRobot(const Context& context, v1::LoadRobot& command) {
  const std::string path = AbsolutePath(command.path());
  ImportOptions options;
  options.strict = command.strict();
  const Urdf urdf = ImportUrdf(path, options);
  std::string name = command.name();
  if (name.empty()) {
    name = MappedFrameName(urdf.name.empty() ? std::filesystem::path(path).stem().string()
                                             : urdf.name);
  }
  const std::string label = RobotLabel(name);
  if (context.scene->robots.count(name)) {
    throw Error(Error::Kind::AlreadyExists, label, "there is a robot of this name already");
  }
  ToNature(command.nature(), label);
  CheckIds(command, urdf, label);
  const Pose X_FB = ToPose(command.pose(), label);
  for (const std::string& warning : UrdfWarnings(urdf)) {
    context.reply.add_warning(warning);
  }
  const auto geometry = LoadVisuals(context, urdf, options);
  auto levels = RobotLevels(context, command, urdf, geometry, options);
  std::vector<std::vector<RobotVisual>> visuals(geometry.size());
  for (std::size_t link = 0; link < geometry.size(); ++link) {
    for (std::size_t i = 0; i < geometry[link].size(); ++i) {
      visuals[link].push_back({geometry[link][i].X_LO, std::move(levels[link][i])});
    }
  }
  command.set_path(path);
  command.set_name(name);
  auto robot = RobotBuilder(context, command, urdf).Build(std::move(visuals), X_FB);
  Describe(*robot, context.reply.mutable_robot());
  context.scene->robots[name] = std::move(robot);
}

void RemoveRobot(const Context& context, v1::RemoveRobot& command) {
  const FrameId base = FindRobot(context, command.robot()).Base();
  context.GetScene().RemoveFrame(base);
  context.scene->EraseRemoved();
}

void SetJoints(const Context& context, v1::SetJoints& command) {
  Robot& robot = FindRobot(context, command.robot());
  if (command.joint_size() != command.position_size()) {
    Reject(RobotLabel(command.robot()),
           std::to_string(command.position_size()) + " positions for " +
               std::to_string(command.joint_size()) + " joints; accepted: one for each");
  }
  robot.SetPositions(context.Frames(), command.joint().data(), command.position().data(),
                     std::size_t(command.joint_size()), command.clamp());
}

void DescribeRobot(const Context& context, v1::DescribeRobot& command) {
  Describe(FindRobot(context, command.robot()), context.reply.mutable_robot());
}

void ListRobots(const Context& context, v1::ListRobots&) {
  v1::RobotList* list = context.reply.mutable_robots();
  for (const auto& [name, robot] : context.scene->robots) {
    list->add_name(name);
  }
}

} // namespace

void AddRobotCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kLoadRobot, &C::mutable_load_robot, LoadRobot);
  registry.Add(C::kRemoveRobot, &C::mutable_remove_robot, RemoveRobot);
  registry.Add(C::kSetJoints, &C::mutable_set_joints, SetJoints);
  registry.Add(C::kDescribeRobot, &C::mutable_describe_robot, DescribeRobot);
  registry.Add(C::kListRobots, &C::mutable_list_robots, ListRobots);
}

} // namespace dspace::session
