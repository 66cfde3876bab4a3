// Cuts a part of a recording into a new recording.
#ifndef DSPACE_SESSION_RECORDING_CUT_H
#define DSPACE_SESSION_RECORDING_CUT_H

#include <cstdint>
#include <string>

#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/RecordingReader.h>

namespace dspace::session {

// Copies the commands first..last, those since the last snapshot before them, and all files into a
// new recording. Returns the number of that snapshot, after which the new recording starts. Throws
// Error and leaves no new file: those of RecordingReader; AlreadyExists, NotFound and Io for the
// new file.
std::uint64_t CutRecording(RecordingReader& reader, const std::string& out, std::uint64_t first,
                           std::uint64_t last, const CancelCheck& checkCancel);

} // namespace dspace::session

#endif
