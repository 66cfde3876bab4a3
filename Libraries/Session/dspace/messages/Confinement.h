// Which files commands that come from elsewhere may name. The option `(holds)` of a text field
// (options.proto) says whether it names a file to be read or written, or states a coordinate
// system, for which libraries take names of files and URLs as well. No command is carried out while
// any text field lacks the option.
#ifndef DSPACE_SESSION_CONFINEMENT_H
#define DSPACE_SESSION_CONFINEMENT_H

#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Paths that are relative become those of this process's working folder. What is no path of a file
// that there is ("/vsicurl/...", a GDAL connection) stays as it is where a field may hold such a
// thing.
void MakePathsAbsolute(v1::Command& command);

// Folders that files must lie in.
class Confinement {
public:
  // Each root is a folder that there is; with links resolved. Throws Error(NotFound). Without roots
  // no path is accepted. `who` allows them, for messages.
  explicit Confinement(const std::vector<std::string>& roots, std::string who = "the server");

  // Makes every path of the command absolute, and throws Error(InvalidArgument) for one that leads
  // out of the roots: by "..", by a link, or because it is no plain path (URLs, GDAL's "/vsi...", a
  // document in the place of a name); for one to be read that is neither a file nor a folder; and
  // for a coordinate system that is or names a file or a URL (grids of shifts, parameter files).
  // Throws Error(NotFound) for one to be read that is not there. An empty path is left to the
  // command. A link that is changed meanwhile by somebody who may write into a root is not guarded
  // against.
  void Apply(v1::Command& command) const;

  // Throws Error(InvalidArgument) for a file that a command's files lead to (FilesGuard), and that
  // lies outside of the roots.
  void RequireWithin(const std::string& path) const;

  const std::vector<std::string>& Roots() const { return this->Roots_; }

private:
  std::string Check(const std::string& path, const std::string& field, bool isRead) const;
  void RequireThere(const std::string& real, const std::string& text,
                    const std::string& field) const;
  const std::string Who_;
  std::vector<std::string> Roots_;
};

} // namespace dspace::session

#endif
