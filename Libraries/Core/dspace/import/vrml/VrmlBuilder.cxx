#include <dspace/import/vrml/VrmlBuilder.h>

#include <dspace/import/files/FileNames.h>
#include <dspace/import/files/ImageReader.h>
#include <dspace/import/files/ImportFile.h>

#include <dspace/Error.h>
#include <dspace/Utf8.h>
#include <dspace/import/vrml/Vrml1Walk.h>
#include <dspace/import/vrml/Vrml2Walk.h>

#include <algorithm>
#include <filesystem>

namespace dspace {

namespace {

constexpr std::size_t MaximumSteps = 2000000;
constexpr int MaximumDepth = 512;
constexpr std::size_t MaximumOpenFiles = 16;
constexpr std::size_t MaximumAlike = 3; // warnings of one kind that are given each by itself

std::string Canonical(const std::string& path) {
  std::error_code error;
  const std::filesystem::path canonical = std::filesystem::weakly_canonical(path, error);
  return error ? path : canonical.string();
}

std::string List(const std::vector<std::string>& urls) {
  std::string list;
  for (std::size_t i = 0; i < urls.size() && i < 3; ++i) {
    list += (i ? ", '" : "'") + Utf8Beginning(urls[i], 200) + "'";
  }
  return list + (urls.size() > 3 ? ", ..." : "");
}

// "3 faces of 12 corners" as "N faces of N corners": what complaints of one kind share.
std::string WithoutNumbers(const std::string& text) {
  std::string out;
  for (const char c : text) {
    const bool digit = c >= '0' && c <= '9';
    if (!digit) {
      out += c;
    } else if (out.empty() || out.back() != 'N') {
      out += 'N';
    }
  }
  return out;
}

} // namespace

VrmlBuilder::VrmlBuilder(const std::string& path, const ImportOptions& options,
                         CoinSession& session)
    : Options_(options), Session_(session) {
  this->Model_.path = path;
}

Model VrmlBuilder::Run() {
  this->AddNode(-1, std::filesystem::path(this->Model_.path).stem().string(),
                Eigen::Affine3d::Identity());
  this->WalkFile(this->Model_.path, 0, 0);
  this->AppendWarnings();
  for (const auto& [type, count] : this->LeftOut_) {
    this->Model_.leftOut.push_back(std::to_string(count) + " " + type);
  }
  return std::move(this->Model_);
}

const VrmlFile& VrmlBuilder::Open(const std::string& path) {
  const std::string canonical = Canonical(path);
  const auto found = this->Files_.find(canonical);
  if (found != this->Files_.end()) {
    return found->second;
  }
  VrmlFile file = ParseVrml(path, this->Session_, this->Model_.warnings);
  for (const auto& [type, count] : file.guarded.leftOut) {
    this->LeftOut_[type] += count;
  }
  return this->Files_.emplace(canonical, std::move(file)).first->second;
}

void VrmlBuilder::WalkFile(const std::string& path, int parent, int depth) {
  const VrmlFile& file = this->Open(path);
  this->OpenFiles_.push_back(Canonical(path));
  if (file.dialect == VrmlDialect::Vrml2) {
    WalkVrml2(*this, file, parent, depth);
  } else {
    WalkVrml1(*this, file, parent, depth);
  }
  this->OpenFiles_.pop_back();
}

void VrmlBuilder::Step(const VrmlFile& file, int depth) {
  if (depth > MaximumDepth) {
    throw Error(Error::Kind::Resource, FileObject(file.path),
                "its nodes and inlined files are nested deeper than " +
                    std::to_string(MaximumDepth));
  }
  if (++this->Steps_ > MaximumSteps) {
    throw Error(Error::Kind::Resource, FileObject(this->Model_.path),
                "expands to more than " + std::to_string(MaximumSteps) + " nodes");
  }
}

void VrmlBuilder::SetRange(int node, const DistanceRange& range) {
  this->Model_.nodes[static_cast<std::size_t>(node)].range = range;
}

int VrmlBuilder::AddNode(int parent, const std::string& name, const Eigen::Affine3d& local) {
  ModelNode node;
  node.name = name;
  node.parent = parent;
  node.local = local;
  this->Model_.nodes.push_back(std::move(node));
  return static_cast<int>(this->Model_.nodes.size()) - 1;
}

bool VrmlBuilder::UseMesh(int node, const Key& key) {
  const auto found = this->Meshes_.find(key);
  if (found == this->Meshes_.end()) {
    return false;
  }
  if (found->second >= 0) {
    const Mesh& mesh = this->Model_.meshes[static_cast<std::size_t>(found->second)];
    this->Triangles_ += mesh.PrimitiveCount();
    if (this->Triangles_ > this->Options_.maximumTriangles) {
      throw Error(Error::Kind::Resource, FileObject(this->Model_.path),
                  "expands to more than " + std::to_string(this->Options_.maximumTriangles) +
                      " triangles");
    }
    this->Model_.nodes[static_cast<std::size_t>(node)].meshes.push_back(found->second);
  }
  return true;
}

void VrmlBuilder::AddMesh(int node, const Key& key, Mesh mesh) {
  int index = -1;
  if (!mesh.indices.empty()) {
    index = static_cast<int>(this->Model_.meshes.size());
    this->Model_.meshes.push_back(std::move(mesh));
  }
  this->Meshes_[key] = index;
  this->UseMesh(node, key);
}

int VrmlBuilder::FindMaterial(const Key& key) const {
  const auto found = this->Materials_.find(key);
  return found == this->Materials_.end() ? -1 : found->second;
}

int VrmlBuilder::AddMaterial(const Key& key, const Material& material) {
  this->Model_.materials.push_back(material);
  return this->Materials_[key] = static_cast<int>(this->Model_.materials.size()) - 1;
}

std::shared_ptr<const Image> VrmlBuilder::Texture(const VrmlFile& file,
                                                  const std::vector<std::string>& urls) {
  std::string reason;
  for (const std::string& url : urls) {
    std::shared_ptr<const Image> image;
    try {
      const std::string path = ResolveReference(file.path, url);
      const auto found = this->Textures_.find(path);
      if (found != this->Textures_.end()) {
        return found->second; // null: it was reported before
      }
      image = this->Textures_[path] = ReadImage(path);
    } catch (const Error& e) {
      reason = reason.empty() ? e.what() : reason;
      continue;
    }
    this->TextureBudget_.Add(image.get(), FileObject(file.path));
    return image;
  }
  if (!urls.empty()) {
    this->Warn(file, "textures are left out", List(urls),
               "texture " + List(urls) + " is left out: " + reason);
  }
  return nullptr;
}

void VrmlBuilder::Inline(const VrmlFile& file, const std::vector<std::string>& urls, int parent,
                         int depth) {
  std::string reason;
  for (const std::string& url : urls) {
    std::string path;
    try {
      path = ResolveReference(file.path, url.substr(0, url.find('#')));
      this->Open(path);
    } catch (const Error& e) {
      // A bomb is rejected wherever it hides; a file that is absent or damaged is left out.
      if (e.GetKind() == Error::Kind::Resource) {
        throw;
      }
      reason = reason.empty() ? e.what() : reason;
      continue;
    }
    const std::string canonical = Canonical(path);
    if (std::find(this->OpenFiles_.begin(), this->OpenFiles_.end(), canonical) !=
            this->OpenFiles_.end() ||
        this->OpenFiles_.size() >= MaximumOpenFiles) {
      throw Error(Error::Kind::Corrupt, FileObject(file.path),
                  "Inline of '" + url + "' closes a circle of files, or nests more than " +
                      std::to_string(MaximumOpenFiles));
    }
    this->WalkFile(path, parent, depth + 1);
    return;
  }
  if (!urls.empty()) {
    this->Warn(file, "inlined files are left out", List(urls),
               "Inline of " + List(urls) + " is left out: " + reason);
  }
}

void VrmlBuilder::Warn(const VrmlFile& file, const std::string& kind, const std::string& name,
                       const std::string& message) {
  const std::string object = FileObject(file.path);
  if (!this->Warned_.insert(object + message).second) {
    return;
  }
  auto found = std::find_if(this->Warnings_.begin(), this->Warnings_.end(),
                            [&](const Warnings& w) { return w.kind == kind && w.file == object; });
  if (found == this->Warnings_.end()) {
    found = this->Warnings_.insert(found, Warnings{kind, object, {}, {}, 0});
  }
  if (found->count++ < MaximumAlike) {
    found->names += (found->names.empty() ? "" : ", ") + name;
    found->messages.push_back(message);
  }
}

void VrmlBuilder::AppendWarnings() {
  for (const Warnings& w : this->Warnings_) {
    if (w.count > MaximumAlike) {
      this->Model_.warnings.push_back(std::to_string(w.count) + " " + w.kind + ": " + w.names +
                                      ", ... (" + w.file + "). The first: " + w.messages.front());
      continue;
    }
    for (const std::string& message : w.messages) {
      this->Model_.warnings.push_back(message + " (" + w.file + ")");
    }
  }
}

void VrmlBuilder::WarnShape(const VrmlFile& file, const std::string& what,
                            const VrmlComplaints& complaints) {
  for (const std::string& complaint : complaints) {
    std::string message = what;
    message += ": ";
    message += complaint;
    this->Warn(file, "shapes: " + WithoutNumbers(complaint), what, message);
  }
}

} // namespace dspace
