// Files of libraries' own that what is shown depends on.
#ifndef DSPACE_SYSTEM_FILES_H
#define DSPACE_SYSTEM_FILES_H

#include <string>

namespace dspace {

// As NoteFileRead, for a file that no command can choose (a library's, of this machine): recordings
// note it, and no FilesGuard looks at it. One that is not there is noted as absent.
void NoteSystemFile(const std::string& path);

} // namespace dspace

#endif
