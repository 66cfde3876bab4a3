// The logged events and open questions of one scene.
#ifndef DSPACE_SESSION_MESSAGE_LOG_H
#define DSPACE_SESSION_MESSAGE_LOG_H

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Invalid input throws Error and changes nothing. The interpreter and the ledger have one for each
// scene; the ledger converts it to commands.
class MessageLog {
public:
  static constexpr std::size_t MaximumEvents = 10000; // older ones are dropped

  // Stores an event. Writes its number and, if absent, the time `now` into it. Checks all fields
  // except the existence of its frame.
  void Log(v1::LogEvent& event, double now);
  // Stores a question, in the same way.
  void Ask(v1::AskOperator& question, double now);
  void Close(const v1::CloseQuestion& command);

  const std::deque<v1::LogEvent>& Events() const { return this->Events_; }
  std::uint64_t LastNumber() const { return this->LastNumber_; }
  const std::vector<v1::AskOperator>& Questions() const { return this->Questions_; }
  bool HasQuestion(const std::string& name) const;

  // Appends the commands that recreate it in the scene of this name; `has` returns whether a frame
  // exists.
  void Put(const std::string& scene, const std::function<bool(std::uint64_t)>& has,
           std::vector<v1::Command>& out) const;

private:
  std::deque<v1::LogEvent> Events_;
  std::uint64_t LastNumber_ = 0;
  std::vector<v1::AskOperator> Questions_;
};

} // namespace dspace::session

#endif
