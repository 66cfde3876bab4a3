// Events of a simulation, and questions to the operator.
#include <algorithm>

#include <dspace/Checks.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/overlay/TextCharacters.h>

namespace dspace::session {
namespace {

constexpr std::size_t LongestPath = 4096; // of a frame that an event names; beyond, its name alone

void LogEvent(const Context& context, v1::LogEvent& command) {
  v1::LogEvent event = command;
  if (event.frame() != 0) {
    const FrameTree& frames = context.Frames();
    const std::string path = frames.Path(event.frame()); // throws where there is none
    if (event.frame_path().empty()) {
      event.set_frame_path(path.empty()                ? "/"
                           : path.size() > LongestPath ? frames.Name(event.frame())
                                                       : path);
    }
  }
  context.scene->messages.Log(event, context.GetScene().Time());
  command = event;
  *context.reply.mutable_event() = event;
}

bool Fits(const v1::LogEvent& event, const v1::ListEvents& wanted) {
  return event.number() > wanted.after() &&
         (!wanted.has_since_s() || event.time_s() >= wanted.since_s()) &&
         (!wanted.has_until_s() || event.time_s() <= wanted.until_s()) &&
         event.severity() >= wanted.severity() &&
         (wanted.kind_size() == 0 || std::find(wanted.kind().begin(), wanted.kind().end(),
                                               event.kind()) != wanted.kind().end());
}

void ListEvents(const Context& context, v1::ListEvents& command) {
  const MessageLog& log = context.scene->messages;
  v1::EventList* list = context.reply.mutable_events();
  list->set_last(log.LastNumber());
  list->set_first(log.Events().empty() ? 0 : log.Events().front().number());
  std::vector<const v1::LogEvent*> found;
  for (auto it = log.Events().rbegin(); it != log.Events().rend(); ++it) {
    if (Fits(*it, command) && (command.most() == 0 || found.size() < command.most())) {
      found.push_back(&*it);
    }
  }
  for (auto it = found.rbegin(); it != found.rend(); ++it) {
    v1::LogEvent* event = list->add_event();
    *event = **it;
    if (!context.Frames().Contains(event->frame())) {
      event->clear_frame();
    }
  }
}

void AskOperator(const Context& context, v1::AskOperator& command) {
  for (const auto& [name, scene] : context.state.scenes) {
    if (scene.messages.HasQuestion(command.name())) {
      throw Error(Error::Kind::AlreadyExists, "question " + QuotedText(command.name()),
                  "it is already open, in scene '" + name +
                      "'; accepted: another name, or after "
                      "it is closed");
    }
  }
  context.scene->messages.Ask(command, context.GetScene().Time());
}

void ListQuestions(const Context& context, v1::ListQuestions&) {
  v1::QuestionList* list = context.reply.mutable_questions();
  for (const v1::AskOperator& question : context.scene->messages.Questions()) {
    *list->add_question() = question;
  }
}

} // namespace

void AddMessageCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kLogEvent, &C::mutable_log_event, LogEvent);
  registry.Add(C::kAskOperator, &C::mutable_ask_operator, AskOperator);
  registry.Add(C::kCloseQuestion, &C::mutable_close_question,
               [](const Context& context, v1::CloseQuestion& command) {
                 context.scene->messages.Close(command);
               });
  registry.Add(C::kListEvents, &C::mutable_list_events, ListEvents);
  registry.Add(C::kListQuestions, &C::mutable_list_questions, ListQuestions);
}

} // namespace dspace::session
