// Converts wheel tracks of a terrain to messages and back.
#ifndef DSPACE_SESSION_TRACK_MESSAGES_H
#define DSPACE_SESSION_TRACK_MESSAGES_H

#include <optional>
#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>
#include <dspace/tracks/TrackedGround.h>

namespace dspace::session {

// Exact to the bit. Throws Error(InvalidArgument) if the lists of a stroke differ in length.
std::vector<TrackStroke> ToStrokes(const v1::RestoreTracks& message);
// `anchor`: TrackedGround::TracksAnchor().
void Put(const std::vector<TrackStroke>& strokes, const std::optional<Eigen::Vector3d>& anchor,
         v1::RestoreTracks* message);

// Appends commands that restore the tracks on a terrain without tracks, of at most 1 MB each.
void PutTracks(const TrackedGround& ground, const std::string& scene, const std::string& terrain,
               std::vector<v1::Command>& out);

} // namespace dspace::session

#endif
