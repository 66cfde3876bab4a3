// Packs the files that a recording needs into it.
#ifndef DSPACE_SESSION_RECORDING_PACK_H
#define DSPACE_SESSION_RECORDING_PACK_H

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <dspace/recording/CancelCheck.h>

namespace dspace::session {

struct PackReport {
  std::uint64_t files = 0;          // number of packed files
  std::uint64_t bytes = 0;          // of these files
  std::vector<std::string> missing; // paths of files that could not be read when they were recorded
};

// Packs the files of a recording into it, or into a copy if `out` names one. Throws Error: those of
// RecordingReader; NotFound, naming it, for a missing file; Corrupt for a changed file; Io if a
// process has the recording open. There is no copy then. In the recording itself, files before the
// changed one stay packed.
PackReport PackRecording(const std::string& path, const std::optional<std::string>& out,
                         const CancelCheck& checkCancel);

} // namespace dspace::session

#endif
