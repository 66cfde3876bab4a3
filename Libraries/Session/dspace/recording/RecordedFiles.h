// The files that a recording's commands need, where it is played: checked, or unpacked.
#ifndef DSPACE_SESSION_RECORDED_FILES_H
#define DSPACE_SESSION_RECORDED_FILES_H

#include <cstdint>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include <dspace/FilesRead.h>
#include <dspace/recording/RecordingReader.h>

namespace dspace {
class ProjFolders;
}

namespace dspace::session {

class Confinement;

// Of a recording with packed files these are unpacked into a folder of their own (below TMPDIR,
// readable by this user only), at their own paths below it, so that they name each other as they
// did, and PROJ finds its grids there first, in all of the process; nothing is ever written
// elsewhere, and the folder goes with this object. Of any other the files on this machine must be
// what they were. Used from one thread at a time.
//
// Throws Error, which names the file: Corrupt (it has changed since; it had changed before it was
// recorded; it is there now and was not; its packed content is damaged), NotFound (it is gone), Io
// (it cannot be read, or not be unpacked), Resource (no room to unpack); and those of
// RecordingReader.
class RecordedFiles {
public:
  // Unpacks or checks all that is noted so far. `reader` must outlive it. check: false looks at no
  // file that was not packed.
  explicit RecordedFiles(RecordingReader& reader, bool check = true);
  ~RecordedFiles();
  RecordedFiles(const RecordedFiles&) = delete;
  RecordedFiles& operator=(const RecordedFiles&) = delete;

  // The same for what has been noted since, of a recording that is being written. After an error
  // the next call looks at them again.
  void Update();

  // Where files were unpacked; empty: nothing was packed.
  const std::string& Folder() const { return this->Folder_; }

  // Where a path of the recording's is: below the folder, whatever it holds, and whether anything
  // was packed there or not. The path itself without a folder.
  std::string Locate(const std::string& path) const;

  // For a FilesGuard around the recording's commands, valid also after this object is gone. Of
  // packed files only those in the folder are accepted. Of others any is: they were checked, and
  // the guard restricts the formats of rasters and shapes (ConfinedDrivers.h) all the same.
  FilesGuard::Look Look() const;

  // A recorded command with its paths made those of the folder; with none it stays as it is.
  // Overviews of another machine are not to be had: terrains are told to build them in the folder.
  void Map(v1::Command& command) const;

private:
  void Check(const std::vector<RecordingAsset>& assets) const;
  void Unpack(const std::vector<RecordingAsset>& assets);
  void UnpackOne(const RecordingAsset& asset, const std::vector<std::int64_t>& parts);
  std::string MapPath(const std::string& path) const;

  class OwnFolder;
  RecordingReader& Reader_;
  const bool Check_;
  std::int64_t Seen_ = 0; // the last row of a file that was looked at
  std::unique_ptr<OwnFolder> Owned_;
  std::string Folder_;
  std::shared_ptr<const Confinement> Confinement_; // to the folder
  std::map<std::string, std::string> Places_;      // of the recording's packed paths
  std::unique_ptr<ProjFolders> Grids_;             // PROJ's, which it looks for by name
};

} // namespace dspace::session

#endif
