// Removes values from steps that the other side already has.
#ifndef DSPACE_SESSION_POSE_FILTER_H
#define DSPACE_SESSION_POSE_FILTER_H

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Stores the poses and telemetry values that were sent. A value is omitted only if the same bytes
// were sent in an accepted step and no later command can have changed it. The other side's state is
// then the same to the byte as if every value had been sent.
class PoseFilter {
public:
  // Removes redundant values from a set_poses or set_telemetry command. Other commands clear the
  // stored values that they may change. False if nothing is left to send.
  bool Pass(v1::Command& command);
  // The command was sent with this number. Its values become valid when Accepted reaches it.
  void Sent(const v1::Command& command, std::uint64_t number);
  void Accepted(std::uint64_t number) { this->Accepted_ = number; }
  // Drops all stored values: after an error, or if another client may have changed the state.
  void Clear() { this->Scenes_.clear(); }

  std::uint64_t LeftOut() const { return this->LeftOut_; }

private:
  struct Entry {
    std::array<double, 8> row; // a pose, or one value
    std::uint64_t number = 0;  // of the command that set it; 0: none
    std::uint64_t step = 0;    // the last step that contained it
  };
  struct Frames {
    std::vector<Entry> entries;
    std::unordered_map<std::uint64_t, std::uint32_t> entryOf; // of ids in `entries`
    // The ids of the last step: most steps of a simulation name the same frames.
    std::vector<std::uint64_t> ids;
    std::vector<std::uint32_t> order;
    bool unique = false; // each id occurs once
  };
  using Ids = google::protobuf::RepeatedField<std::uint64_t>;
  using Numbers = google::protobuf::RepeatedField<double>;
  bool FindEntries(Frames& frames, const Ids& ids);
  bool PassRows(Frames& frames, Ids& ids, Numbers& rows, int size);
  void SentRows(const v1::Command& command, const Ids& ids, const Numbers& rows, int size,
                std::uint64_t number);
  std::map<std::string, Frames> Scenes_;
  std::uint64_t Accepted_ = 0;
  std::uint64_t Step_ = 0;
  std::uint64_t LeftOut_ = 0;
};

// Whether the command certainly changes no local pose and no telemetry value.
bool KeepsPoses(const v1::Command& command);

} // namespace dspace::session

#endif
