// Checks the integrity of a recording.
#ifndef DSPACE_SESSION_RECORDING_CHECK_H
#define DSPACE_SESSION_RECORDING_CHECK_H

#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/RecordingReader.h>

namespace dspace::session {

// Reads a whole recording: commands, snapshots, files, packed content, and SQLite's own structure.
// Throws Error at the first damage, as RecordingReader does. Commands that the recording reports as
// lost are not damage, nor are texts that are not UTF-8: it returns the rows that hold some.
ForeignRows CheckRecording(RecordingReader& reader, const CancelCheck& checkCancel);

} // namespace dspace::session

#endif
