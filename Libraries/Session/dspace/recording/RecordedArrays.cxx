#include <dspace/recording/RecordedArrays.h>

#include <algorithm>

#include <dspace/messages/MeshMessages.h>
#include <dspace/messages/Sha256.h>
#include <dspace/recording/RecordingDatabase.h>

namespace dspace::session {
namespace {

constexpr std::size_t MostKept = 256u << 20;

} // namespace

void RecordedArrays::FillIn(v1::Command& command) {
  ForEachMesh(command, [this](v1::MeshData& mesh) {
    if (!HasArrays(mesh) && !PutArrays(this->Get(mesh.digest()), mesh)) {
      this->Reader_.Database().Damaged("the arrays of SHA-256 " + Hexadecimal(mesh.digest()) +
                                       " are not a MeshData message");
    }
  });
}

const std::string& RecordedArrays::Get(const std::string& digest) {
  const auto kept = this->Kept_.find(digest);
  if (kept != this->Kept_.end()) {
    return kept->second;
  }
  const RecordingDatabase& database = this->Reader_.Database();
  const RecordingDatabase::View view(database);
  if (this->Assets_.count(digest) == 0) {
    this->Reader_.ReadAssets(this->Seen_, [this](RecordingAsset&& asset) {
      this->Seen_ = std::max(this->Seen_, asset.id);
      if (IsArrays(asset) && asset.packed) {
        this->Assets_[asset.sha256] = std::move(asset);
      }
    });
    this->Parts_ = this->Reader_.Parts();
  }
  const auto found = this->Assets_.find(digest);
  const std::string named = "the arrays of SHA-256 " + Hexadecimal(digest);
  if (found == this->Assets_.end()) {
    database.Damaged(named + " are missing");
  }
  this->Reader_.RequireUnpackable(std::uint64_t(std::max<std::int64_t>(found->second.size, 0)));
  std::string bytes;
  this->Reader_.ReadContent(found->second, this->Parts_[found->second.id],
                            [&bytes](const std::string& part) { bytes += part; });
  Sha256 sum;
  sum.Add(bytes.data(), bytes.size());
  if (sum.Finish() != digest) {
    database.Damaged(named + " are damaged");
  }
  if (this->KeptBytes_ + bytes.size() > MostKept) {
    this->Kept_.clear();
    this->KeptBytes_ = 0;
  }
  this->KeptBytes_ += bytes.size();
  return this->Kept_[digest] = std::move(bytes);
}

} // namespace dspace::session
