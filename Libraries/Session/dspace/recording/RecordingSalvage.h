// Recovers the intact rows of a damaged recording.
#ifndef DSPACE_SESSION_RECORDING_SALVAGE_H
#define DSPACE_SESSION_RECORDING_SALVAGE_H

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/RecordingReader.h>

namespace dspace::session {

// The result of a salvage. Rows after the last command and the last file cannot be detected.
struct SalvageReport {
  std::uint64_t commands = 0;
  std::uint64_t snapshots = 0;
  std::uint64_t assets = 0;
  std::uint64_t lastCommand = 0; // its number; 0: none
  std::uint64_t lastAsset = 0;
  std::uint64_t begin = 0; // the first snapshot: 0, unless the recording was cut
  bool beginLost = false;  // that snapshot is lost
  std::vector<std::pair<std::uint64_t, std::uint64_t>> lost; // ranges of commands
  std::vector<std::string> broken; // paths of packed files whose content is not whole: they are no
                                   // longer packed
  std::uint64_t unknownAssets = 0; // files of which nothing is known, by the gaps in their numbers
  ForeignRows foreign;             // rows whose text is not UTF-8; they are kept as they are

  bool IsComplete() const;
};

// Copies every command, snapshot and file with a valid checksum from a damaged recording and its
// log into a new recording. Throws Error: NotFound (no such file), Unsupported (a newer Dspace
// wrote it), Corrupt (nothing can be recovered), AlreadyExists and NotFound for the new file, Io.
// There is no new file then. unpackLimit: RecordingReader::SetUnpackLimit.
SalvageReport SalvageRecording(const std::string& path, const std::string& out,
                               const CancelCheck& checkCancel, std::uint64_t unpackLimit = 0);

} // namespace dspace::session

#endif
