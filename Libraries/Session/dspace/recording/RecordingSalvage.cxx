#include <dspace/recording/RecordingSalvage.h>

#include <algorithm>
#include <filesystem>
#include <limits>

#include <dspace/Error.h>
#include <dspace/recording/NewRecording.h>
#include <dspace/recording/RecordingDatabase.h>
#include <dspace/recording/RecordingPages.h>
#include <dspace/recording/RecordingReader.h>

namespace dspace::session {
namespace {

using Statement = RecordingDatabase::Statement;

// The snapshot that a recording says it begins with; 0 where that cannot be read. A recording of a
// newer format is rejected: its rows may mean something else.
std::uint64_t StatedBegin(const std::string& path) {
  try {
    return RecordingReader(path).Begin();
  } catch (const Error& error) {
    if (error.GetKind() == Error::Kind::Unsupported && RecordingReader::IsNewer(path)) {
      throw;
    }
    return 0; // damaged, as expected
  }
}

void Put(RecordingFile& file, RecordingRow& row, Sha256& sum) {
  row.time_s += 0.0; // SQLite keeps -0 as 0
  row.wall_s += 0.0;
  file.Put(row, RecordingChecksum(sum, row));
  file.CommitEach(row.payload.size());
}

void PutAll(const std::string& path, RecordingFile& file, ForeignRows& foreign,
            const CancelCheck& checkCancel) {
  Sha256 sum;
  file.Begin();
  FindRows(
      path,
      [&](FoundRow&& found) {
        if (auto* row = std::get_if<RecordingRow>(&found)) {
          if (row->snapshot || row->seq > 0) {
            foreign.Look(*row);
            Put(file, *row, sum);
          }
        } else if (const auto* asset = std::get_if<RecordingAsset>(&found)) {
          file.Put(*asset);
        } else {
          const auto& content = std::get<RecordingContent>(found);
          file.Put(content);
          file.CommitEach(content.data.size());
        }
      },
      checkCancel);
  file.Commit();
}

// Ranges of commands after `begin` to the last command or snapshot that are not there.
std::vector<std::pair<std::uint64_t, std::uint64_t>>
LostIn(const RecordingDatabase& found, std::uint64_t begin, std::uint64_t last) {
  std::vector<std::pair<std::uint64_t, std::uint64_t>> lost;
  std::uint64_t expected = begin + 1;
  Statement numbers(found, "SELECT seq FROM command ORDER BY seq");
  while (numbers.Step()) {
    const auto seq = std::uint64_t(numbers.Integer(0));
    if (seq > expected) {
      lost.emplace_back(expected, seq - 1);
    }
    expected = std::max(expected, seq + 1);
  }
  if (last >= expected) {
    lost.emplace_back(expected, last);
  }
  return lost;
}

// Packed files with incomplete content.
std::vector<RecordingAsset> BrokenIn(RecordingReader& found, const CancelCheck& checkCancel) {
  const RecordingReader::PartNumbers numbers = found.Parts();
  std::vector<RecordingAsset> broken;
  std::uint64_t unpacked = 0;
  found.ReadAssets(0, [&](RecordingAsset&& asset) {
    if (!asset.packed) {
      return;
    }
    const std::uint64_t bytes = UnpackedBytes({asset});
    unpacked += std::min(bytes, std::numeric_limits<std::uint64_t>::max() - unpacked);
    found.RequireUnpackable(unpacked);
    const auto parts = numbers.find(asset.id);
    try {
      found.ReadContent(asset, parts == numbers.end() ? std::vector<std::int64_t>() : parts->second,
                        [&](const std::string&) { checkCancel(); });
    } catch (const Error& error) {
      if (error.GetKind() != Error::Kind::Corrupt) {
        throw;
      }
      asset.packed = false;
      broken.push_back(std::move(asset));
    }
  });
  return broken;
}

// Numbers of files have no gaps, here and in the content of packed ones.
std::uint64_t UnknownIn(const RecordingDatabase& found) {
  const std::int64_t last = std::max(found.Number("SELECT max(id) FROM asset", 0),
                                     found.Number("SELECT max(asset) FROM content", 0));
  const std::int64_t count = found.Number("SELECT count(*) FROM asset WHERE id > 0", 0);
  return std::uint64_t(std::max<std::int64_t>(last - count, 0));
}

SalvageReport ReportOf(const RecordingDatabase& found, std::uint64_t begin) {
  const auto number = [&](const char* sql) { return std::uint64_t(found.Number(sql, 0)); };
  SalvageReport report;
  report.commands = number("SELECT count(*) FROM command");
  report.snapshots = number("SELECT count(*) FROM snapshot");
  report.assets = number("SELECT count(*) FROM asset");
  report.lastCommand = number("SELECT max(seq) FROM command");
  report.lastAsset = number("SELECT max(id) FROM asset");
  const auto has = [&](std::uint64_t seq) {
    return Statement(found, "SELECT 1 FROM snapshot WHERE seq = ?")
        .Bind(1, std::int64_t(seq))
        .Step();
  };
  const bool before = report.commands > 0 && number("SELECT min(seq) FROM command") <= begin;
  report.begin = has(begin) && !before ? begin : 0;
  report.beginLost = !has(report.begin);
  report.lost = LostIn(found, report.begin,
                       std::max(report.lastCommand, number("SELECT max(seq) FROM snapshot")));
  report.unknownAssets = UnknownIn(found);
  return report;
}

} // namespace

bool SalvageReport::IsComplete() const {
  return !this->beginLost && this->lost.empty() && this->broken.empty() && this->unknownAssets == 0;
}

SalvageReport SalvageRecording(const std::string& path, const std::string& out,
                               const CancelCheck& checkCancel, std::uint64_t unpackLimit) {
  const std::string whole = std::filesystem::absolute(path).string();
  std::error_code error;
  if (!std::filesystem::is_regular_file(whole, error)) {
    throw Error(Error::Kind::NotFound, RecordingName(whole),
                "there is no such file; accepted: a recording, a .dspace file");
  }
  const std::uint64_t begin = StatedBegin(whole);
  NewRecording made(out);
  SalvageReport report;
  {
    RecordingFile file(made);
    PutAll(whole, file, report.foreign, checkCancel);
    std::vector<RecordingAsset> broken;
    {
      RecordingReader found(made.Path());
      found.SetUnpackLimit(unpackLimit);
      ForeignRows foreign = std::move(report.foreign);
      report = ReportOf(found.Database(), begin);
      report.foreign = std::move(foreign);
      broken = BrokenIn(found, checkCancel);
    }
    if (report.commands + report.snapshots + report.assets == 0) {
      throw Error(Error::Kind::Corrupt, RecordingName(whole), "nothing in it can be recovered");
    }
    file.Begin();
    for (RecordingAsset& asset : broken) {
      file.Replace(asset);
      report.broken.push_back(std::move(asset.path));
    }
    if (report.begin != 0) {
      file.PutBegin(report.begin);
    }
    std::string ranges;
    for (const auto& [first, last] : report.lost) {
      ranges += (ranges.empty() ? "" : " ") + std::to_string(first) + "-" + std::to_string(last);
    }
    if (!ranges.empty()) {
      file.PutLost(ranges);
    }
    file.Commit();
    file.Finish();
  }
  made.Keep();
  return report;
}

} // namespace dspace::session
