#include <dspace/recording/RecordedFiles.h>

#include <algorithm>
#include <cerrno>
#include <cstdlib>
#include <cstring>
#include <ctime>
#include <filesystem>
#include <fstream>
#include <limits>
#include <set>
#include <utility>

#include <fcntl.h>
#include <sys/file.h>
#include <sys/stat.h>
#include <unistd.h>

#include <dspace/Error.h>
#include <dspace/crs/ProjFolders.h>
#include <dspace/messages/CommandFiles.h>
#include <dspace/messages/Confinement.h>
#include <dspace/messages/Sha256.h>
#include <dspace/recording/RecordedNames.h>
#include <dspace/recording/RecordingDatabase.h>
#include <dspace/recording/RecordingFile.h>

namespace dspace::session {
namespace {

namespace fs = std::filesystem;

std::vector<RecordingAsset> FilesOf(RecordingReader& reader, std::int64_t after) {
  std::vector<RecordingAsset> assets = reader.Assets(after);
  assets.erase(std::remove_if(assets.begin(), assets.end(), IsArrays), assets.end());
  return assets;
}

// Whether the files that there were are in the recording, all of them.
bool IsPacked(const std::vector<RecordingAsset>& assets) {
  bool any = false;
  for (const RecordingAsset& asset : assets) {
    any = any || asset.packed;
    if (asset.state == "read" && !asset.packed) {
      return false;
    }
  }
  return any;
}

[[noreturn]] void HadChanged(const RecordingReader& reader, const RecordingAsset& asset,
                             const std::string& accepted) {
  throw Error(Error::Kind::Corrupt, RecordingName(reader.Path()),
              "file '" + asset.path + "' changed between being read and being recorded" + accepted);
}

void RequireAbsent(const RecordingReader& reader, const RecordingAsset& asset) {
  std::error_code error;
  if (fs::exists(fs::symlink_status(asset.path, error))) {
    throw Error(Error::Kind::Corrupt, RecordingName(reader.Path()),
                "file '" + asset.path + "' did not exist when it was recorded, and exists now");
  }
}

// The SHA-256 of a file of `size` bytes; empty if its size differs.
std::string HashOf(const std::string& path, std::int64_t size, const std::string& object,
                   const CancelCheck& checkCancel) {
  std::error_code error;
  if (std::int64_t(fs::file_size(path, error)) != size && !error) {
    return {};
  }
  std::ifstream file(path, std::ios::binary);
  std::string part(std::size_t(RecordingPartBytes), '\0');
  Sha256 sum;
  while (file.read(part.data(), std::streamsize(part.size())), file.gcount() > 0) {
    if (checkCancel) {
      checkCancel();
    }
    sum.Add(part.data(), std::size_t(file.gcount()));
  }
  if (!file.eof() || file.bad()) {
    throw Error(Error::Kind::Io, object, "file '" + path + "', which it needs, cannot be read");
  }
  return sum.Finish();
}

// An absolute path without "." and "..", of any text.
std::string Below(const std::string& text) {
  std::vector<std::string> names;
  std::string name;
  for (const char c : text + "/") {
    if (c != '/') {
      name += c == '\0' ? std::string() : std::string(1, c);
      continue;
    }
    if (name == "..") {
      names.resize(names.empty() ? 0 : names.size() - 1);
    } else if (!name.empty() && name != ".") {
      names.push_back(name);
    }
    name.clear();
  }
  std::string path;
  for (const std::string& each : names) {
    path += "/" + each;
  }
  return path;
}

} // namespace

// Goes with its content. The process holds a lock on it, so that others know whether it is in use.
class RecordedFiles::OwnFolder {
public:
  explicit OwnFolder(const std::string& object) {
    std::error_code error;
    const fs::path above = fs::canonical(fs::temp_directory_path(error), error);
    RemoveAbandoned(above);
    std::string name = (above / (std::string(Name) + "XXXXXX")).string();
    if (error || !::mkdtemp(name.data())) {
      throw Error(Error::Kind::Io, object,
                  "its files cannot be unpacked below '" + above.string() +
                      "': " + (error ? error.message() : std::strerror(errno)) +
                      "; accepted: TMPDIR, a folder to write into");
    }
    this->Path = name;
    this->Lock_ = ::open(name.c_str(), Opened);
    if (this->Lock_ >= 0) {
      ::flock(this->Lock_, LOCK_SH | LOCK_NB);
    }
  }
  ~OwnFolder() {
    if (getpid() == this->Process_) { // else it is the parent's, which reads it
      std::error_code ignored;
      fs::remove_all(this->Path, ignored);
    }
    if (this->Lock_ >= 0) {
      ::close(this->Lock_);
    }
  }
  OwnFolder(const OwnFolder&) = delete;
  OwnFolder& operator=(const OwnFolder&) = delete;
  std::string Path;

private:
  static constexpr const char* Name = "dspace-unpacked-";
  static constexpr int Opened = O_RDONLY | O_DIRECTORY | O_NOFOLLOW | O_CLOEXEC;
  static constexpr std::time_t YoungSeconds = 60; // another process may be about to lock it

