#include <dspace/messages/Confinement.h>

#include <algorithm>
#include <filesystem>

#include <google/protobuf/descriptor.h>

#include <dspace/Error.h>
#include <dspace/crs/CrsFiles.h>
#include <dspace/messages/CommandTexts.h>
#include <dspace/messages/CommandTraits.h>

namespace dspace::session {
namespace {

namespace fs = std::filesystem;
using google::protobuf::FieldDescriptor;

bool IsPath(TextKind kind) {
  return kind == TextKind::ReadFile || kind == TextKind::NewFile;
}

bool Within(const fs::path& path, const fs::path& root) {
  const auto [end, at] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return end == root.end();
}

[[noreturn]] void RejectPath(const std::string& value, const std::string& field,
                             const std::string& why) {
  throw Error(Error::Kind::InvalidArgument, "file '" + value.substr(0, 1000) + "'",
              field + " " + why);
}

} // namespace

void MakePathsAbsolute(v1::Command& command) {
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  if (!traits || !traits->NamesFiles()) {
    return;
  }
  ChangeTexts(command, [](const std::string& text, const FieldDescriptor&, TextKind kind) {
    std::error_code error;
    return IsPath(kind) && !text.empty() &&
                   (text.find(':') == std::string::npos || fs::exists(text, error))
               ? fs::absolute(text).lexically_normal().string()
               : text;
  });
}

Confinement::Confinement(const std::vector<std::string>& roots, std::string who)
    : Who_(std::move(who)) {
  for (const std::string& root : roots) {
    std::error_code error;
    const fs::path path = fs::canonical(root, error);
    if (error || !fs::is_directory(path)) {
      throw Error(Error::Kind::NotFound, "folder '" + root + "'",
                  "there is no such folder; accepted: existing folders as roots");
    }
    this->Roots_.push_back(path);
  }
}

void Confinement::Apply(v1::Command& command) const {
  ChangeTexts(
      command,
      [this](const std::string& text, const FieldDescriptor& field, TextKind kind) -> std::string {
        if (text.empty() || kind == TextKind::Plain) {
          return text;
        }
        if (IsPath(kind)) {
          return this->Check(text, field.full_name(), kind == TextKind::ReadFile);
        }
        if (CrsNamesFile(text)) {
          RejectPath(
              text, field.full_name(),
              "names a file; accepted: AUTHORITY:CODE, WKT and PROJ without grids, parameter "
              "files, EXTENSION and init=");
        }
        return text;
      });
}

void Confinement::RequireWithin(const std::string& path) const {
  std::error_code error;
  const bool plain = path.rfind("/vsi", 0) != 0 && path.find("://") == std::string::npos;
  const fs::path real = fs::weakly_canonical(fs::absolute(path, error), error);
  for (const std::string& root : this->Roots_) {
    if (!error && plain && Within(real, root)) {
      return;
    }
  }
  throw Error(Error::Kind::InvalidArgument, "file '" + path.substr(0, 1000) + "'",
              "a file of the command refers to it, and it is outside of the folders that " +
                  this->Who_ + " allows");
}

// A library may interpret the name of a missing file in another way, and reading a special file may
// never end.
void Confinement::RequireThere(const std::string& real, const std::string& text,
                               const std::string& field) const {
  std::error_code error;
  const fs::file_status status = fs::status(real, error);
  if (!fs::exists(status)) {
    throw Error(Error::Kind::NotFound, "file '" + text.substr(0, 1000) + "'",
                field + " names no existing file; accepted: an existing file");
  }
  if (!fs::is_regular_file(status) && !fs::is_directory(status)) {
    RejectPath(text, field, "is neither a file nor a folder");
  }
}

std::string Confinement::Check(const std::string& text, const std::string& field,
                               bool isRead) const {
  if (text.find('\0') != std::string::npos) {
    RejectPath(text, field, "contains a zero byte");
  }
  // GDAL interprets a name that contains "<VRTDataset" as the document itself.
  if (text.find_first_of("<>") != std::string::npos) {
    RejectPath(text, field, "contains '<' or '>'; accepted: names without them");
  }
  // The opened path is the checked one: the same absolute path.
  const fs::path path = fs::absolute(text).lexically_normal();
  std::error_code error;
  const fs::path real = fs::weakly_canonical(path, error);
  const bool plain = path.string().rfind("/vsi", 0) != 0;
  for (const std::string& root : this->Roots_) {
    if (!error && plain && Within(real, root)) {
      if (isRead) {
        this->RequireThere(real, text, field);
      }
      return path;
    }
  }
  std::string accepted;
  for (const std::string& root : this->Roots_) {
    accepted += (accepted.empty() ? "" : ", ") + root;
  }
  RejectPath(text, field,
             "is outside of the folders that " + this->Who_ + " allows; accepted: files in " +
                 (accepted.empty() ? "no folder" : accepted));
}

} // namespace dspace::session
