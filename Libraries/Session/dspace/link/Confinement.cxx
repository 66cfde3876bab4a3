#include <dspace/link/Confinement.h>

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <functional>
#include <map>
#include <set>

#include <google/protobuf/descriptor.h>

#include <dspace/Error.h>

namespace dspace::session {
namespace {

namespace fs = std::filesystem;
using google::protobuf::Descriptor;
using google::protobuf::FieldDescriptor;
using google::protobuf::Message;

// Plain for all that their message's own name says: paths of frames, not of files.
const std::set<std::string> FramePaths = {"dspace.v1.FindFrame.path"};

enum class FieldKind { Path, Crs, Plain, Unknown };

bool Has(const std::vector<std::string>& list, const std::string& name) {
  return std::find(list.begin(), list.end(), name) != list.end();
}

FieldKind KindOf(const FieldDescriptor& field) {
  if (Has(PathFields(), field.full_name())) {
    return FieldKind::Path;
  }
  if (Has(CrsFields(), field.name())) {
    return FieldKind::Crs;
  }
  const bool plain = Has(PlainFields(), field.name()) || FramePaths.count(field.full_name()) > 0;
  return plain ? FieldKind::Plain : FieldKind::Unknown;
}

bool IsText(const FieldDescriptor& field) {
  return field.type() == FieldDescriptor::TYPE_STRING ||
         field.type() == FieldDescriptor::TYPE_BYTES;
}

// What may hold texts, for each kind of message that a command can hold: others need no look.
class TextTree {
public:
  static const TextTree& Get() {
    static const TextTree tree;
    return tree;
  }
  const std::vector<const FieldDescriptor*>& FieldsOf(const Descriptor* message) const {
    static const std::vector<const FieldDescriptor*> none;
    const auto found = this->Fields_.find(message);
    return found == this->Fields_.end() ? none : found->second;
  }
  FieldKind Kind(const FieldDescriptor* field) const { return this->Kinds_.at(field); }
  const std::map<const FieldDescriptor*, FieldKind>& Texts() const { return this->Kinds_; }

private:
  TextTree() {
    std::set<const Descriptor*> open;
    this->Visit(v1::Command::descriptor(), open);
  }
  bool Visit(const Descriptor* message, std::set<const Descriptor*>& seen) {
    if (!seen.insert(message).second) {
      return !this->FieldsOf(message).empty();
    }
    std::vector<const FieldDescriptor*> fields;
    for (int i = 0; i < message->field_count(); ++i) {
      const FieldDescriptor* field = message->field(i);
      if (IsText(*field)) {
        this->Kinds_[field] = KindOf(*field);
        fields.push_back(field);
      } else if (field->message_type() && this->Visit(field->message_type(), seen)) {
        fields.push_back(field);
      }
    }
    const bool any = !fields.empty();
    this->Fields_[message] = std::move(fields);
    return any;
  }
  std::map<const Descriptor*, std::vector<const FieldDescriptor*>> Fields_;
  std::map<const FieldDescriptor*, FieldKind> Kinds_;
};

using Change = std::function<std::string(const std::string&, const FieldDescriptor&, FieldKind)>;

void ForEachText(Message& message, const Change& change) {
  const auto* reflection = message.GetReflection();
  std::string scratch;
  for (const FieldDescriptor* field : TextTree::Get().FieldsOf(message.GetDescriptor())) {
    const int n = field->is_repeated() ? reflection->FieldSize(message, field) : 0;
    if (!IsText(*field)) {
      if (field->is_repeated()) {
        for (int i = 0; i < n; ++i) {
          ForEachText(*reflection->MutableRepeatedMessage(&message, field, i), change);
        }
      } else if (reflection->HasField(message, field)) {
        ForEachText(*reflection->MutableMessage(&message, field), change);
      }
      continue;
    }
    const FieldKind kind = TextTree::Get().Kind(field);
    if (field->is_repeated()) {
      for (int i = 0; i < n; ++i) {
        const std::string before =
            reflection->GetRepeatedStringReference(message, field, i, &scratch);
        reflection->SetRepeatedString(&message, field, i, change(before, *field, kind));
      }
    } else if (reflection->HasField(message, field)) {
      const std::string before = reflection->GetStringReference(message, field, &scratch);
      const std::string after = change(before, *field, kind);
      if (after != before) {
        reflection->SetString(&message, field, after);
      }
    }
  }
}

bool Within(const fs::path& path, const fs::path& root) {
  const auto [end, at] = std::mismatch(root.begin(), root.end(), path.begin(), path.end());
  return end == root.end();
}

// Texts that say where a file is to be written, or a folder that need not be there: all others are
// of what is there to be read.
const std::set<std::string> NewPaths = {"dspace.v1.BuildTerrainCache.folder",
                                        "dspace.v1.ClearTerrainCache.folder",
                                        "dspace.v1.HorizonMap.path",
                                        "dspace.v1.IlluminationMap.path",
                                        "dspace.v1.ListTerrainCache.folder",
                                        "dspace.v1.OpenTerrain.overview_cache",
                                        "dspace.v1.SaveImage.path",
                                        "dspace.v1.SaveTracks.path",
                                        "dspace.v1.SimulateImage.path",
                                        "dspace.v1.VerifyTerrainCache.folder",
                                        "dspace.v1.Viewshed.path"};

// Whether a coordinate system names a file, which PROJ would open: by itself, as a grid of shifts
// or a file of parameters in WKT or PROJ, as PROJ within WKT 1, or as a definition in a file.
bool NamesFile(const std::string& crs) {
  std::string text;
  for (const char c : crs) {
    if (!std::isspace(static_cast<unsigned char>(c)) && c != '"' && c != '\'') {
      text += char(std::tolower(static_cast<unsigned char>(c)));
    }
  }
  for (const char* word : {"grids=", "file=", "model=", "init=", "parameterfile", "extension[",
                           "extension(", "dict:", "/vsi", "://"}) {
    if (text.find(word) != std::string::npos) {
      return true;
    }
  }
  const bool proj = text.find("+") == 0 || text.find("proj=") != std::string::npos;
  std::error_code error;
  return text.empty() || std::string("/.@~\\").find(text[0]) != std::string::npos ||
         (proj && text.find('/') != std::string::npos) || fs::exists(crs, error);
}

[[noreturn]] void RefusePath(const std::string& value, const std::string& field,
                             const std::string& why) {
  throw Error(Error::Kind::InvalidArgument, "file '" + value.substr(0, 1000) + "'",
              "as " + field + " it " + why);
}

} // namespace

const std::vector<std::string>& PathFields() {
  static const std::vector<std::string> fields = {"dspace.v1.AddTerrainLayer.FalseColor.path",
                                                  "dspace.v1.AddTerrainLayer.Image.path",
                                                  "dspace.v1.AddTerrainLayer.Shapes.path",
                                                  "dspace.v1.BuildTerrainCache.folder",
                                                  "dspace.v1.BuildTerrainCache.path",
                                                  "dspace.v1.ClearTerrainCache.folder",
                                                  "dspace.v1.ClearTerrainCache.path",
                                                  "dspace.v1.CameraModel.model_path",
                                                  "dspace.v1.HorizonMap.path",
                                                  "dspace.v1.IlluminationMap.horizon_path",
                                                  "dspace.v1.IlluminationMap.path",
                                                  "dspace.v1.ImportObject.Level.path",
                                                  "dspace.v1.ListTerrainCache.folder",
                                                  "dspace.v1.LoadRobot.path",
                                                  "dspace.v1.LoadTracks.path",
                                                  "dspace.v1.Material.texture",
                                                  "dspace.v1.OpenTerrain.Drape.path",
                                                  "dspace.v1.OpenTerrain.Patch.path",
                                                  "dspace.v1.OpenTerrain.overview_cache",
                                                  "dspace.v1.OpenTerrain.path",
                                                  "dspace.v1.SaveImage.path",
                                                  "dspace.v1.SaveTracks.path",
                                                  "dspace.v1.SimulateImage.path",
                                                  "dspace.v1.StyleTerrain.Detail.path",
                                                  "dspace.v1.VerifyTerrainCache.folder",
                                                  "dspace.v1.Viewshed.path"};
  return fields;
}

const std::vector<std::string>& CrsFields() {
  static const std::vector<std::string> fields = {"crs", "vertical_datum"};
  return fields;
}

const std::vector<std::string>& PlainFields() {
  static const std::vector<std::string> fields = {
      "answer",      "axes",     "below",      "body",      "camera",          "choice",
      "description", "fragment", "frame_path", "from",      "hidden_fragment", "key",
      "kind",        "label",    "layer",      "name",      "object_name",     "observer",
      "robot",       "scene",    "target",     "telemetry", "terrain",         "text",
      "title",       "unit",     "value",      "vantage",   "viewport"};
  return fields;
}

std::vector<std::string> UnlistedFields() {
  std::vector<std::string> unlisted;
  for (const auto& [field, kind] : TextTree::Get().Texts()) {
    if (kind == FieldKind::Unknown) {
      unlisted.push_back(field->full_name());
    }
  }
  return unlisted;
}

void MakePathsAbsolute(v1::Command& command) {
  if (command.has_set_poses()) {
    return; // has none, and comes a thousand times a second
  }
  ForEachText(command, [](const std::string& text, const FieldDescriptor&, FieldKind kind) {
    std::error_code error;
    return kind == FieldKind::Path && !text.empty() &&
                   (text.find(':') == std::string::npos || fs::exists(text, error))
               ? fs::absolute(text).lexically_normal().string()
               : text;
  });
}

Confinement::Confinement(const std::vector<std::string>& roots) {
  for (const std::string& root : roots) {
    std::error_code error;
    const fs::path path = fs::canonical(root, error);
    if (error || !fs::is_directory(path)) {
      throw Error(Error::Kind::NotFound, "folder '" + root + "'",
                  "there is no such folder; accepted as a root: one that there is");
    }
    this->Roots_.push_back(path);
  }
}

void Confinement::Apply(v1::Command& command) const {
  ForEachText(
      command,
      [this](const std::string& text, const FieldDescriptor& field, FieldKind kind) -> std::string {
        if (text.empty() || kind == FieldKind::Plain) {
          return text;
        }
        if (kind == FieldKind::Path) {
          return this->Check(text, field.full_name());
        }
        if (kind == FieldKind::Unknown) {
          RefusePath(text, field.full_name(), "is of no kind that a server knows");
        }
        if (NamesFile(text)) {
          RefusePath(
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
              "a file that the command names leads to it, and it lies outside of what the server "
              "allows");
}

// What is not there may mean something else than a file to the library that is to read it, and what
// is no plain file may never end.
void Confinement::RequireThere(const std::string& real, const std::string& text,
                               const std::string& field) const {
  std::error_code error;
  const fs::file_status status = fs::status(real, error);
  if (!fs::exists(status)) {
    throw Error(Error::Kind::NotFound, "file '" + text.substr(0, 1000) + "'",
                "as " + field + " there is no such file; accepted: one that there is");
  }
  if (!fs::is_regular_file(status) && !fs::is_directory(status)) {
    RefusePath(text, field, "is neither a file nor a folder");
  }
}

std::string Confinement::Check(const std::string& text, const std::string& field) const {
  if (text.find('\0') != std::string::npos) {
    RefusePath(text, field, "holds a zero byte");
  }
  // GDAL takes a name with "<VRTDataset" anywhere in it for that document itself.
  if (text.find_first_of("<>") != std::string::npos) {
    RefusePath(text, field, "holds '<' or '>'; accepted: names without");
  }
  // What is opened is what was looked at: the same absolute path.
  const fs::path path = fs::absolute(text).lexically_normal();
  std::error_code error;
  const fs::path real = fs::weakly_canonical(path, error);
  const bool plain = path.string().rfind("/vsi", 0) != 0;
  for (const std::string& root : this->Roots_) {
    if (!error && plain && Within(real, root)) {
      if (NewPaths.count(field) == 0) {
        this->RequireThere(real, text, field);
      }
      return path;
    }
  }
  std::string accepted;
  for (const std::string& root : this->Roots_) {
    accepted += (accepted.empty() ? "" : ", ") + root;
  }
  RefusePath(text, field,
             "lies outside of what the server allows; accepted: files in " +
                 (accepted.empty() ? "no folder" : accepted));
}

} // namespace dspace::session
