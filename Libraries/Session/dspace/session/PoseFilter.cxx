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
    return true;
  default:
    return false;
  }
}

bool PoseFilter::Pass(v1::Command& command) {
  if (command.has_set_poses()) {
    const auto found = this->Scenes_.find(SceneOf(command));
    return found == this->Scenes_.end() ||
           this->PassPoses(found->second, *command.mutable_set_poses());
  }
  if (!LeavesPoses(command)) {
    this->Forget();
  }
  return true;
}

bool PoseFilter::PassPoses(Frames& frames, v1::SetPoses& poses) {
  const int n = poses.frame_size();
  if (n == 0 || poses.pose_size() != n * PoseSize ||
      poses.GetReflection()->GetUnknownFields(poses).field_count() > 0) {
    return true; // to be refused, or judged, by whoever carries it out
  }
  ++this->Step_;
  // First whether anything may go: a frame that stands twice is to be refused.
  int kept = 0;
  std::string stays(std::size_t(n), '\0');
  for (int i = 0; i < n; ++i) {
    const auto found = frames.find(poses.frame(i));
    if (found == frames.end()) {
      stays[std::size_t(i)] = 1;
      ++kept;
      continue;
    }
    Entry& entry = found->second;
    if (entry.step == this->Step_) {
      return true;
    }
    entry.step = this->Step_;
    const bool same =
        entry.number <= this->Accepted_ &&
        std::memcmp(entry.pose.data(), poses.pose().data() + i * PoseSize, sizeof(entry.pose)) == 0;
    stays[std::size_t(i)] = same ? 0 : 1;
    kept += same ? 0 : 1;
  }
  if (kept == n) {
    return true;
  }
  this->LeftOut_ += std::uint64_t(n - kept);
  int to = 0;
  for (int i = 0; i < n; ++i) {
    if (stays[std::size_t(i)]) {
      poses.set_frame(to, poses.frame(i));
      std::memmove(poses.mutable_pose()->mutable_data() + to * PoseSize,
                   poses.pose().data() + i * PoseSize, PoseSize * sizeof(double));
      ++to;
    }
  }
  poses.mutable_frame()->Truncate(kept);
  poses.mutable_pose()->Truncate(kept * PoseSize);
  return kept > 0;
}

void PoseFilter::Sent(const v1::Command& command, std::uint64_t number) {
  const v1::SetPoses& poses = command.set_poses();
  if (!command.has_set_poses() || poses.pose_size() != poses.frame_size() * PoseSize) {
    return;
  }
  Frames& frames = this->Scenes_[SceneOf(command)];
  if (frames.size() + std::size_t(poses.frame_size()) > MostFrames) {
    frames.clear();
  }
  for (int i = 0; i < poses.frame_size(); ++i) {
    Entry& entry = frames[poses.frame(i)];
    std::memcpy(entry.pose.data(), poses.pose().data() + i * PoseSize, sizeof(entry.pose));
    entry.number = number;
  }
}

} // namespace dspace::session
