// The files that commands need: those that they name, and those that these files refer to.
#ifndef DSPACE_SESSION_COMMAND_FILES_H
#define DSPACE_SESSION_COMMAND_FILES_H

#include <functional>
#include <map>
#include <set>
#include <string>

#include <dspace/FilesRead.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Absolute paths of files that a command reads, at any depth of its fields (READ_FILE in
// options.proto).
std::set<std::string> PathsIn(const v1::Command& command);

// Replaces each non-empty path, absolute or relative, by the result of `map`.
void MapPaths(v1::Command& command, const std::function<std::string(const std::string&)>& map);

// The files that were read when each path was last used. The interpreter fills it and recordings
// query it. Files are stored by the path in the command, for the lifetime of the interpreter.
class CommandFiles {
public:
  void Note(const v1::Command& accepted, const FilesRead& files);
  // All files that the command read, and the paths that it names.
  FilesRead Of(const v1::Command& command) const;

private:
  std::map<std::string, FilesRead> ByPath_;
};

} // namespace dspace::session

#endif
