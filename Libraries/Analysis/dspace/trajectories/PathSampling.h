// The times at which a line follows a trajectory.
#ifndef DSPACE_TRAJECTORIES_PATH_SAMPLING_H
#define DSPACE_TRAJECTORIES_PATH_SAMPLING_H

#include <cstddef>
#include <string>
#include <vector>

#include <dspace/trajectories/Trajectory.h>

namespace dspace {

struct PathSampling {
  // The largest distance of the path from a chord, as a share of the chord's length: 1/256 takes
  // about 200 chords a turn.
  double flatness = 1.0 / 256.0;
  std::size_t most =
      20000; // points, 3 and more: where more were needed the worst chords come first
};

// Ascending times within `span`, its ends among them. The path is compared with each chord in its
// middle and in its first quarter. Throws Error(InvalidArgument) naming `object`: a span that is
// empty, infinite or beyond that of the trajectory; values of `by` out of range.
std::vector<double> SampleTimes(const Trajectory& trajectory, const TimeSpan& span,
                                const PathSampling& by, const std::string& object);

} // namespace dspace

#endif
