// Wheel tracks as a terrain keeps them, in messages.
#ifndef DSPACE_SESSION_TRACK_MESSAGES_H
#define DSPACE_SESSION_TRACK_MESSAGES_H

#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>
#include <dspace/tracks/WheelTracks.h>

namespace dspace::session {

// To the bit. Throws Error(InvalidArgument) where the lists of a stroke differ in length.
std::vector<TrackStroke> ToStrokes(const v1::RestoreTracks& message);
void Put(const std::vector<TrackStroke>& strokes, v1::RestoreTracks* message);

// Restores the tracks on a terrain that has none, in commands of at most a megabyte.
void PutTracks(const WheelTracks& tracks, const std::string& scene, const std::string& terrain,
               std::vector<v1::Command>& out);

} // namespace dspace::session

#endif
