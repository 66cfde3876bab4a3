#include <dspace/recording/PlaybackSteps.h>

#include <algorithm>

#include <dspace/Error.h>
#include <dspace/recording/RecordingDatabase.h>
#include <dspace/recording/RecordingFile.h>

namespace dspace::session {
namespace {

// First a step for what was there and done between a snapshot and the first time that was set;
// `any`: something was there.
void PutFirstStep(std::vector<std::pair<std::uint64_t, double>>& begins, const RecordingRow& base,
                  bool any) {
  if (any || begins.empty() || begins.front().first > base.seq + 1) {
    begins.insert(begins.begin(), {base.seq + 1, base.time_s});
  }
}

} // namespace

std::vector<PlaybackBlock> BlocksOf(RecordingReader& reader) {
  const RecordingDatabase::View view(reader.Database());
  const std::vector<std::uint64_t> snapshots = reader.Snapshots();
  const std::uint64_t last = reader.Last();
  std::vector<PlaybackBlock> blocks;
  const auto put = [&](std::uint64_t first, std::uint64_t end) {
    const auto place = std::lower_bound(snapshots.begin(), snapshots.end(), first - 1);
    const bool any = place != snapshots.end() && *place <= std::max(end, first - 1);
    blocks.push_back({first, end, any ? std::optional<std::uint64_t>(*place) : std::nullopt});
  };
  if (last == 0) { // a state and nothing after it
    const std::uint64_t seq = snapshots.empty() ? 0 : snapshots.back();
    put(seq + 1, seq);
    return blocks;
  }
  const auto lost = reader.Lost();
  std::uint64_t begin = lost.empty() ? reader.First() : 1;
  for (const auto& [first, end] : lost) {
    if (begin < first) {
      put(begin, first - 1);
    }
    begin = end + 1;
  }
  put(begin, std::max(last, begin - 1)); // empty: a snapshot is the last of all
  return blocks;
}

std::vector<std::pair<std::uint64_t, double>> StepBegins(RecordingReader& reader) {
  const RecordingDatabase::View view(reader.Database());
  std::vector<std::pair<std::uint64_t, double>> begins = reader.Steps();
  const std::vector<std::uint64_t> snapshots = reader.Snapshots();
  if (!snapshots.empty()) {
    const RecordingRow base = reader.SnapshotRow(snapshots.front());
    PutFirstStep(begins, base, !base.payload.empty());
  }
  return begins;
}

void RejectNoSteps(RecordingReader& reader) {
  if (reader.Last() != 0 || !reader.Snapshots().empty()) {
    throw Error(Error::Kind::Corrupt, RecordingName(reader.Path()), "it has no complete step");
  }
  throw Error(Error::Kind::NotFound, RecordingName(reader.Path()),
              "it holds no steps yet: no command and no state, and " +
                  std::to_string(reader.Assets().size()) +
                  " notes of files; its recording was just begun, or its process ended then; "
                  "accepted: a recording with a first state");
}

PlaybackSteps StepsOf(RecordingReader& reader, const std::optional<std::string>& scene) {
  const RecordingDatabase::View view(reader.Database());
  PlaybackSteps result;
  const std::vector<PlaybackBlock> blocks = BlocksOf(reader);
  const auto times = reader.Steps(scene);
  PlaybackGap gap; // that is open
  gap.first = reader.Lost().empty() ? blocks.front().first : 1;
  bool open = false;
  for (std::size_t number = 0; number < blocks.size(); ++number) {
    const PlaybackBlock& block = blocks[number];
    if (!block.snapshot) {
      open = true; // no state to begin with
      continue;
    }
    const RecordingRow base = reader.SnapshotRow(*block.snapshot);
    open = open || base.seq > block.first - 1;
    // The first command of a step, and its time.
    const auto after = [](std::uint64_t seq, const auto& step) { return seq < step.first; };
    const auto begin = std::upper_bound(times.begin(), times.end(), base.seq, after);
    const auto end = std::upper_bound(begin, times.end(), std::max(block.last, base.seq), after);
    std::vector<std::pair<std::uint64_t, double>> inside(begin, end);
    // After lost commands it is unknown whether the step is complete.
    PutFirstStep(inside, base, open || number > 0 || !base.payload.empty());
    std::vector<PlaybackStep> found;
    for (std::size_t i = 0; i < inside.size(); ++i) {
      found.push_back(
          {inside[i].second, i + 1 < inside.size() ? inside[i + 1].first - 1 : block.last});
    }
    std::optional<double> cut; // the time of a step that may lack commands
    if (number + 1 < blocks.size()) {
      cut = found.back().time_s;
      found.pop_back();
    }
    const bool any = !found.empty();
    if (any) {
      if (open) {
        gap.last = base.seq;
        gap.end_s = found.front().time_s;
        gap.before = result.steps.size();
        result.gaps.push_back(gap);
      }
      result.steps.insert(result.steps.end(), found.begin(), found.end());
    }
    if (cut && (any || !open)) {
      gap = {};
      gap.begin_s = cut;
      gap.first = block.last + 1;
    }
    open = (open && !any) || cut;
  }
  if (open) {
    const std::vector<std::uint64_t> snapshots = reader.Snapshots();
    gap.last = std::max(reader.Last(), snapshots.empty() ? 0 : snapshots.back());
    gap.end_s.reset();
    gap.before = result.steps.size();
    result.gaps.push_back(gap);
  }
  return result;
}

} // namespace dspace::session
