#include <dspace/state/MessageLog.h>

#include <algorithm>
#include <set>

#include <dspace/messages/CommandLimits.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/TextChecks.h>

namespace dspace::session {
namespace {

constexpr std::size_t MaximumEvent = 16384; // bytes
constexpr int MaximumData = 100;
constexpr int MaximumChoices = 100;
constexpr std::size_t MaximumQuestions = 1000; // open ones of a scene

void CheckSeverity(const std::string& label, v1::Severity severity) {
  if (!v1::Severity_IsValid(severity)) {
    Reject(label, "its severity is " + std::to_string(int(severity)) + "; accepted: 0 to 3");
  }
}

void CheckData(const std::string& label, const v1::LogEvent& event) {
  if (event.datum_size() > MaximumData) {
    Reject(label, "it has " + std::to_string(event.datum_size()) + " data; accepted: up to " +
                      std::to_string(MaximumData));
  }
  std::set<std::string> names;
  for (const v1::EventDatum& datum : event.datum()) {
    RequireWord(label, "the name of a datum", datum.name(), MostBytes("EventDatum.name"));
    RequireLines(label, "the text of a datum", datum.text(), MostBytes("EventDatum.text"));
    RequireLine(label, "the unit of a datum", datum.unit(), MostBytes("EventDatum.unit"));
    if (!names.insert(datum.name()).second) {
      Reject(label, "its datum " + QuotedText(datum.name()) + " occurs twice; accepted: once");
    }
    if (!datum.unit().empty() && !datum.has_number()) {
      Reject(label, "its datum " + QuotedText(datum.name()) +
                        " has a unit and is not a number; accepted: units of numbers only");
    }
  }
}

} // namespace

void MessageLog::Log(v1::LogEvent& event, double now) {
  const std::string label = "event " + QuotedText(event.kind());
  RequireWord(label, "its kind", event.kind(), MostBytes("LogEvent.kind"));
  RequireLines(label, "its text", event.text(), MostBytes("LogEvent.text"));
  RequireLine(label, "its frame's path", event.frame_path(), MaximumEvent);
  CheckSeverity(label, event.severity());
  CheckData(label, event);
  if (event.has_position()) {
    RequirePosition(label, "its position", ToVector(event.position()));
    if (event.frame() == 0 && event.frame_path().empty()) {
      Reject(label, "it has a position and no frame; accepted: a frame, 1 for the root");
    }
  }
  if (event.has_time_s()) {
    RequireFinite(label, "its time", event.time_s());
  }
  if (event.number() != 0 && event.number() <= this->LastNumber_) {
    Reject(label, "its number is " + std::to_string(event.number()) + "; accepted: above " +
                      std::to_string(this->LastNumber_) + ", or 0");
  }
  v1::LogEvent whole = event;
  if (whole.number() == 0) {
    whole.set_number(this->LastNumber_ + 1);
  }
  if (!whole.has_time_s()) {
    whole.set_time_s(now);
  }
  // As it is kept, which is what recordings, snapshots and viewers take it up from.
  const std::size_t bytes = whole.ByteSizeLong();
  if (bytes > MaximumEvent) {
    Reject(label, "it has " + std::to_string(bytes) +
                      " bytes with its number and time; accepted: "
                      "up to " +
                      std::to_string(MaximumEvent));
  }
  event = std::move(whole);
  this->LastNumber_ = event.number();
  this->Events_.push_back(event);
  if (this->Events_.size() > MaximumEvents) {
    this->Events_.pop_front();
  }
}

bool MessageLog::HasQuestion(const std::string& name) const {
  return std::any_of(this->Questions_.begin(), this->Questions_.end(),
                     [&](const auto& question) { return question.name() == name; });
}

void MessageLog::Ask(v1::AskOperator& question, double now) {
  const std::string label = "question " + QuotedText(question.name());
  RequireWord(label, "its name", question.name(), MostBytes("AskOperator.name"));
  RequireLines(label, "its text", question.text(), MostBytes("AskOperator.text"));
  CheckSeverity(label, question.severity());
  if (question.text().empty()) {
    Reject(label, "its text is empty; accepted: the question's text");
  }
  if (question.choice_size() > MaximumChoices) {
    Reject(label, "it has " + std::to_string(question.choice_size()) +
                      " choices; accepted: up to " + std::to_string(MaximumChoices));
  }
  std::set<std::string> choices;
  for (const std::string& choice : question.choice()) {
    RequireWord(label, "a choice", choice, MostBytes("AskOperator.choice"));
    if (!choices.insert(choice).second) {
      Reject(label, "its choice " + QuotedText(choice) + " occurs twice; accepted: once");
    }
  }
  if (question.has_time_s()) {
    RequireFinite(label, "its time", question.time_s());
  }
  if (this->Questions_.size() >= MaximumQuestions) {
    throw Error(Error::Kind::Resource, label,
                "the scene has " + std::to_string(MaximumQuestions) +
                    " open questions; accepted: no more");
  }
  if (!question.has_time_s()) {
    question.set_time_s(now);
  }
  this->Questions_.push_back(question);
}

void MessageLog::Close(const v1::CloseQuestion& command) {
  const std::string label = "question " + QuotedText(command.name());
  RequireLines(label, "its answer", command.answer(), MostBytes("CloseQuestion.answer"));
  RequireLine(label, "the name of who answered", command.from(), MostBytes("CloseQuestion.from"));
  const auto found =
      std::find_if(this->Questions_.begin(), this->Questions_.end(),
                   [&](const auto& question) { return question.name() == command.name(); });
  if (found == this->Questions_.end()) {
    throw Error(Error::Kind::NotFound, label, "there is no such open question");
  }
  this->Questions_.erase(found);
}

void MessageLog::Put(const std::string& scene, const std::function<bool(std::uint64_t)>& has,
                     std::vector<v1::Command>& out) const {
  for (const v1::LogEvent& event : this->Events_) {
    out.emplace_back().set_scene(scene);
    v1::LogEvent& put = *out.back().mutable_log_event();
    put = event;
    if (!has(put.frame())) {
      put.clear_frame();
    }
  }
  for (const v1::AskOperator& question : this->Questions_) {
    out.emplace_back().set_scene(scene);
    *out.back().mutable_ask_operator() = question;
  }
}

} // namespace dspace::session
