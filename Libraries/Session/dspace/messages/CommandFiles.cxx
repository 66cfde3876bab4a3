#include <dspace/messages/CommandFiles.h>

#include <vector>

namespace dspace::session {
namespace {

bool IsPath(const google::protobuf::FieldDescriptor& field) {
  return !field.is_repeated() &&
         field.cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_STRING &&
         (field.name() == "path" || field.name() == "texture");
}

void Gather(const google::protobuf::Message& message, std::set<std::string>& paths) {
  const google::protobuf::Reflection* reflection = message.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection->ListFields(message, &fields);
  for (const google::protobuf::FieldDescriptor* field : fields) {
    if (field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE) {
      const int n = field->is_repeated() ? reflection->FieldSize(message, field) : 1;
      for (int i = 0; i < n; ++i) {
        Gather(field->is_repeated() ? reflection->GetRepeatedMessage(message, field, i)
                                    : reflection->GetMessage(message, field),
               paths);
      }
    } else if (IsPath(*field)) {
      const std::string path = reflection->GetString(message, field);
      if (path.size() > 1 && path[0] == '/') {
        paths.insert(path);
      }
    }
  }
}

void MapBelow(google::protobuf::Message& message,
              const std::function<std::string(const std::string&)>& map) {
  const google::protobuf::Reflection* reflection = message.GetReflection();
  std::vector<const google::protobuf::FieldDescriptor*> fields;
  reflection->ListFields(message, &fields);
  for (const google::protobuf::FieldDescriptor* field : fields) {
    if (field->cpp_type() == google::protobuf::FieldDescriptor::CPPTYPE_MESSAGE) {
      const int n = field->is_repeated() ? reflection->FieldSize(message, field) : 1;
      for (int i = 0; i < n; ++i) {
        MapBelow(field->is_repeated() ? *reflection->MutableRepeatedMessage(&message, field, i)
                                      : *reflection->MutableMessage(&message, field),
                 map);
      }
    } else if (IsPath(*field)) {
      const std::string path = reflection->GetString(message, field);
      if (!path.empty()) {
        reflection->SetString(&message, field, map(path));
      }
    }
  }
}

} // namespace

std::set<std::string> PathsIn(const v1::Command& command) {
  std::set<std::string> paths;
  // One names no file and is most of all; the other says what was in it.
  if (!command.has_set_poses() && !command.load_tracks().has_read()) {
    Gather(command, paths);
  }
  return paths;
}

void MapPaths(v1::Command& command, const std::function<std::string(const std::string&)>& map) {
  MapBelow(command, map);
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
