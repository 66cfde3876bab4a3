// The files that a recording's commands need, checked or unpacked for playback.
#ifndef DSPACE_SESSION_RECORDED_FILES_H
#define DSPACE_SESSION_RECORDED_FILES_H

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <dspace/FilesRead.h>
#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/RecordedArrays.h>
#include <dspace/recording/RecordingReader.h>

namespace dspace {
class ProjFolders;
}

namespace dspace::session {

class Confinement;

// Packed files are unpacked into a folder below TMPDIR that only this user can read. They keep
// their paths below this folder, so that they still refer to each other, and PROJ of the whole
// process finds its grids there first. Nothing is written elsewhere, and the destructor removes the
// folder. The folders of processes that were killed are removed when the next one is made. Without
// packed files, the files on this machine must be unchanged. Use it from one thread at a time.
//
// Throws Error, which names the file: Corrupt (it has changed since; it changed before it was
// recorded; it exists now and did not; its packed content is damaged), NotFound (it is missing), Io
// (it cannot be read or unpacked), Resource (no space to unpack, or more than the limit); and those
// of RecordingReader.
class RecordedFiles {
public:
  // Unpacks or checks all recorded files. `reader` must outlive it, and limits how many bytes are
  // unpacked (SetUnpackLimit). check: false does not check files that are not packed. checkCancel:
  // called between parts of a few MiB, also by Update(); what it throws ends the work, and the
  // folder goes.
  explicit RecordedFiles(RecordingReader& reader, bool check = true, CancelCheck checkCancel = {});
  ~RecordedFiles();
  RecordedFiles(const RecordedFiles&) = delete;
  RecordedFiles& operator=(const RecordedFiles&) = delete;

  // Does the same for files that were recorded since. After an error the next call tries them
  // again.
  void Update();

  // The folder of unpacked files; empty: nothing was packed.
  const std::string& Folder() const { return this->Folder_; }

  // The present path of a recorded path: below the folder, whether the file was packed or not.
  // Without a folder, the path itself.
  std::string Locate(const std::string& path) const;

  // For a FilesGuard around the recording's commands. It stays valid after this object is
  // destroyed. With packed files it accepts only files in the folder. Without, it accepts any file,
  // because files were checked; the guard still restricts the formats of rasters and shapes
  // (ConfinedDrivers.h).
  FilesGuard::Check Look() const;

  // Changes the paths of a recorded command to those in the folder, if there is one. The overview
  // cache of the recording machine is not available: terrains build overviews in the folder.
  void Map(v1::Command& command) const;

  // Puts the arrays into the meshes of a recorded command (RecordedArrays).
  void FillIn(v1::Command& command) { this->Arrays_.FillIn(command); }

private:
  void Check(const std::vector<RecordingAsset>& assets) const;
  void Unpack(const std::vector<RecordingAsset>& assets);
  void UnpackOne(const RecordingAsset& asset, const std::vector<std::int64_t>& parts);
  std::string MapPath(const std::string& path) const;

  class OwnFolder;
  RecordingReader& Reader_;
  RecordedArrays Arrays_;
  const bool Check_;
  const CancelCheck CheckCancel_;
  std::int64_t Seen_ = 0;      // the last processed row
  std::uint64_t Unpacked_ = 0; // bytes
  std::unique_ptr<OwnFolder> Owned_;
  std::string Folder_;
  std::shared_ptr<const Confinement> Confinement_; // to the folder
  std::map<std::string, std::string> Places_;      // by recorded path
  std::unique_ptr<ProjFolders> Grids_;             // grids, which PROJ finds by name
};

} // namespace dspace::session

#endif
