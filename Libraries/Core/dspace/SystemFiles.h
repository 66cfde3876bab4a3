// System files of libraries that affect results.
#ifndef DSPACE_SYSTEM_FILES_H
#define DSPACE_SYSTEM_FILES_H

#include <string>

namespace dspace {

// Like NoteFileRead, for a file of a library on this machine that no command can name. Recordings
// note it; FilesGuard does not check it. A missing file is noted as absent.
void NoteSystemFile(const std::string& path);

} // namespace dspace

#endif
