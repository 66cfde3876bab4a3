// A folder for the temporary files of this process.
#ifndef DSPACE_CONFINE_TEMPORARYFOLDER_H
#define DSPACE_CONFINE_TEMPORARYFOLDER_H

#include <string>

namespace dspace::confine {

// Makes a folder below `above` that only this user can read, and returns its path. A process of its
// own, which waits for nothing else, removes the folder with its content when this process has
// ended in any way, also as another program. Throws std::system_error, which names `above`.
std::string MakeTemporaryFolder(const std::string& above);

} // namespace dspace::confine

#endif