  // Folders of this user whose process ended without removing them.
  static void RemoveAbandoned(const fs::path& above) {
    std::error_code error;
    for (fs::directory_iterator each(above, error), end; !error && each != end;
         each.increment(error)) {
      if (each->path().filename().string().rfind(Name, 0) != 0) {
        continue;
      }
      const int folder = ::open(each->path().c_str(), Opened);
      struct stat state = {};
      if (folder >= 0 && ::fstat(folder, &state) == 0 && state.st_uid == ::geteuid() &&
          state.st_mtime + YoungSeconds < std::time(nullptr) &&
          ::flock(folder, LOCK_EX | LOCK_NB) == 0) {
        std::error_code ignored;
        fs::remove_all(each->path(), ignored);
      }
      if (folder >= 0) {
        ::close(folder);
      }
    }
  }

  const pid_t Process_ = getpid();
  int Lock_ = -1;
};

RecordedFiles::RecordedFiles(RecordingReader& reader, bool check, CancelCheck checkCancel)
    : Reader_(reader), Arrays_(reader), Check_(check), CheckCancel_(std::move(checkCancel)) {
  this->Update();
}

RecordedFiles::~RecordedFiles() = default;

void RecordedFiles::Update() {
  const std::vector<RecordingAsset> assets = FilesOf(this->Reader_, this->Seen_);
  if (assets.empty()) {
    return;
  }
  if (this->Owned_) {
    this->Unpack(assets);
  } else if (const auto all = FilesOf(this->Reader_, 0); IsPacked(all)) {
    this->Owned_ = std::make_unique<OwnFolder>(RecordingName(this->Reader_.Path()));
    this->Folder_ = this->Owned_->Path;
    this->Confinement_ = std::make_shared<const Confinement>(
        std::vector<std::string>{this->Folder_}, "the recording, whose files are packed,");
    this->Unpack(all);
  } else if (this->Check_) {
    this->Check(assets);
  }
  for (const RecordingAsset& asset : assets) {
    this->Seen_ = std::max(this->Seen_, asset.id);
  }
}

void RecordedFiles::Check(const std::vector<RecordingAsset>& assets) const {
  for (const RecordingAsset& asset : assets) {
    const std::string object = RecordingName(this->Reader_.Path());
    const std::string named = "file '" + asset.path + "'";
    std::error_code error;
    if (asset.state == "changed") {
      HadChanged(this->Reader_, asset,
                 "; accepted: only with check_assets=False, which uses its present content");
    }
    if (asset.state == "absent") {
      RequireAbsent(this->Reader_, asset);
    }
    if (asset.state != "read") { // it could not be read then: a folder, or on a server
      continue;
    }
    if (!fs::is_regular_file(asset.path, error)) {
      throw Error(Error::Kind::NotFound, object, named + ", which it needs, is missing");
    }
    if (HashOf(asset.path, asset.size, object, this->CheckCancel_) != asset.sha256) {
      throw Error(Error::Kind::Corrupt, object,
                  named + " has changed since it was recorded; accepted: its " +
                      std::to_string(asset.size) + " bytes of SHA-256 " +
                      Hexadecimal(asset.sha256));
    }
  }
}

void RecordedFiles::Unpack(const std::vector<RecordingAsset>& assets) {
  const std::uint64_t needed = UnpackedBytes(assets);
  this->Reader_.RequireUnpackable(
      needed + std::min(this->Unpacked_, std::numeric_limits<std::uint64_t>::max() - needed));
  std::vector<const RecordingAsset*> packed;
  for (const RecordingAsset& asset : assets) {
    if (asset.state == "changed") {
      HadChanged(this->Reader_, asset, "; accepted: one that is packed as it was read");
    }
    if (asset.state == "absent" && IsProjGrid(asset.path)) {
      RequireAbsent(this->Reader_, asset); // PROJ would find it where it is
    }
    if (asset.packed) {
      packed.push_back(&asset);
    }
  }
  std::error_code error;
  const std::uintmax_t free = fs::space(this->Folder_, error).available;
  if (!error && needed > free) {
    throw Error(Error::Kind::Resource, RecordingName(this->Reader_.Path()),
                "its files need " + std::to_string(needed) + " bytes in '" + this->Folder_ +
                    "', where " + std::to_string(free) + " are free; accepted: TMPDIR with more");
  }
  for (const RecordingAsset* asset : packed) { // of a path that is there already in its place
    const auto known = this->Places_.find(asset->path);
    if (known != this->Places_.end() && fs::is_regular_file(known->second, error)) {
      fs::remove(known->second, error);
    }
  }
  for (const RecordingAsset* asset : packed) {
    this->Places_[asset->path] = this->Locate(asset->path);
  }
  const RecordingReader::PartNumbers numbers = this->Reader_.Parts();
  for (const RecordingAsset* asset : packed) {
    const auto parts = numbers.find(asset->id);
    this->UnpackOne(*asset, parts == numbers.end() ? std::vector<std::int64_t>() : parts->second);
  }
  this->Unpacked_ += needed;
  std::set<std::string> folders;
  for (const auto& entry : this->Places_) {
    if (IsProjGrid(entry.first)) {
      folders.insert(fs::path(entry.second).parent_path().string());
    }
  }
  // PROJ would take these for its own, in all of the process.
  for (const auto& entry : this->Places_) {
    const fs::path place(entry.second);
    if ((place.filename() == "proj.db" || place.filename() == "proj.ini") &&
        folders.count(place.parent_path().string()) != 0) {
      throw Error(Error::Kind::Corrupt, RecordingName(this->Reader_.Path()),
                  "'" + entry.first + "', packed beside a grid, would replace PROJ's own file; " +
                      "accepted: grids without it");
    }
  }
  if (!folders.empty()) {
    this->Grids_ =
        std::make_unique<ProjFolders>(std::vector<std::string>(folders.begin(), folders.end()));
  }
  const RecordedNames names(this->Places_);
  for (const auto& entry : this->Places_) { // one that came before may name one that has come now
    names.RewriteFile(entry.second);
  }
}

void RecordedFiles::UnpackOne(const RecordingAsset& asset, const std::vector<std::int64_t>& parts) {
  const std::string object = RecordingName(this->Reader_.Path());
  const std::string named = "'" + asset.path + "'";
  if (asset.path.empty() || asset.path[0] != '/' || asset.path.find('\0') != std::string::npos) {
    throw Error(Error::Kind::Corrupt, object, named + " is not the path of a file");
  }
  const auto fail = [&](int reason) {
    if (reason == EEXIST || reason == ENOTDIR || reason == EISDIR) {
      throw Error(Error::Kind::Corrupt, object,
                  named + " occurs twice, or is both a file and a folder");
    }
    throw Error(Error::Kind::Io, object, named + " cannot be unpacked: " + std::strerror(reason));
  };
  const std::string target = this->Locate(asset.path);
  std::error_code error;
  fs::create_directories(fs::path(target).parent_path(), error);
  if (error) {
    fail(error.value());
  }
  const int file =
      ::open(target.c_str(), O_WRONLY | O_CREAT | O_EXCL | O_NOFOLLOW | O_CLOEXEC, 0600);
  if (file < 0) {
    fail(errno);
  }
  const std::unique_ptr<const int, void (*)(const int*)> closer(
      &file, [](const int* each) { ::close(*each); });
  Sha256 sum;
  this->Reader_.ReadContent(asset, parts, [&](const std::string& part) {
    if (this->CheckCancel_) {
      this->CheckCancel_();
    }
    sum.Add(part.data(), part.size());
    for (std::size_t done = 0; done < part.size();) {
      const ssize_t n = ::write(file, part.data() + done, part.size() - done);
      if (n < 0 && errno != EINTR) {
        fail(errno);
      }
      done += n > 0 ? std::size_t(n) : 0;
    }
  });
  if (sum.Finish() != asset.sha256) {
    throw Error(Error::Kind::Corrupt, object,
                "the content of " + named +
                    " has changed; `dspace log salvage` recovers "
                    "what survives");
  }
}

std::string RecordedFiles::Locate(const std::string& path) const {
  return this->Folder_.empty() ? path : this->Folder_ + Below(path);
}

FilesGuard::Check RecordedFiles::Look() const {
  if (!this->Confinement_) {
    return [](const std::string&) {};
  }
  return [confinement = this->Confinement_](const std::string& path) {
    confinement->RequireWithin(path);
  };
}

void RecordedFiles::Map(v1::Command& command) const {
  if (this->Folder_.empty()) {
    return;
  }
  MapPaths(command, [this](const std::string& path) { return this->MapPath(path); });
  if (command.has_open_terrain()) {
    v1::OpenTerrain& terrain = *command.mutable_open_terrain();
    const bool built = !terrain.has_build_overviews() || terrain.build_overviews();
    if (!terrain.has_overview_cache() || !terrain.overview_cache().empty()) {
      terrain.set_overview_cache(built ? this->Folder_ + "/overviews" : "");
    }
  }
}

std::string RecordedFiles::MapPath(const std::string& path) const {
  if (path[0] == '/' && path.compare(0, 4, "/vsi") != 0) {
    return this->Locate(path);
  }
  const std::pair<const std::string, std::string>* longest = nullptr;
  for (const auto& entry : this->Places_) { // a part of a file: "/vsizip/...", NETCDF:"..."
    if (path.find(entry.first) != std::string::npos &&
        (!longest || entry.first.size() > longest->first.size())) {
      longest = &entry;
    }
  }
  std::string mapped = path;
  for (std::size_t at = 0; longest && (at = mapped.find(longest->first, at)) != std::string::npos;
       at += longest->second.size()) {
    mapped.replace(at, longest->first.size(), longest->second);
  }
  return mapped;
}

} // namespace dspace::session
