#include <dspace/recording/RecordingPack.h>

#include <filesystem>
#include <memory>

#include <sqlite3.h>

#include <dspace/Error.h>
#include <dspace/recording/NewRecording.h>
#include <dspace/recording/RecordingAssets.h>
#include <dspace/recording/RecordingDatabase.h>
#include <dspace/recording/RecordingReader.h>

namespace dspace::session {
namespace {

constexpr int PagesAtOnce = 256; // 16 MiB

bool IsNeeded(const RecordingAsset& asset) {
  return asset.state == "read" && !asset.packed;
}

bool IsThere(const RecordingAsset& asset) {
  std::error_code error;
  return std::filesystem::is_regular_file(asset.path, error);
}

// A packed recording without its files could not be played.
void RequireFiles(const std::string& name, const std::vector<RecordingAsset>& assets) {
  std::vector<std::string> gone;
  for (const RecordingAsset& asset : assets) {
    if (IsNeeded(asset) && !IsThere(asset)) {
      gone.push_back(asset.path);
    }
  }
  if (!gone.empty()) {
    const std::string more = gone.size() > 2
                                 ? ", and so are " + std::to_string(gone.size() - 1) + " others"
                             : gone.size() == 2 ? ", and so is 1 other"
                                                : "";
    throw Error(Error::Kind::NotFound, name,
                "its file '" + gone[0] + "' is missing" + more +
                    "; accepted: all of them as they were recorded");
  }
}

// All of a recording, which may be being written, into an empty file.
void Copy(const RecordingReader& reader, const NewRecording& out, const CancelCheck& checkCancel) {
  const RecordingDatabase::View view(reader.Database());
  sqlite3* opened = nullptr;
  int result = sqlite3_open_v2(out.Path().c_str(), &opened, SQLITE_OPEN_READWRITE, nullptr);
  const std::unique_ptr<sqlite3, int (*)(sqlite3*)> target(opened, sqlite3_close);
  if (result == SQLITE_OK) {
    const std::unique_ptr<sqlite3_backup, int (*)(sqlite3_backup*)> backup(
        sqlite3_backup_init(target.get(), "main", reader.Database().Handle(), "main"),
        sqlite3_backup_finish);
    do {
      checkCancel();
      result =
          backup ? sqlite3_backup_step(backup.get(), PagesAtOnce) : sqlite3_errcode(target.get());
    } while (result == SQLITE_OK);
  }
  if ((result & 255) == SQLITE_CORRUPT || (result & 255) == SQLITE_NOTADB) {
    reader.Database().Damaged(sqlite3_errstr(result));
  }
  if (result != SQLITE_DONE) {
    throw Error(Error::Kind::Io, out.Name(),
                std::string("it cannot be written: ") + sqlite3_errstr(result) +
                    "; accepted: a new file in a folder that may be written and has room");
  }
}

void PackOne(RecordingFile& file, RecordingAssets& packer, const std::string& name,
             const RecordingAsset& asset, const CancelCheck& checkCancel) {
  file.Begin();
  if (packer.Pack(asset, checkCancel)) {
    file.Commit();
    return;
  }
  file.Commit(); // of what was put of it
  throw Error(Error::Kind::Corrupt, name,
              "file '" + asset.path + "' has changed since it was recorded; accepted: its " +
                  std::to_string(asset.size) + " bytes of SHA-256 " + Hexadecimal(asset.sha256));
}

} // namespace

PackReport PackRecording(const std::string& path, const std::optional<std::string>& out,
                         const CancelCheck& checkCancel) {
  std::vector<RecordingAsset> assets;
  std::string target, name;
  std::unique_ptr<NewRecording> made;
  { // it is closed before it is locked
    RecordingReader reader(path);
    target = reader.Path();
    assets = reader.Assets();
    name = RecordingName(target);
    RequireFiles(name, assets);
    if (out) {
      made = std::make_unique<NewRecording>(*out);
      target = made->Path();
      name = made->Name();
      Copy(reader, *made, checkCancel);
    }
  }
  PackReport report;
  {
    RecordingFile file(target, name, RecordingFile::Existing());
    RecordingAssets packer(file, true);
    for (const RecordingAsset& asset : assets) {
      if (IsNeeded(asset)) {
        RequireFiles(name, {asset}); // it may have been removed since
        PackOne(file, packer, name, asset, checkCancel);
      } else if (asset.state != "absent" && !asset.packed) {
        report.missing.push_back(asset.path);
      }
      if (asset.state == "read") {
        ++report.files;
        report.bytes += std::uint64_t(asset.size);
      }
    }
    file.Finish();
  }
  if (made) {
    made->Keep();
  }
  return report;
}

} // namespace dspace::session
