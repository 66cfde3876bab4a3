// Whether all of a recording is sound.
#ifndef DSPACE_SESSION_RECORDING_CHECK_H
#define DSPACE_SESSION_RECORDING_CHECK_H

#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/RecordingReader.h>

namespace dspace::session {

// Reads all of a recording: commands, snapshots, files, packed content, SQLite's own structure.
// Throws Error at the first damage, as RecordingReader. Commands that the recording itself says are
// lost are no damage.
void CheckRecording(RecordingReader& reader, const CancelCheck& checkCancel);

} // namespace dspace::session

#endif
