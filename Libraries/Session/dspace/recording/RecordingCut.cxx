#include <dspace/recording/RecordingCut.h>

#include <dspace/recording/NewRecording.h>
#include <dspace/recording/RecordingDatabase.h>
#include <dspace/recording/RecordingFile.h>

namespace dspace::session {

std::uint64_t CutRecording(RecordingReader& reader, const std::string& out, std::uint64_t first,
                           std::uint64_t last, const CancelCheck& checkCancel) {
  const RecordingDatabase::View view(reader.Database());
  NewRecording made(out);
  std::uint64_t begin = 0;
  {
    RecordingFile file(made);
    Sha256 sum;
    const auto put = [&](const RecordingRow& row) {
      checkCancel();
      file.Put(row, RecordingChecksum(sum, row));
      file.CommitEach(row.payload.size());
      return true;
    };
    file.Begin();
    const RecordingRow snapshot = reader.SnapshotRow(first > 0 ? first - 1 : 0);
    begin = snapshot.seq;
    if (begin != 0) {
      file.PutBegin(begin);
    }
    put(snapshot);
    if (last > begin) {
      reader.ReadRows(begin + 1, last, put);
      reader.ReadSnapshots(begin + 1, last, put);
    }
    reader.ReadAssets(0, [&](RecordingAsset&& asset) { file.Put(asset); });
    reader.ReadParts([&](RecordingContent&& part) {
      checkCancel();
      file.Put(part);
      file.CommitEach(part.data.size());
    });
    file.Commit();
    file.Finish();
  }
  made.Keep();
  return begin;
}

} // namespace dspace::session
