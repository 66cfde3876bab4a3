// The files that a recording's commands need, noted in it and packed into it. Used from one thread.
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
  // pack: their content too.
  RecordingAssets(RecordingFile& file, bool pack) : File_(file), Pack_(pack) {}

  // Notes a file, as it was when the commands that need it were carried out, and what belongs to it
  // where it is a mosaic. A file that is noted already is left, or noted as changed where `stamp`
  // is another one. Within a transaction, which is committed and begun anew after each 64 MiB.
  // Throws Error(Io) where the recording cannot be written; what cannot be read is noted as such.
  void Put(const std::string& path, const FileStamp& stamp);

  // Takes the content of a file into a recording that has noted the file. Within a transaction, as
  // above. False, and nothing of it stays, where it is not what it was.
  bool Pack(const RecordingAsset& noted, const CancelCheck& checkCancel);

  // Files that were to be packed and could not be read.
  const std::vector<std::string>& Missing() const { return this->Missing_; }

private:
  void PutOne(const std::string& path, const FileStamp& stamp);
  void PutRow(const std::string& path, const char* state);
  // False where it cannot be read to its end.
  bool Read(RecordingAsset& asset, const CancelCheck& checkCancel = {});
  void PutPart(RecordingAsset& asset, const std::string& part);

  RecordingFile& File_;
  const bool Pack_;
  std::map<std::string, FileStamp> Known_;
  std::vector<std::string> Missing_;
  std::int64_t Assets_ = 0;
  std::int64_t Parts_ = 0;
  int Incompressible_ = 0; // parts that need not be tried
};

} // namespace dspace::session

#endif
