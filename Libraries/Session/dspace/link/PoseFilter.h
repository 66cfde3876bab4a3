// Leaves out of steps what the other side has already.
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

// Remembers the poses and values of telemetry that were sent, and when. One is left out only if the
// very same bytes were sent in a step that is known to be accepted and nothing since can have moved
// the frame, so that the other side's state is the same to the byte as if everything were sent.
class PoseFilter {
public:
  // Takes what need not be sent out of a set_poses or set_telemetry; of other commands it notes
  // what they may move. False when nothing is left to send.
  bool Pass(v1::Command& command);
  // The command was sent with this number: its poses count once Accepted reaches it.
  void Sent(const v1::Command& command, std::uint64_t number);
  void Accepted(std::uint64_t number) { this->Accepted_ = number; }
  // Something went wrong, or somebody else may have changed things.
  void Forget() { this->Scenes_.clear(); }

  std::uint64_t LeftOut() const { return this->LeftOut_; }

private:
  struct Entry {
    std::array<double, 8> row; // a pose, or one value
    std::uint64_t number = 0;  // of the command that set it; 0: none did
    std::uint64_t step = 0;    // in which it was seen last
  };
  struct Frames {
    std::vector<Entry> entries;
    std::unordered_map<std::uint64_t, std::uint32_t> places; // of ids in `entries`
    // Of the step that Pass saw last: a simulation sends the same frames again and again.
    std::vector<std::uint64_t> ids;
    std::vector<std::uint32_t> order;
    bool unique = false; // no frame stands twice in it
  };
  using Ids = google::protobuf::RepeatedField<std::uint64_t>;
  using Numbers = google::protobuf::RepeatedField<double>;
  bool Look(Frames& frames, const Ids& ids);
  bool PassRows(Frames& frames, Ids& ids, Numbers& rows, int size);
  void SentRows(const v1::Command& command, const Ids& ids, const Numbers& rows, int size,
                std::uint64_t number);
  std::map<std::string, Frames> Scenes_;
  std::uint64_t Accepted_ = 0;
  std::uint64_t Step_ = 0;
  std::uint64_t LeftOut_ = 0;
};

// Whether the command leaves all local poses and values of telemetry as they are, for certain.
bool KeepsPoses(const v1::Command& command);

} // namespace dspace::session

#endif
