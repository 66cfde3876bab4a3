#include <dspace/recording/RecordingCheck.h>

#include <limits>

#include <dspace/recording/RecordingDatabase.h>
#include <dspace/recording/RecordingFile.h>

namespace dspace::session {

ForeignRows CheckRecording(RecordingReader& reader, const CancelCheck& checkCancel) {
  const RecordingDatabase::View view(reader.Database());
  ForeignRows foreign;
  const auto seen = [&](const RecordingRow& row) {
    checkCancel();
    foreign.Look(row);
    return true;
  };
  std::uint64_t first = reader.First();
  for (const auto& [lost, end] : reader.Lost()) {
    reader.ReadRows(first, lost - 1, seen);
    first = end + 1;
  }
  reader.ReadRows(first, reader.Last(), seen);
  reader.ReadSnapshots(0, std::numeric_limits<std::uint64_t>::max(), seen);
  const RecordingReader::PartNumbers numbers = reader.Parts();
  const std::vector<RecordingAsset> assets = reader.Assets();
  reader.RequireUnpackable(UnpackedBytes(assets));
  for (const RecordingAsset& asset : assets) {
    if (asset.packed) {
      const auto parts = numbers.find(asset.id);
      reader.ReadContent(asset,
                         parts == numbers.end() ? std::vector<std::int64_t>() : parts->second,
                         [&](const std::string&) { checkCancel(); });
    }
  }
  RecordingDatabase::Statement sound(reader.Database(), "PRAGMA integrity_check(1)");
  if (!sound.Step() || sound.Bytes(0) != "ok") {
    reader.Database().Damaged(sound.Bytes(0));
  }
  return foreign;
}

} // namespace dspace::session
