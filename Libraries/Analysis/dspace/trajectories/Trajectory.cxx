#include <dspace/trajectories/Trajectory.h>

#include <cmath>
#include <cstdio>

#include <dspace/Checks.h>

namespace dspace {

void RequireInSpan(const std::string& object, double time_s, const TimeSpan& span) {
  if (time_s >= span.begin && time_s <= span.end) { // false for NaN
    return;
  }
  char text[160]; // to a millisecond, for centuries
  std::snprintf(text, sizeof(text), "the time is %.3f s; accepted: %.3f to %.3f s past J2000",
                time_s, span.begin, span.end);
  Reject(object, text);
}

} // namespace dspace
