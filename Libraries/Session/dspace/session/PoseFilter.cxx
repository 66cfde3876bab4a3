#include <dspace/session/PoseFilter.h>

#include <cstring>

namespace dspace::session {
namespace {

constexpr int PoseSize = 8;
constexpr std::size_t MostFrames = 10000000; // remembered in all scenes; beyond it begins anew

std::string SceneOf(const v1::Command& command) {
  return command.scene().empty() ? "scene" : command.scene();
}

} // namespace

bool LeavesPoses(const v1::Command& command) {
  using C = v1::Command;
  switch (command.command_case()) {
  case C::kListScenes:
  case C::kSetTime:
  case C::kGetTime:
  case C::kCreateFrame: // a new frame's id was never used before
  case C::kRenameFrame:
  case C::kFindFrame:
  case C::kGetPoses:
  case C::kListFrames:
  case C::kFollowFrames:
  case C::kCreatePrimitive:
  case C::kSetPrimitive:
  case C::kCreateTrail:
  case C::kAppendTrail:
  case C::kClearTrail:
  case C::kSetObjectVisible:
  case C::kSetMaterial:
  case C::kSetTilt:
  case C::kCreateText:
  case C::kSetText:
  case C::kSetLight:
  case C::kSetCamera:
  case C::kDescribeCamera:
  case C::kSetTextTable:
  case C::kCapture:
  case C::kSaveImage:
  case C::kRender:
  case C::kPick:
  case C::kQueryTerrain:
  case C::kTrackWheels:
  case C::kFocusTerrain:
  case C::kCreateTelemetry:
  case C::kSetTelemetryLimits:
  case C::kSetTelemetry:
  case C::kSetTelemetryTexts:
  case C::kRemoveTelemetry:
  case C::kListTelemetry:
  case C::kLogEvent:
  case C::kAskOperator:
  case C::kCloseQuestion:
  case C::kListEvents:
  case C::kListQuestions:
    return true;
  default:
    return false;
  }
}

bool PoseFilter::Pass(v1::Command& command) {
  if (command.has_set_poses()) {
    return this->PassPoses(this->Scenes_[SceneOf(command)], *command.mutable_set_poses());
  }
  if (!LeavesPoses(command)) {
    this->Forget();
  }
  return true;
}

// Finds the places of the frames; false when one stands twice.
bool PoseFilter::Look(Frames& frames, const v1::SetPoses& poses) {
  const std::size_t n = std::size_t(poses.frame_size());
  if (frames.ids.size() == n &&
      std::memcmp(frames.ids.data(), poses.frame().data(), n * sizeof(std::uint64_t)) == 0) {
    return frames.unique;
  }
  frames.ids.assign(poses.frame().begin(), poses.frame().end());
  frames.order.resize(n);
  frames.unique = true;
  ++this->Step_;
  for (std::size_t i = 0; i < n; ++i) {
    const auto [place, made] =
        frames.places.emplace(frames.ids[i], std::uint32_t(frames.entries.size()));
    if (made) {
      frames.entries.emplace_back();
    }
    frames.order[i] = place->second;
    std::uint64_t& step = frames.entries[place->second].step;
    frames.unique = frames.unique && step != this->Step_;
    step = this->Step_;
  }
  return frames.unique;
}

bool PoseFilter::PassPoses(Frames& frames, v1::SetPoses& poses) {
  const int n = poses.frame_size();
  if (n == 0 || poses.pose_size() != n * PoseSize ||
      poses.GetReflection()->GetUnknownFields(poses).field_count() > 0) {
    return true; // to be refused, or judged, by whoever carries it out
  }
  if (frames.entries.size() + std::size_t(n) > MostFrames) {
    frames = {};
  }
  if (!this->Look(frames, poses)) {
    return true; // likewise
  }
  int to = 0;
  for (int i = 0; i < n; ++i) {
    const Entry& entry = frames.entries[frames.order[std::size_t(i)]];
    const double* pose = poses.pose().data() + i * PoseSize;
    if (entry.number > 0 && entry.number <= this->Accepted_ &&
        std::memcmp(entry.pose.data(), pose, sizeof(entry.pose)) == 0) {
      continue; // it is there
    }
    if (to < i) {
      poses.set_frame(to, poses.frame(i));
      std::memmove(poses.mutable_pose()->mutable_data() + to * PoseSize, pose, sizeof(entry.pose));
    }
    ++to;
  }
  poses.mutable_frame()->Truncate(to);
  poses.mutable_pose()->Truncate(to * PoseSize);
  this->LeftOut_ += std::uint64_t(n - to);
  return to > 0;
}

void PoseFilter::Sent(const v1::Command& command, std::uint64_t number) {
  const v1::SetPoses& poses = command.set_poses();
  if (!command.has_set_poses() || poses.pose_size() != poses.frame_size() * PoseSize) {
    return;
  }
  Frames& frames = this->Scenes_[SceneOf(command)];
  // Those of the step that has just passed, less what was left out: in the same order.
  std::size_t at = 0;
  for (int i = 0; i < poses.frame_size(); ++i) {
    while (at < frames.ids.size() && frames.ids[at] != poses.frame(i)) {
      ++at;
    }
    if (at == frames.ids.size()) {
      this->Forget(); // Pass has not seen it
      return;
    }
    Entry& entry = frames.entries[frames.order[at]];
    std::memcpy(entry.pose.data(), poses.pose().data() + i * PoseSize, sizeof(entry.pose));
    entry.number = number;
    ++at;
  }
}

} // namespace dspace::session
