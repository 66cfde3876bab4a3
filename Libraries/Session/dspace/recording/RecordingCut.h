// A part of a recording as a recording of its own.
#ifndef DSPACE_SESSION_RECORDING_CUT_H
#define DSPACE_SESSION_RECORDING_CUT_H

#include <cstdint>
#include <string>

#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/RecordingReader.h>

namespace dspace::session {

// Copies the commands first..last, with those from the last snapshot before them on and with all
// files, into a new recording; returns the number of that snapshot, after which the part begins.
// Throws Error, and leaves no new file: those of RecordingReader; AlreadyExists, NotFound and Io
// for the new file.
std::uint64_t CutRecording(RecordingReader& reader, const std::string& out, std::uint64_t first,
                           std::uint64_t last, const CancelCheck& checkCancel);

} // namespace dspace::session

#endif
