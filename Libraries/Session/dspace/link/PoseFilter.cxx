#include <dspace/link/PoseFilter.h>

#include <cstring>

#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/CommandTraits.h>

namespace dspace::session {
namespace {

constexpr int PoseSize = 8;
constexpr std::size_t MostFrames =
    10000000; // stored in all scenes; the filter is cleared beyond this

// Of a scene's poses, or of its telemetry.
std::string KeyOf(const v1::Command& command) {
  return SceneName(command) + (command.has_set_telemetry() ? std::string(1, '\0') : std::string());
}

template<class Message> bool HasUnknown(const Message& message) {
  return message.GetReflection()->GetUnknownFields(message).field_count() > 0;
}

} // namespace

bool KeepsPoses(const v1::Command& command) {
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  return traits && traits->KeepsPoses();
}

bool PoseFilter::Pass(v1::Command& command) {
  if (HasUnknown(command)) { // has unknown fields
    this->Clear();
    return true;
  }
  if (command.has_set_poses()) {
    v1::SetPoses& poses = *command.mutable_set_poses();
    const int before = poses.frame_size();
    const bool left =
        HasUnknown(poses) || this->PassRows(this->Scenes_[KeyOf(command)], *poses.mutable_frame(),
                                            *poses.mutable_pose(), PoseSize);
    this->LeftOut_ += std::uint64_t(before - poses.frame_size());
    return left;
  }
  if (command.has_set_telemetry()) {
    v1::SetTelemetry& set = *command.mutable_set_telemetry();
    if (set.time_s_size() > 0 || HasUnknown(set)) { // has more than values
      this->Scenes_.erase(KeyOf(command));
      return true;
    }
    return this->PassRows(this->Scenes_[KeyOf(command)], *set.mutable_id(), *set.mutable_value(),
                          1);
  }
  if (!KeepsPoses(command)) {
    this->Clear();
  }
  return true;
}

// Finds the entries of the ids; false if an id occurs twice.
bool PoseFilter::FindEntries(Frames& frames, const Ids& ids) {
  const std::size_t n = std::size_t(ids.size());
  if (frames.ids.size() == n &&
      std::memcmp(frames.ids.data(), ids.data(), n * sizeof(std::uint64_t)) == 0) {
    return frames.unique;
  }
  frames.ids.assign(ids.begin(), ids.end());
  frames.order.resize(n);
  frames.unique = true;
  ++this->Step_;
  for (std::size_t i = 0; i < n; ++i) {
    const auto [place, made] =
        frames.entryOf.emplace(frames.ids[i], std::uint32_t(frames.entries.size()));
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

// Rows of `size` numbers, one an id.
bool PoseFilter::PassRows(Frames& frames, Ids& ids, Numbers& rows, int size) {
  const int n = ids.size();
  if (n == 0 || rows.size() != n * size) {
    return true; // the server checks it
  }
  if (frames.entries.size() + std::size_t(n) > MostFrames) {
    frames = {};
  }
  if (!this->FindEntries(frames, ids)) {
    return true; // likewise
  }
  const std::size_t bytes = std::size_t(size) * sizeof(double);
  int to = 0;
  for (int i = 0; i < n; ++i) {
    const Entry& entry = frames.entries[frames.order[std::size_t(i)]];
    const double* row = rows.data() + i * size;
    if (entry.number > 0 && entry.number <= this->Accepted_ &&
        std::memcmp(entry.row.data(), row, bytes) == 0) {
      continue; // the other side has it
    }
    if (to < i) {
      ids.Set(to, ids.Get(i));
      std::memmove(rows.mutable_data() + to * size, row, bytes);
    }
    ++to;
  }
  ids.Truncate(to);
  rows.Truncate(to * size);
  return to > 0;
}

void PoseFilter::Sent(const v1::Command& command, std::uint64_t number) {
  const v1::SetPoses& poses = command.set_poses();
  const v1::SetTelemetry& set = command.set_telemetry();
  if (command.has_set_poses() && poses.pose_size() == poses.frame_size() * PoseSize) {
    this->SentRows(command, poses.frame(), poses.pose(), PoseSize, number);
  } else if (command.has_set_telemetry() && set.time_s_size() == 0 && !HasUnknown(set) &&
             set.value_size() == set.id_size()) {
    this->SentRows(command, set.id(), set.value(), 1, number);
  }
}

void PoseFilter::SentRows(const v1::Command& command, const Ids& ids, const Numbers& rows, int size,
                          std::uint64_t number) {
  Frames& frames = this->Scenes_[KeyOf(command)];
  // The ids of the step that passed last, without the omitted ones, in the same order.
  std::size_t at = 0;
  for (int i = 0; i < ids.size(); ++i) {
    while (at < frames.ids.size() && frames.ids[at] != ids.Get(i)) {
      ++at;
    }
    if (at == frames.ids.size()) {
      this->Clear(); // Pass has not seen it
      return;
    }
    Entry& entry = frames.entries[frames.order[at]];
    std::memcpy(entry.row.data(), rows.data() + i * size, std::size_t(size) * sizeof(double));
    entry.number = number;
    ++at;
  }
}

} // namespace dspace::session
