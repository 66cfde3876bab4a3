// Events that a simulation logged, as a timeline shows them.
#ifndef DSPACE_WIDGETS_LOGGED_EVENTS_H
#define DSPACE_WIDGETS_LOGGED_EVENTS_H

#include <algorithm>
#include <vector>

#include <dspace/proto/messages.pb.h>
#include <dspace/widgets/timeline/TimeSource.h>

namespace dspace::widgets {

inline TimelineEvent ToTimelineEvent(const v1::LogEvent& event) {
  const int severity = std::clamp(int(event.severity()), 0, 3);
  return {event.time_s(), TimelineEvent::Severity(severity), event.kind(), event.text()};
}

inline void SortByTime(std::vector<TimelineEvent>& events) {
  std::stable_sort(
      events.begin(), events.end(),
      [](const TimelineEvent& a, const TimelineEvent& b) { return a.time_s < b.time_s; });
}

} // namespace dspace::widgets

#endif
