// Rows of a damaged recording, found in its raw pages. Not a public header.
#ifndef DSPACE_SESSION_RECORDING_PAGES_H
#define DSPACE_SESSION_RECORDING_PAGES_H

#include <functional>
#include <string>
#include <variant>

#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/RecordingFile.h>

namespace dspace::session {

using FoundRow = std::variant<RecordingRow, RecordingAsset, RecordingContent>;

// Hands over every row in the pages of a recording, and in those of the log beside it, whose own
// checksum holds. A row that is there several times may come as often. Throws Error(Io) where the
// file cannot be read.
void FindRows(const std::string& path, const std::function<void(FoundRow&&)>& take,
              const CancelCheck& checkCancel);

} // namespace dspace::session

#endif
