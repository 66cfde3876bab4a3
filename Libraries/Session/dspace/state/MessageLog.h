// What a simulation has said in one scene: events that are kept, questions that are open.
#ifndef DSPACE_SESSION_MESSAGE_LOG_H
#define DSPACE_SESSION_MESSAGE_LOG_H

#include <cstdint>
#include <deque>
#include <functional>
#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Whatever is refused throws Error and changes nothing. The interpreter keeps one for a scene, and
// so does the ledger, which writes it out as commands.
class MessageLog {
public:
  static constexpr std::size_t MaximumEvents = 10000; // the oldest are forgotten beyond

  // Writes the number and, where it has none, the time `now` into the event; all else of it is
  // checked, but that its frame is there.
  void Log(v1::LogEvent& event, double now);
  // Likewise.
  void Ask(v1::AskOperator& question, double now);
  void Close(const v1::CloseQuestion& command);

  const std::deque<v1::LogEvent>& Events() const { return this->Events_; }
  std::uint64_t LastNumber() const { return this->LastNumber_; }
  const std::vector<v1::AskOperator>& Questions() const { return this->Questions_; }
  bool HasQuestion(const std::string& name) const;

  // The commands that make it, of the scene of that name; `has` says whether a frame is there.
  void Put(const std::string& scene, const std::function<bool(std::uint64_t)>& has,
           std::vector<v1::Command>& out) const;

private:
  std::deque<v1::LogEvent> Events_;
  std::uint64_t LastNumber_ = 0;
  std::vector<v1::AskOperator> Questions_;
};

} // namespace dspace::session

#endif
