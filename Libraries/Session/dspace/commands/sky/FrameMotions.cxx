// Frames and the Sun that follow the scene's time.
#include <google/protobuf/util/message_differencer.h>

#include <dspace/Checks.h>
#include <dspace/commands/sky/SkyTools.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/SunMessages.h>
#include <dspace/scene/bodies/SunSeen.h>
#include <dspace/state/SunPlace.h>

namespace dspace::session {
namespace {

std::string Label(const Context& context, FrameId frame) {
  return "frame '" + context.Frames().Path(frame) + "'";
}

// The frames in motion on `frame` that take from it what they are relative to.
void RequireNoFollowers(const Context& context, FrameId frame) {
  for (const auto& [id, motion] : context.scene->sky.frames) {
    if (!motion.has_parent() && context.Frames().Parent(id) == frame) {
      Reject(Label(context, frame), "it cannot stop: " + Label(context, id) +
                                        " on it follows the time relative to it; accepted: stop "
                                        "that one first");
    }
  }
}

// Two frames in motion on one parent cannot differ in what the parent stands for.
void RequireAgreement(const Context& context, const v1::SetFrameMotion& command) {
  const FrameId parent = context.Frames().Parent(command.frame());
  const auto& frames = context.scene->sky.frames;
  const auto agrees = [&](const v1::CelestialPlace& other, FrameId from) {
    if (!google::protobuf::util::MessageDifferencer::Equals(other, command.parent())) {
      Reject(Label(context, command.frame()),
             "its parent stands for " + command.parent().body() + ", " + command.parent().axes() +
                 " in this command, and for " + other.body() + ", " + other.axes() + " for " +
                 Label(context, from) + "; accepted: one place for each parent");
    }
  };
  const auto itself = frames.find(parent);
  if (itself != frames.end()) {
    agrees(itself->second.place(), parent);
  }
  for (const auto& [id, motion] : frames) {
    if (id != command.frame() && motion.has_parent() && context.Frames().Parent(id) == parent) {
      agrees(motion.parent(), id);
    }
  }
}

void SetFrameMotion(const Context& context, v1::SetFrameMotion& command) {
  FrameTree& tree = context.Frames();
  const FrameId frame = command.frame();
  tree.LocalPose(frame); // exists
  if (frame == RootFrame) {
    Reject("frame '/'", "the root has no pose; accepted: another frame");
  }
  for (const auto& [name, robot] : context.scene->robots) {
    if (frame != robot->Base() && robot->HasFrame(frame)) {
      Reject(Label(context, frame), "it is a link of robot '" + name +
                                        "' and cannot follow the time; accepted: its base frame");
    }
  }
  for (const auto& [base, model] : context.scene->models) {
    if (model.HasFrame(frame)) {
      Reject(Label(context, frame), "it is a node of a model and cannot follow the time; accepted: "
                                    "frame '" +
                                        tree.Path(base) + "', which holds its nodes");
    }
  }
  SkyMotions& sky = context.scene->sky;
  if (!command.has_place()) {
    RequireNoFollowers(context, frame);
    sky.frames.erase(frame);
    const Pose X = tree.LocalPose(frame);
    for (const double value : {X.position.x(), X.position.y(), X.position.z(), X.rotation.w(),
                               X.rotation.x(), X.rotation.y(), X.rotation.z(), X.scale}) {
      context.reply.mutable_poses()->add_pose(value);
    }
    return;
  }
  if (command.has_parent()) {
    RequireAgreement(context, command);
  }
  Pose X;
  if (command.has_pose()) {
    X = ToPose(command.pose(), Label(context, frame));
  } else {
    X = sky.PoseAt(tree, command, context.GetScene().Time());
  }
  tree.SetLocalPose(frame, X);
  Put(X, command.mutable_pose());
  sky.frames[frame] = command;
  sky.frames[frame].clear_pose();
  sky.NewFallbacks(); // the reply has them
  for (const double value : {X.position.x(), X.position.y(), X.position.z(), X.rotation.w(),
                             X.rotation.x(), X.rotation.y(), X.rotation.z(), X.scale}) {
    context.reply.mutable_poses()->add_pose(value);
  }
}

void SetSunMotion(const Context& context, v1::SetSunMotion& command) {
  SkyMotions& sky = context.scene->sky;
  if (command.stop()) {
    command.clear_sun(); // it stays where it is
    sky.sun.reset();
    return;
  }
  context.Frames().Path(ToFrame(command.frame())); // exists
  if (const GraphicsObject* body = FindSunBody(context.GetScene())) {
    // Its distance would count twice.
    Reject(SunLabel, "it cannot follow the scene's time: object '" + body->name +
                         "' is the Sun, which gives it direction, disc and irradiance; accepted: a "
                         "scene without such a body");
  }
  if (!command.has_sun()) {
    *command.mutable_sun() = sky.SunAt(context.Frames(), command, context.GetScene().Time());
  }
  context.GetScene().SetLight(MovedSun(context.GetScene(), command.sun()));
  sky.sun = command;
  sky.sun->clear_sun();
  sky.NewFallbacks();
}

} // namespace

void AddFrameMotions(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kSetFrameMotion, &C::mutable_set_frame_motion, SetFrameMotion);
  registry.Add(C::kSetSunMotion, &C::mutable_set_sun_motion, SetSunMotion);
}

} // namespace dspace::session
