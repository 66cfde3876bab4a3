#include <dspace/widgets/timeline/SceneTimeSource.h>

#include <algorithm>
#include <utility>

#include "vtkDspaceSession.h"
#include "vtkSmartPointer.h"

#include <dspace/Error.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/widgets/timeline/LoggedEvents.h>

namespace dspace::widgets {
namespace {

[[noreturn]] void Refuse(const char* what) {
  throw Error(Error::Kind::Unsupported, "timeline",
              std::string("a live simulation sets its time itself; ") + what +
                  " is possible in a playback");
}

} // namespace

SceneTimeSource::SceneTimeSource(std::function<std::shared_ptr<Scene>()> scene, bool j2000)
    : Scene_(std::move(scene)) {
  this->State_.j2000 = j2000;
  this->State_.grows = true;
  this->State_.following = true;
  this->Advance(0.0);
}

void SceneTimeSource::SetEvents(Events_t events) {
  this->NextEvents_ = std::move(events);
}

void SceneTimeSource::SetBegin(std::function<std::optional<double>()> begin) {
  this->Begin_ = std::move(begin);
  this->State_.range.reset();
  this->Advance(0.0);
}

void SceneTimeSource::Advance(double) {
  if (const std::shared_ptr<Scene> scene = this->Scene_()) {
    const double time_s = scene->Time();
    this->State_.playing = time_s != this->State_.time_s;
    this->State_.time_s = time_s;
    std::optional<TimeRange>& range = this->State_.range;
    range = range ? TimeRange{std::min(range->begin, time_s), std::max(range->end, time_s)}
                  : TimeRange{time_s, time_s};
    if (this->Begin_) { // a time before the first one that was set is none
      const std::optional<double> begin_s = this->Begin_();
      if (!begin_s) {
        range = TimeRange{time_s, time_s};
      } else if (*begin_s != range->begin) {
        range = TimeRange{*begin_s, *begin_s <= range->begin ? range->end : time_s};
      }
    }
  }
  if (this->NextEvents_) {
    if (const auto events = this->NextEvents_()) {
      this->Events_ = *events;
      ++this->Revision_;
    }
  }
}

void SceneTimeSource::Play(bool) {
  Refuse("playing");
}
void SceneTimeSource::Seek(double) {
  Refuse("another time");
}
void SceneTimeSource::Step(int) {
  Refuse("stepping");
}
void SceneTimeSource::SetSpeed(double) {
  Refuse("another speed");
}
void SceneTimeSource::SetLoop(const std::optional<TimeRange>&) {
  Refuse("a loop");
}
void SceneTimeSource::Follow(bool) {}

std::unique_ptr<SceneTimeSource> MakeTimeSource(vtkDspaceSession* session, const std::string& scene,
                                                bool j2000) {
  const vtkSmartPointer<vtkDspaceSession> kept = session;
  auto source = std::make_unique<SceneTimeSource>(
      [kept, scene] { return kept->GetInterpreter().FindScene(scene); }, j2000);
  source->SetBegin([kept, scene] {
    const auto& scenes = kept->GetInterpreter().GetState().scenes;
    const auto found = scenes.find(scene);
    return found == scenes.end() ? std::optional<double>() : found->second.begin_s;
  });
  source->SetEvents([kept, scene, last = std::make_shared<std::uint64_t>(0)] {
    auto& scenes = kept->GetInterpreter().GetState().scenes;
    const auto found = scenes.find(scene);
    std::unique_ptr<std::vector<TimelineEvent>> events;
    if (found != scenes.end() && found->second.messages.LastNumber() != *last) {
      *last = found->second.messages.LastNumber();
      events = std::make_unique<std::vector<TimelineEvent>>();
      for (const v1::LogEvent& event : found->second.messages.Events()) {
        events->push_back(ToTimelineEvent(event));
      }
      SortByTime(*events);
    }
    return events;
  });
  return source;
}

} // namespace dspace::widgets
