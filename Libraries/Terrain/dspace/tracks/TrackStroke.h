// The path of one wheel over the ground.
#ifndef DSPACE_TERRAIN_TRACKSTROKE_H
#define DSPACE_TERRAIN_TRACKSTROKE_H

#include <string>
#include <vector>

#include <dspace/tracks/TrackSegment.h>

namespace dspace {

// Without a gap.
struct TrackStroke {
  std::string name; // the wheel's
  TrackProfile profile;
  std::vector<TrackContact> contacts;
  // Of a stroke that is kept: contacts on its last line that were left out. As long as they lie on
  // it, it may grow.
  std::vector<TrackContact> skipped;
};

// Throws Error(InvalidArgument) for a profile or a contact out of range. `on` names the terrain.
void CheckStroke(const TrackStroke& stroke, const std::string& on);

} // namespace dspace

#endif
