// What survives of a damaged recording.
#ifndef DSPACE_SESSION_RECORDING_SALVAGE_H
#define DSPACE_SESSION_RECORDING_SALVAGE_H

#include <cstdint>
#include <string>
#include <utility>
#include <vector>

#include <dspace/recording/CancelCheck.h>

namespace dspace::session {

// What came after the last command and the last file nobody can know.
struct SalvageReport {
  std::uint64_t commands = 0;
  std::uint64_t snapshots = 0;
  std::uint64_t assets = 0;
  std::uint64_t lastCommand = 0; // its number; 0 without any
  std::uint64_t lastAsset = 0;
  std::uint64_t begin = 0; // the snapshot that the recording begins with: 0, unless it was cut
  bool beginLost = false;  // that snapshot is lost
  std::vector<std::pair<std::uint64_t, std::uint64_t>> lost; // ranges of commands
  std::vector<std::string> broken; // paths of packed files whose content is not whole: they are no
                                   // longer packed
  std::uint64_t unknownAssets = 0; // files of which nothing is known, by the gaps in their numbers

  bool IsWhole() const;
};

// Puts every command, snapshot and file of a damaged recording, and of the log beside it, whose own
// checksum holds into a new recording. Throws Error: NotFound (no such file), Unsupported (a newer
// Dspace wrote it), Corrupt (nothing in it survives), AlreadyExists and NotFound for the new file,
// Io. Then there is no new file.
SalvageReport SalvageRecording(const std::string& path, const std::string& out,
                               const CancelCheck& checkCancel);

} // namespace dspace::session

#endif
