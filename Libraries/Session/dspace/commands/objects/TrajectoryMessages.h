// Trajectories, moving axes and attitudes from messages. Not installed.
#ifndef DSPACE_SESSION_TRAJECTORY_MESSAGES_H
#define DSPACE_SESSION_TRAJECTORY_MESSAGES_H

#include <string>
#include <vector>

#include <dspace/proto/trajectories.pb.h>
#include <dspace/state/TrajectoryObject.h>
#include <dspace/time/TimeScales.h>

namespace dspace::session {

// Those of the texts of files, and of labels.
const TimeScales& TrajectoryClock();

// Doubles, as many as `count` rows of `size`; count 0: as many as there are. Throws
// Error(InvalidArgument) naming `object` and `what`.
std::vector<double> DoublesOf(const std::string& bytes, std::size_t size, std::size_t count,
                              const std::string& object, const char* what);
void PutDoubles(const std::vector<double>& from, std::string* to);

// Throw Error(InvalidArgument) naming `object`, and what the readers of files throw.
TrajectorySource ToSource(v1::TrajectoryPath& path, const std::string& object);
// Null: the axes F about the centre.
MovingFramePtr ToAxes(v1::TrajectoryAxes& axes, const std::string& object);
// Null: neither a rule nor a table is given.
AttitudePtr ToAttitude(v1::SetTrajectoryFrame& command, const TrajectoryPtr& craft,
                       const std::string& object);

} // namespace dspace::session

#endif
