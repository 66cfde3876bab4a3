#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/recording/Playback.h>

namespace dspace::session {
namespace {

using Range = std::pair<std::uint64_t, std::uint64_t>;

// Ranges of commands that are there, with none missing within one.
std::vector<Range> Blocks(RecordingReader& reader) {
  const std::uint64_t last = reader.Last();
  if (last == 0) { // a state and nothing after it
    const std::vector<std::uint64_t> snapshots = reader.Snapshots();
    const std::uint64_t seq = snapshots.empty() ? 0 : snapshots.back();
    return {{seq + 1, seq}};
  }
  const std::vector<Range> lost = reader.Lost();
  if (lost.empty()) {
    return {{reader.First(), last}};
  }
  std::vector<Range> blocks;
  std::uint64_t begin = 1;
  for (const auto& [first, end] : lost) {
    if (begin < first) {
      blocks.emplace_back(begin, first - 1);
    }
    begin = end + 1;
  }
  blocks.emplace_back(begin, std::max(last, begin - 1)); // empty: a snapshot is the last of all
  return blocks;
}

// Of doubles at a time [s], on the side away from 0.
double Spacing(double time_s) {
  const double size = std::abs(time_s);
  const double next = std::nextafter(size, std::numeric_limits<double>::infinity());
  return std::isfinite(next) ? next - size : size - std::nextafter(size, 0.0);
}

// How far the next step of another time in the same run is, on (1) or back (-1).
std::optional<double> Distance(const std::vector<PlaybackStep>& steps, std::size_t index,
                               int direction) {
  const double time_s = steps[index].time_s;
  auto other = std::ptrdiff_t(index);
  do {
    other += direction;
    if (other < 0 || std::size_t(other) >= steps.size()) {
      return {};
    }
  } while (steps[std::size_t(other)].time_s == time_s);
  const double distance = (steps[std::size_t(other)].time_s - time_s) * direction;
  return distance > 0.0 ? std::optional<double>(distance) : std::nullopt;
}

} // namespace

PlaybackSteps StepsOf(RecordingReader& reader) {
  PlaybackSteps result;
  // In this order: of one that is being written each sees more than the one before, and what is
  // beyond the last block is left out.
  const std::vector<Range> blocks = Blocks(reader);
  const std::vector<std::uint64_t> snapshots = reader.Snapshots();
  const auto times = reader.Steps();
  PlaybackGap gap; // that is open
  gap.first = reader.Lost().empty() ? blocks.front().first : 1;
  bool open = false;
  for (std::size_t number = 0; number < blocks.size(); ++number) {
    const auto [a, b] = blocks[number];
    const auto place = std::lower_bound(snapshots.begin(), snapshots.end(), a - 1);
    if (place == snapshots.end() || *place > std::max(b, a - 1)) {
      open = true; // no state to begin with
      continue;
    }
    const RecordedSnapshot base = reader.SnapshotAt(*place);
    open = open || base.seq > a - 1;
    std::vector<std::pair<std::uint64_t, double>> inside; // first command of a step, and its time
    for (const auto& step : times) {
      if (step.first > base.seq && step.first <= b) {
        inside.push_back(step);
      }
    }
    // What was there and done before time was first set, or after what is lost.
    if (open || number > 0 || !base.commands.empty() || inside.empty() ||
        inside.front().first > base.seq + 1) {
      inside.insert(inside.begin(), {base.seq + 1, base.time_s});
    }
    std::vector<PlaybackStep> found;
    for (std::size_t i = 0; i < inside.size(); ++i) {
      found.push_back({inside[i].second, i + 1 < inside.size() ? inside[i + 1].first - 1 : b});
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
      gap.first = b + 1;
    }
    open = (open && !any) || cut;
  }
  if (open) {
    gap.last = std::max(reader.Last(), snapshots.empty() ? 0 : snapshots.back());
    gap.end_s.reset();
    gap.before = result.steps.size();
    result.gaps.push_back(gap);
  }
  return result;
}

double Rounding(double time_s, double step_s) {
  return std::max(std::min(1e-3 * step_s, 1e-4), std::min(2.0 * Spacing(time_s), 0.5 * step_s));
}

bool IsAt(const std::vector<PlaybackStep>& steps, std::size_t index, double time_s) {
  const double own = steps[index].time_s;
  const int side = own > time_s ? -1 : 1;
  std::optional<double> step = Distance(steps, index, side);
  step = step ? step : Distance(steps, index, -side);
  return std::abs(own - time_s) <= (step ? Rounding(own, *step) : 2.0 * Spacing(own));
}

std::optional<std::size_t> StepAt(const std::vector<PlaybackStep>& steps, double time_s) {
  std::optional<std::size_t> begun;
  for (std::size_t end = steps.size(); end > 0;) { // runs, the last one first
    std::size_t begin = end - 1;
    while (begin > 0 && steps[begin - 1].time_s <= steps[begin].time_s) {
      --begin;
    }
    if (steps[begin].time_s <= time_s || IsAt(steps, begin, time_s)) {
      if (time_s <= steps[end - 1].time_s || IsAt(steps, end - 1, time_s)) {
        const auto after = [&](double at_s) {
          const auto found = std::upper_bound(
              steps.begin() + std::ptrdiff_t(begin), steps.begin() + std::ptrdiff_t(end), at_s,
              [](double time, const PlaybackStep& step) { return time < step.time_s; });
          return std::size_t(found - steps.begin());
        };
        std::size_t following = after(time_s);
        if (following < end && IsAt(steps, following, time_s)) {
          following = after(steps[following].time_s);
        }
        return following - 1;
      }
      begun = begun ? begun : end - 1;
    }
    end = begin;
  }
  return begun;
}

} // namespace dspace::session
