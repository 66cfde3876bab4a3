// A file that a recording refers to.
#ifndef DSPACE_SESSION_RECORDING_ASSET_H
#define DSPACE_SESSION_RECORDING_ASSET_H

#include <cstdint>
#include <string>
#include <vector>

namespace dspace::session {

// A file that commands need, or the arrays of a mesh (IsArrays). The checksum is not included.
struct RecordingAsset {
  std::int64_t id = 0;
  std::string path;  // absolute, as it was opened; of arrays: "arrays:" and the hash as text
  std::string state; // "read"; "absent", "unreadable" (a folder, a server's file), "changed" (it
                     // is not what the commands were carried out with): these without the rest;
                     // "arrays"
  std::int64_t size = 0; // bytes
  std::string sha256;    // 32 bytes
  bool packed = false;   // its content is in the recording
};

// Whether it is what TakeArrays returns for the meshes with this hash as digest (MeshMessages.h).
// Always packed.
inline bool IsArrays(const RecordingAsset& asset) {
  return asset.state == "arrays";
}

// Maximum number of bytes of a packed file per row.
constexpr std::int64_t RecordingPartBytes = 4 << 20;

// The bytes that the packed ones have unpacked, as they say; the largest number where these are
// more.
std::uint64_t UnpackedBytes(const std::vector<RecordingAsset>& assets);

// A hash as text, for messages.
std::string Hexadecimal(const std::string& bytes);

} // namespace dspace::session

#endif
