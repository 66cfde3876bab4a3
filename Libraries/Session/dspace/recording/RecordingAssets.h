// Records the files that a recording's commands need, and packs them into it. Use it from one
// thread.
#ifndef DSPACE_SESSION_RECORDING_ASSETS_H
#define DSPACE_SESSION_RECORDING_ASSETS_H

#include <cstdint>
#include <map>
#include <string>
#include <vector>

#include <dspace/FilesRead.h>
#include <dspace/recording/CancelCheck.h>
#include <dspace/recording/RecordingFile.h>

namespace dspace::session {

class RecordingAssets {
public:
  // pack: also stores their content.
  RecordingAssets(RecordingFile& file, bool pack) : File_(file), Pack_(pack) {}

  // Records a file in its state when the commands that need it were executed, and the sources of a
  // mosaic. A file that is already recorded is skipped, or recorded as changed if `stamp` differs.
  // Call it within a transaction, which is committed and restarted after each 64 MiB. Throws
  // Error(Io) if the recording cannot be written. An unreadable file is recorded as unreadable.
  void Put(const std::string& path, const FileStamp& stamp);

  // Stores the arrays of meshes with this digest. Call it within a transaction, as above.
  void PutArrays(const std::string& digest, const std::string& bytes);

  // Packs the content of a recorded file. Call it within a transaction, as above. Returns false and
  // stores nothing if the file has changed.
  bool Pack(const RecordingAsset& noted, const CancelCheck& checkCancel);

  // Files that should be packed and could not be read.
  const std::vector<std::string>& Missing() const { return this->Missing_; }

private:
  void PutOne(const std::string& path, const FileStamp& stamp);
  void PutRow(const std::string& path, const char* state);
  // False if it cannot be read completely.
  bool Read(RecordingAsset& asset, const CancelCheck& checkCancel = {});
  void PutPart(RecordingAsset& asset, const std::string& part);

  RecordingFile& File_;
  const bool Pack_;
  std::map<std::string, FileStamp> Known_;
  std::vector<std::string> Missing_;
  std::int64_t Assets_ = 0;
  std::int64_t Parts_ = 0;
  int Incompressible_ = 0; // number of parts that were not compressible
};

} // namespace dspace::session

#endif
