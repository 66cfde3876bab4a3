// Which steps of a simulation a viewer that is behind need not apply. Not a public header.
#ifndef DSPACE_SESSION_LATESTSTEPS_H
#define DSPACE_SESSION_LATESTSTEPS_H

#include <cstddef>
#include <vector>

#include <dspace/proto/service.pb.h>

namespace dspace::session {

struct State;

// Whether a SetTime (without lags) or a SetPoses, which a later one may make needless.
bool IsStep(const v1::WatchReply& message);

// Of the run of steps that begins at `first` (an accepted step each): an entry a message, true
// where a later one of the run sets the time of the same scene, or the poses of the same frames in
// the same order. Without these the state after the run is the same, to the bit, unless a camera
// lags.
std::vector<bool> SupersededSteps(const std::vector<v1::WatchReply>& messages, std::size_t first);

// Whether a camera's place depends on the steps that led to it.
bool HasLaggingCamera(const State& state);

} // namespace dspace::session

#endif
