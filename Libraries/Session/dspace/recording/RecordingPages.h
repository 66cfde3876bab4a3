// Finds rows of a damaged recording in its raw pages. Not a public header.
#ifndef DSPACE_SESSION_RECORDING_PAGES_H
#define DSPACE_SESSION_RECORDING_PAGES_H

#include <functional>
#include <string>
#include <variant>

#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/RecordingFile.h>

namespace dspace::session {

using FoundRow = std::variant<RecordingRow, RecordingAsset, RecordingContent>;

// Calls `take` for every row with a valid checksum in the pages of a recording and of its log. A
// row that occurs more than once may be passed more than once. Throws Error(Io) if the file cannot
// be read.
void FindRows(const std::string& path, const std::function<void(FoundRow&&)>& take,
              const CancelCheck& checkCancel);

} // namespace dspace::session

#endif
