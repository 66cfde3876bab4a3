#include <dspace/recording/RecordingAssets.h>

#include <filesystem>
#include <fstream>

#include <zlib.h>

#include <dspace/raster/DatasetFiles.h>

namespace dspace::session {
namespace {

constexpr auto PartBytes = std::size_t(RecordingPartBytes);

// Empty where zlib saves less than a tenth.
std::string Compress(const std::string& part) {
  std::string out(part.size() - part.size() / 10, '\0');
  uLongf size = out.size();
  if (compress2(reinterpret_cast<Bytef*>(out.data()), &size,
                reinterpret_cast<const Bytef*>(part.data()), part.size(), 1) != Z_OK) {
    return {};
  }
  out.resize(size);
  return out;
}

} // namespace

void RecordingAssets::Put(const std::string& path, const FileStamp& stamp) {
  const auto [known, isNew] = this->Known_.emplace(path, stamp);
  if (!isNew) {
    if (!(known->second == stamp)) {
      known->second = stamp;
      this->PutRow(path, "changed");
    }
    return;
  }
  this->PutOne(path, stamp);
  for (const std::string& part : MosaicFiles(path)) {
    const FileStamp now = FileStamp::Of(part);
    if (this->Known_.emplace(part, now).second) {
      this->PutOne(part, now);
    }
  }
}

void RecordingAssets::PutRow(const std::string& path, const char* state) {
  RecordingAsset asset;
  asset.id = ++this->Assets_;
  asset.path = path;
  asset.state = state;
  this->File_.Put(asset);
  if (this->Pack_ && asset.state != "absent") {
    this->Missing_.push_back(path);
  }
}

void RecordingAssets::PutOne(const std::string& path, const FileStamp& stamp) {
  namespace fs = std::filesystem;
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  // A file on a server is not a local file, and not absent.
  if (status.type() == fs::file_type::not_found && fs::path(path).is_absolute() &&
      path.compare(0, 4, "/vsi") != 0 && path.find("://") == std::string::npos) {
    this->PutRow(path, stamp.size < 0 ? "absent" : "changed");
    return;
  }
  RecordingAsset asset;
  asset.path = path;
  asset.id = this->Assets_ + 1;
  if (!fs::is_regular_file(status) || !this->Read(asset)) {
    this->PutRow(path, "unreadable");
    return;
  }
  if (!(FileStamp::Of(path) == stamp)) {
    this->PutRow(path, "changed");
    return;
  }
  ++this->Assets_;
  asset.state = "read";
  asset.packed = this->Pack_;
  this->File_.Put(asset);
}

void RecordingAssets::PutArrays(const std::string& digest, const std::string& bytes) {
  RecordingAsset asset;
  asset.id = ++this->Assets_;
  asset.path = "arrays:" + Hexadecimal(digest);
  asset.state = "arrays";
  asset.sha256 = digest;
  asset.packed = true;
  this->Incompressible_ = 0;
  while (asset.size < std::int64_t(bytes.size())) {
    const std::string part = bytes.substr(std::size_t(asset.size), PartBytes);
    this->PutPart(asset, part);
    asset.size += std::int64_t(part.size());
  }
  this->File_.Put(asset);
}

bool RecordingAssets::Pack(const RecordingAsset& noted, const CancelCheck& checkCancel) {
  this->File_.RemoveContent(noted.id); // of a run that was broken off
  this->Parts_ = this->File_.LastContent();
  RecordingAsset found = noted;
  found.size = 0;
  found.packed = true;
  if (!this->Read(found, checkCancel) || found.size != noted.size || found.sha256 != noted.sha256) {
    this->File_.RemoveContent(noted.id);
    return false;
  }
  this->File_.Replace(found);
  return true;
}

bool RecordingAssets::Read(RecordingAsset& asset, const CancelCheck& checkCancel) {
  std::ifstream file(asset.path, std::ios::binary);
  std::string part(PartBytes, '\0');
  Sha256 sum;
  this->Incompressible_ = 0;
  while (file.read(part.data(), std::streamsize(PartBytes)), file.gcount() > 0) {
    if (checkCancel) {
      checkCancel();
    }
    part.resize(std::size_t(file.gcount()));
    sum.Add(part.data(), part.size());
    if (this->Pack_) {
      this->PutPart(asset, part);
    }
    asset.size += std::int64_t(part.size());
    part.resize(PartBytes);
  }
  asset.sha256 = sum.Finish();
  return file.eof() && !file.bad();
}

void RecordingAssets::PutPart(RecordingAsset& asset, const std::string& part) {
  RecordingContent content;
  content.id = ++this->Parts_;
  content.asset = asset.id;
  content.place = asset.size;
  content.size = std::int64_t(part.size());
  if (this->Incompressible_ == 0) {
    content.data = Compress(part);
    this->Incompressible_ = content.data.empty() ? 8 : 1;
  }
  --this->Incompressible_;
  if (content.data.empty()) {
    content.data = part;
  }
  this->File_.Put(content);
  this->File_.CommitEach(content.data.size());
}

} // namespace dspace::session
