// The frame tree.
#include <algorithm>

#include <dspace/Checks.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/NearMatches.h>

namespace dspace::session {
namespace {

void AddPose(const Pose& X, google::protobuf::RepeatedField<double>* out) {
  for (const double value : {X.position.x(), X.position.y(), X.position.z(), X.rotation.w(),
                             X.rotation.x(), X.rotation.y(), X.rotation.z(), X.scale}) {
    out->Add(value);
  }
}

void CreateFrame(const Context& context, v1::CreateFrame& command) {
  const FrameId parent = ToFrame(command.parent());
  const Pose X_PF = ToPose(command.pose(), "frame '" + command.name() + "'");
  const FrameId id = context.Frames().Create(parent, command.name(), X_PF, command.id());
  command.set_id(id);
  context.reply.mutable_frame()->set_frame(id);
}

void CreateFrames(const Context& context, v1::CreateFrames& command) {
  const std::string label = "command create_frames";
  const std::size_t n = std::size_t(command.name_size());
  const std::size_t rows = RowsOf(command.pose_size(), PoseSize, label, "pose");
  const std::size_t parents = std::size_t(command.parent_size());
  if (n == 0 || (rows != 0 && rows != n) || (parents > 1 && parents != n)) {
    Reject(label, std::to_string(n) + " names, " + std::to_string(parents) + " parents and " +
                      std::to_string(rows) +
                      " poses are given; accepted: one name or more, and of parents and poses none "
                      "or one of each frame, or one parent of all");
  }
  std::vector<FrameId> above;
  for (const FrameId parent : command.parent()) {
    above.push_back(ToFrame(parent));
  }
  if (above.empty()) {
    above.push_back(RootFrame);
  }
  const FrameId first =
      context.Frames().CreateMany({command.name().begin(), command.name().end()}, above,
                                  rows == 0 ? nullptr : command.pose().data(), command.id());
  command.set_id(first);
  context.reply.mutable_frame()->set_frame(first);
}

// The frame of a link or of a model's node belongs to the whole: poses may be set, the tree may
// not be taken apart.
void RejectRobotsLink(const Context& context, FrameId frame, const char* what) {
  for (const auto& [name, robot] : context.scene->robots) {
    if (frame != robot->Base() && robot->HasFrame(frame)) {
      Reject("frame '" + context.Frames().Path(frame) + "'",
             std::string("it is a link of robot '") + name + "' and cannot be " + what +
                 "; accepted: the robot's base frame");
    }
  }
  for (const auto& [base, model] : context.scene->models) {
    if (model.HasFrame(frame)) {
      Reject("frame '" + context.Frames().Path(frame) + "'",
             std::string("it is a node of a model and cannot be ") + what + "; accepted: frame '" +
                 context.Frames().Path(base) + "', which holds its nodes");
    }
  }
}

// A frame that follows a trajectory is where the trajectory is.
void RejectFollower(const Context& context, FrameId frame, const char* what) {
  const ObjectId trajectory = context.scene->FollowedBy(frame);
  if (trajectory != 0) {
    Reject("frame '" + context.Frames().Path(frame) + "'",
           "it follows object '" + context.GetScene().Object(trajectory).name + "' and cannot be " +
               what + "; accepted: set_trajectory_frame with frame 0 first");
  }
}

void RemoveFrame(const Context& context, v1::RemoveFrame& command) {
  FrameTree& frames = context.Frames();
  std::vector<FrameId> removed;
  if (frames.Contains(command.frame())) {
    RejectRobotsLink(context, command.frame(), "removed");
    std::vector<FrameId> open = {command.frame()};
    while (!open.empty()) { // parents first; turned round below
      removed.push_back(open.back());
      open.pop_back();
      const std::vector<FrameId>& children = frames.Children(removed.back());
      open.insert(open.end(), children.begin(), children.end());
    }
  }
  RejectFollower(context, command.frame(), "removed");
  context.GetScene().RemoveFrame(command.frame());
  context.scene->EraseRemoved();
  v1::RemovedFrames* reply = context.reply.mutable_removed_frames();
  for (auto it = removed.rbegin(); it != removed.rend(); ++it) {
    reply->add_frame(*it);
  }
}

void ReparentFrame(const Context& context, v1::ReparentFrame& command) {
  if (context.Frames().Contains(command.frame())) {
    RejectRobotsLink(context, command.frame(), "moved to another parent");
    context.scene->sky.RequireFree(context.Frames(), command.frame(), "moved to another parent");
  }
  RejectFollower(context, command.frame(), "moved to another parent");
  context.Frames().Reparent(command.frame(), ToFrame(command.parent()), command.keep_world_pose());
  AddPose(context.Frames().LocalPose(command.frame()),
          context.reply.mutable_poses()->mutable_pose());
}

void RenameFrame(const Context& context, v1::RenameFrame& command) {
  context.Frames().Rename(command.frame(), command.name());
}

void SetPoses(const Context& context, v1::SetPoses& command) {
  const std::size_t n = RowsOf(command.pose_size(), PoseSize, "command set_poses", "pose");
  if (n != std::size_t(command.frame_size())) {
    Reject("command set_poses", "pose holds " + std::to_string(n) + " poses for " +
                                    std::to_string(command.frame_size()) +
                                    " frames; accepted: one of 8 numbers for each");
  }
  for (const auto& [frame, motion] : context.scene->sky.frames) {
    if (std::find(command.frame().begin(), command.frame().end(), frame) != command.frame().end()) {
      context.scene->sky.RequireFree(context.Frames(), frame, "posed");
    }
  }
  if (!context.scene->trajectories.empty()) {
    for (const FrameId frame : command.frame()) {
      RejectFollower(context, frame, "moved");
    }
  }
  context.Frames().SetLocalPoses(command.frame().data(), command.pose().data(), n);
}

// Paths of frames below `base` that may have been meant by a path that does not exist.
std::string NearFrames(const FrameTree& frames, FrameId base, const std::string& path) {
  // Frames that are compared: about a millisecond, since scripts look up names to see whether they
  // are taken.
  constexpr std::size_t Most = 2000;
  const std::size_t above = base == RootFrame ? 0 : frames.Path(base).size() + 1;
  std::vector<std::string> names;
  std::vector<FrameId> open = {base};
  while (!open.empty() && names.size() < Most) {
    const FrameId frame = open.back();
    open.pop_back();
    if (frame != base) {
      names.push_back(frames.Path(frame).substr(above));
    }
    const std::vector<FrameId>& children = frames.Children(frame);
    open.insert(open.end(), children.rbegin(), children.rend());
  }
  return NearMatchesText(path, names);
}

void FindFrame(const Context& context, v1::FindFrame& command) {
  const FrameId base = ToFrame(command.base());
  const FrameId found = context.Frames().Find(command.path(), base);
  if (found == NoFrame) {
    throw Error(Error::Kind::NotFound, "frame '" + command.path() + "'",
                "there is no such frame below '" + context.Frames().Path(base) + "'" +
                    NearFrames(context.Frames(), base, command.path()));
  }
  context.reply.mutable_frame()->set_frame(found);
}

void GetPoses(const Context& context, v1::GetPoses& command) {
  const FrameTree& frames = context.Frames();
  const FrameId W = ToFrame(command.relative_to());
  google::protobuf::RepeatedField<double>* out = context.reply.mutable_poses()->mutable_pose();
  out->Reserve(command.frame_size() * PoseSize);
  for (const FrameId id : command.frame()) {
    AddPose(command.local() ? frames.LocalPose(id) : frames.RelativePose(W, id), out);
  }
}

void AddFrameInfo(const FrameTree& frames, FrameId id, v1::FrameList* list) {
  v1::FrameInfo* info = list->add_frame();
  info->set_id(id);
  info->set_parent(frames.Parent(id));
  info->set_name(frames.Name(id));
  info->set_path(frames.Path(id));
  for (const FrameId child : frames.Children(id)) {
    info->add_child(child);
  }
}

void ListFrames(const Context& context, v1::ListFrames& command) {
  const FrameTree& frames = context.Frames();
  v1::FrameList* list = context.reply.mutable_frames();
  std::vector<FrameId> open = {ToFrame(command.below())};
  while (!open.empty()) {
    const FrameId id = open.back();
    open.pop_back();
    AddFrameInfo(frames, id, list);
    if (!command.shallow()) {
      const std::vector<FrameId>& children = frames.Children(id);
      open.insert(open.end(), children.rbegin(), children.rend());
    }
  }
}

void FollowFrames(const Context& context, v1::FollowFrames& command) {
  std::unique_ptr<FrameFollower>& follower = context.scene->follower;
  if (command.stop()) {
    follower.reset();
  } else if (!follower) {
    follower = std::make_unique<FrameFollower>(context.scene->scene, context.state.frameEvents);
  }
}

} // namespace

void AddFrameCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kCreateFrame, &C::mutable_create_frame, CreateFrame);
  registry.Add(C::kCreateFrames, &C::mutable_create_frames, CreateFrames);
  registry.Add(C::kRemoveFrame, &C::mutable_remove_frame, RemoveFrame);
  registry.Add(C::kReparentFrame, &C::mutable_reparent_frame, ReparentFrame);
  registry.Add(C::kRenameFrame, &C::mutable_rename_frame, RenameFrame);
  registry.Add(C::kSetPoses, &C::mutable_set_poses, SetPoses);
  registry.Add(C::kFindFrame, &C::mutable_find_frame, FindFrame);
  registry.Add(C::kGetPoses, &C::mutable_get_poses, GetPoses);
  registry.Add(C::kListFrames, &C::mutable_list_frames, ListFrames);
  registry.Add(C::kFollowFrames, &C::mutable_follow_frames, FollowFrames);
}

} // namespace dspace::session
