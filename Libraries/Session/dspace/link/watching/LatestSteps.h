// Finds the steps that a viewer may skip when it is behind. Not a public header.
#ifndef DSPACE_SESSION_LATESTSTEPS_H
#define DSPACE_SESSION_LATESTSTEPS_H

#include <cstddef>
#include <vector>

#include <dspace/proto/service.pb.h>

namespace dspace::session {

struct State;

// Whether the message is a SetTime (without lags) or a SetPoses, which a later one may supersede.
bool IsStep(const v1::WatchReply& message);

// For the run of accepted steps that starts at `first`: one entry per message, true if a later
// message of the run sets the time of the same scene, or the poses of the same frames in the same
// order. Skipping these gives the same state to the bit, unless a camera lags.
std::vector<bool> SupersededSteps(const std::vector<v1::WatchReply>& messages, std::size_t first);

// Whether the pose of any camera depends on intermediate steps.
bool HasLaggingCamera(const State& state);

} // namespace dspace::session

#endif
