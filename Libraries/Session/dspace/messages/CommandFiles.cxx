#include <dspace/messages/CommandFiles.h>

#include <dspace/messages/CommandTexts.h>
#include <dspace/messages/CommandTraits.h>

namespace dspace::session {
namespace {

bool ReadsFiles(const v1::Command& command) {
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  return traits && traits->ReadsFiles();
}

} // namespace

std::set<std::string> PathsIn(const v1::Command& command) {
  std::set<std::string> paths;
  // A command that holds what was in its file needs the file no more.
  if (ReadsFiles(command) && !command.load_tracks().has_read()) {
    ForEachText(command, [&paths](const std::string& text, const google::protobuf::FieldDescriptor&,
                                  TextKind kind) {
      if (kind == TextKind::ReadFile && text.size() > 1 && text[0] == '/') {
        paths.insert(text);
      }
    });
  }
  return paths;
}

void MapPaths(v1::Command& command, const std::function<std::string(const std::string&)>& map) {
  if (ReadsFiles(command)) {
    ChangeTexts(command, [&map](const std::string& text, const google::protobuf::FieldDescriptor&,
                                TextKind kind) {
      return kind == TextKind::ReadFile && !text.empty() ? map(text) : text;
    });
  }
}

void CommandFiles::Note(const v1::Command& accepted, const FilesRead& files) {
  if (files.empty()) {
    return;
  }
  for (const std::string& path : PathsIn(accepted)) {
    FilesRead& known = this->ByPath_[path];
    for (const auto& [file, stamp] : files) {
      known[file] = stamp;
    }
  }
}

FilesRead CommandFiles::Of(const v1::Command& command) const {
  FilesRead files;
  for (const std::string& path : PathsIn(command)) {
    const auto found = this->ByPath_.find(path);
    if (found != this->ByPath_.end()) {
      files.insert(found->second.begin(), found->second.end());
    } else {
      files.emplace(path, FileStamp::Of(path));
    }
  }
  return files;
}

} // namespace dspace::session
