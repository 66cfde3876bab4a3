// Which files commands that come from elsewhere may name.
#ifndef DSPACE_SESSION_CONFINEMENT_H
#define DSPACE_SESSION_CONFINEMENT_H

#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Every text field that a command can hold is of one of three kinds, so that none is taken for
// harmless because nobody thought of it: a command with a text of no known kind is refused by
// Confinement. Path fields, by full name ("dspace.v1.SaveImage.path"), name a file or a folder. CRS
// fields, by their own name, state a coordinate system or a datum, for which libraries take names
// of files and URLs as well. Plain fields, by their own name, name none; a path field's name is
// never among them.
const std::vector<std::string>& PathFields();
const std::vector<std::string>& CrsFields();
const std::vector<std::string>& PlainFields();
// Full names of those that a command can hold and that are of no known kind: to be listed.
std::vector<std::string> UnlistedFields();

// Paths that are relative become those of this process's working folder. What is no path of a file
// that there is ("/vsicurl/...", a GDAL connection) stays as it is where a field may hold such a
// thing.
void MakePathsAbsolute(v1::Command& command);

// Folders that files must lie in.
class Confinement {
public:
  // Each root is a folder that there is; with links resolved. Throws Error(NotFound). Without roots
  // no path is accepted.
  explicit Confinement(const std::vector<std::string>& roots);

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
  std::string Check(const std::string& path, const std::string& field) const;
  void RequireThere(const std::string& real, const std::string& text,
                    const std::string& field) const;
  std::vector<std::string> Roots_;
};

} // namespace dspace::session

#endif
