// Restricts the files that commands of other processes may name. The option `(holds)` of a text
// field (options.proto) states whether it contains a file to read or write, or a coordinate system,
// which a library may interpret as a file name or URL. No command is executed if any text field
// lacks the option.
#ifndef DSPACE_SESSION_CONFINEMENT_H
#define DSPACE_SESSION_CONFINEMENT_H

#include <string>
#include <vector>

#include <dspace/proto/commands.pb.h>

namespace dspace::session {

// Makes relative paths absolute, relative to this process's working folder. Text that is not the
// path of an existing file ("/vsicurl/...", a GDAL connection) is unchanged in fields that accept
// it.
void MakePathsAbsolute(v1::Command& command);

// The folders that may contain the files.
class Confinement {
public:
  // Each root is an existing folder; links are resolved. Throws Error(NotFound). Without roots no
  // path is accepted. `who` names the owner of the roots in messages.
  explicit Confinement(const std::vector<std::string>& roots, std::string who = "the server");

  // Makes every path of the command absolute. Throws Error(InvalidArgument) for a path outside the
  // roots (by "..", by a link, or as a URL, GDAL's "/vsi..." or a document instead of a name), for
  // input that is neither a file nor a folder, and for a coordinate system that is or names a file
  // or a URL (shift grids, parameter files). Throws Error(NotFound) for missing input. Empty paths
  // are left to the command. It does not protect against a user with write access to a root who
  // changes a link during the check.
  void Apply(v1::Command& command) const;

  // Throws Error(InvalidArgument) for a file outside the roots that a command's files refer to
  // (FilesGuard).
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
