// The files that commands need: those that they name, and those that these name in turn.
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

// Replaces each text in such a field that is not empty, absolute or not, by what `map` returns for
// it.
void MapPaths(v1::Command& command, const std::function<std::string(const std::string&)>& map);

// What was read when each path was last named: filled by the interpreter, asked by recordings.
// Files are remembered by the path of the command that led to them, as long as the interpreter
// lives.
class CommandFiles {
public:
  void Note(const v1::Command& accepted, const FilesRead& files);
  // All that carrying it out read, and the paths that it names itself.
  FilesRead Of(const v1::Command& command) const;

private:
  std::map<std::string, FilesRead> ByPath_;
};

} // namespace dspace::session

#endif
