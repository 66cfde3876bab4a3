// The end of a wheel's stroke while contacts are added to it.
#ifndef DSPACE_TERRAIN_TRACKDRAFT_H
#define DSPACE_TERRAIN_TRACKDRAFT_H

#include <cstddef>
#include <string>
#include <vector>

#include <dspace/tracks/TrackSegment.h>

namespace dspace {

// A stored contact, half the size of TrackContact.
struct KeptContact {
  double x;
  double y;
  double rolled;
  float heading;
  float sinkage;
};

struct TrackDraft {
  static constexpr std::size_t MaximumSkipped = 64;

  std::string name;
  TrackProfile profile;
  std::size_t stroke = 0; // to go on with; one more than there are: new
  std::size_t kept = 0;   // contacts of it that stay
  std::vector<KeptContact> contacts;
  std::vector<KeptContact> skipped; // on the last line, which were left out

  // Leaves out contacts that lie on the line between others to `tolerance` (WheelTracksOptions),
  // unless all are kept (`exact`). `scale`: metres of the tracks' plane per metre.
  void Append(const TrackContact& given, bool exact, double tolerance, double scale = 1.0);
};

} // namespace dspace

#endif
