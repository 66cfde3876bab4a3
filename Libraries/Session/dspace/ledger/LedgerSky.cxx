#include <dspace/ledger/LedgerSky.h>

#include <algorithm>

#include <dspace/FrameTree.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Light.h>

namespace dspace::session {
namespace {

v1::Command& Added(const std::string& scene, std::vector<v1::Command>& out) {
  out.emplace_back().set_scene(scene);
  return out.back();
}

} // namespace

bool LedgerSky::Add(const v1::Command& command) {
  using C = v1::Command;
  std::vector<std::string>& kernels = this->Kernels_;
  const auto drop = [&](const std::string& path) {
    kernels.erase(std::remove(kernels.begin(), kernels.end(), path), kernels.end());
  };
  switch (command.command_case()) {
  case C::kLoadKernels:
    for (const std::string& path : command.load_kernels().path()) {
      drop(path);
      kernels.push_back(path);
    }
    return true;
  case C::kUnloadKernels:
    for (const std::string& path : command.unload_kernels().path()) {
      drop(path);
    }
    if (command.unload_kernels().path().empty()) {
      kernels.clear();
    }
    return true;
  case C::kSetFrameMotion:
    if (command.set_frame_motion().has_place()) {
      this->Frames_[command.set_frame_motion().frame()] = command.set_frame_motion();
    } else {
      this->Frames_.erase(command.set_frame_motion().frame());
    }
    return true;
  case C::kSetSunMotion:
    this->Sun_.reset();
    if (!command.set_sun_motion().stop()) {
      this->Sun_ = command.set_sun_motion();
    }
    return true;
  case C::kRemoveLight:
    if (command.remove_light().name() == SunName) {
      this->Sun_.reset();
    }
    return false; // the light itself is stored elsewhere
  case C::kSetTime: {
    const v1::SkyStep& step = command.set_time().sky();
    for (int i = 0; i < step.frame_size(); ++i) {
      const auto found = this->Frames_.find(step.frame(i));
      if (found != this->Frames_.end() && step.pose_size() >= PoseSize * (i + 1)) {
        const double* p = step.pose().data() + std::ptrdiff_t(PoseSize) * i;
        session::Put(Pose{{p[0], p[1], p[2]}, {p[3], p[4], p[5], p[6]}, p[7]},
                     found->second.mutable_pose());
      }
    }
    if (this->Sun_ && step.has_sun()) {
      *this->Sun_->mutable_sun() = step.sun();
    }
    return false; // the time itself is stored elsewhere
  }
  default:
    return false;
  }
}

std::vector<v1::Command> LedgerSky::Effects(const v1::Command& command, const v1::Reply& reply) {
  std::vector<v1::Command> out;
  const auto pose = [&](const auto& frames, const auto& poses) {
    v1::SetPoses* set = Added(command.scene(), out).mutable_set_poses();
    set->mutable_frame()->Add(frames.begin(), frames.end());
    set->mutable_pose()->Add(poses.begin(), poses.end());
  };
  if (command.has_set_frame_motion()) {
    pose(std::vector<std::uint64_t>{command.set_frame_motion().frame()}, reply.poses().pose());
  } else if (command.has_set_sun_motion() && !command.set_sun_motion().stop() &&
             command.set_sun_motion().has_sun()) {
    *Added(command.scene(), out).mutable_set_sun()->mutable_sun() = command.set_sun_motion().sun();
  } else if (command.has_set_time() && command.set_time().has_sky()) {
    const v1::SkyStep& step = command.set_time().sky();
    if (step.frame_size() > 0) {
      pose(step.frame(), step.pose());
    }
    if (step.has_sun()) {
      *Added(command.scene(), out).mutable_set_sun()->mutable_sun() = step.sun();
    }
  }
  return out;
}

void LedgerSky::RemoveOn(const std::unordered_set<std::uint64_t>& frames) {
  for (const std::uint64_t frame : frames) {
    this->Frames_.erase(frame);
  }
  if (this->Sun_ && frames.count(ToFrame(this->Sun_->frame()))) {
    this->Sun_.reset();
  }
}

void LedgerSky::Put(const std::string& scene, Emit out) const {
  if (!this->Kernels_.empty()) {
    v1::LoadKernels* load = Added(scene, out).mutable_load_kernels();
    for (const std::string& path : this->Kernels_) {
      load->add_path(path);
    }
  }
  for (const auto& [frame, motion] : this->Frames_) {
    *Added(scene, out).mutable_set_frame_motion() = motion;
  }
}

void LedgerSky::PutLast(const std::string& scene, Emit out) const {
  if (this->Sun_) {
    *Added(scene, out).mutable_set_sun_motion() = *this->Sun_;
  }
}

} // namespace dspace::session
