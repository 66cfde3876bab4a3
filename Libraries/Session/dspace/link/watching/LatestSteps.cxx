#include <dspace/link/watching/LatestSteps.h>

#include <algorithm>

#include <dspace/state/State.h>

namespace dspace::session {
namespace {

// The default scene has two names: steps that use both are applied all.
bool SetsTheSame(const v1::Command& a, const v1::Command& b) {
  if (a.command_case() != b.command_case() || a.scene() != b.scene()) {
    return false;
  }
  if (a.has_set_time()) {
    return true;
  }
  const auto& left = a.set_poses().frame();
  const auto& right = b.set_poses().frame();
  return left.size() == right.size() && std::equal(left.begin(), left.end(), right.begin());
}

constexpr std::size_t MostKinds =
    16; // of steps that are looked for: vehicles in messages of their own

} // namespace

bool IsStep(const v1::WatchReply& message) {
  if (!message.has_command()) {
    return false;
  }
  const v1::Command& command = message.command();
  return command.has_set_poses() || (command.has_set_time() && !command.set_time().put_lags() &&
                                     command.set_time().lag_size() == 0);
}

std::vector<bool> SupersededSteps(const std::vector<v1::WatchReply>& messages, std::size_t first) {
  std::size_t end = first;
  while (end < messages.size() && IsStep(messages[end])) {
    ++end;
  }
  std::vector<bool> superseded(end - first, false);
  std::vector<const v1::Command*> latest;
  for (std::size_t i = end; i-- > first;) {
    const v1::Command& command = messages[i].command();
    const auto same = [&](const v1::Command* later) { return SetsTheSame(command, *later); };
    if (std::any_of(latest.begin(), latest.end(), same)) {
      superseded[i - first] = true;
    } else if (latest.size() < MostKinds) {
      latest.push_back(&command);
    }
  }
  return superseded;
}

bool HasLaggingCamera(const State& state) {
  for (const auto& [name, held] : state.scenes) {
    for (const std::string& vantage : held.scene->VantageNames()) {
      const SceneVantage& cameras = held.scene->Vantage(vantage);
      for (const std::string& camera : cameras.CameraNames()) {
        if (cameras.GetCamera(camera).mount.smoothing_s > 0) {
          return true;
        }
      }
    }
  }
  return false;
}

} // namespace dspace::session
