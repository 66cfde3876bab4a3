// The arrays of meshes that a recording stores apart from its commands.
#ifndef DSPACE_SESSION_RECORDED_ARRAYS_H
#define DSPACE_SESSION_RECORDED_ARRAYS_H

#include <cstdint>
#include <map>
#include <string>

#include <dspace/recording/RecordingReader.h>

namespace dspace::session {

// Keeps what it has read, up to 256 MiB: a mesh that is set again and again is read once. Use it
// from one thread at a time.
class RecordedArrays {
public:
  // `reader` must outlive it.
  explicit RecordedArrays(RecordingReader& reader) : Reader_(reader) {}

  // Puts the arrays into the meshes of a recorded command. Throws Error(Corrupt) that names the
  // arrays if they are missing or damaged, and the errors of RecordingReader.
  void FillIn(v1::Command& command);

private:
  const std::string& Get(const std::string& digest);

  RecordingReader& Reader_;
  std::map<std::string, RecordingAsset> Assets_; // by digest
  RecordingReader::PartNumbers Parts_;
  std::int64_t Seen_ = 0;                   // the highest id of Assets_
  std::map<std::string, std::string> Kept_; // bytes by digest
  std::size_t KeptBytes_ = 0;
};

} // namespace dspace::session

#endif
