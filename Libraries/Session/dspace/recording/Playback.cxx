#include <dspace/recording/Playback.h>

#include <algorithm>
#include <chrono>
#include <sstream>
#include <thread>

#include <dspace/Error.h>
#include <dspace/recording/RecordingDatabase.h>

namespace dspace::session {
namespace {

std::string Seconds(double time_s) {
  std::ostringstream text;
  text << time_s << " s";
  return text.str();
}

} // namespace

Playback::Playback(RecordingReader& reader, Interpreter& interpreter, bool checkFiles)
    : Reader_(reader), Interpreter_(interpreter), Steps_(StepsOf(reader)),
      Files_(reader, checkFiles) {
  if (this->Steps_.steps.empty()) {
    throw Error(Error::Kind::Corrupt, RecordingName(reader.Path()), "it has no complete step");
  }
  this->SetSteps();
  this->MoveTo(0);
}

void Playback::SetSteps() {
  std::vector<double> times_s;
  for (const PlaybackStep& step : this->Steps_.steps) {
    times_s.push_back(step.time_s);
  }
  this->Times_ = StepTimes(std::move(times_s));
}

double Playback::Seek(double time_s) {
  const std::vector<PlaybackStep>& steps = this->Steps_.steps;
  const std::optional<std::size_t> index = this->Times_.IndexAt(time_s);
  if (!index) {
    double first = steps.front().time_s;
    for (const PlaybackStep& step : steps) {
      first = std::min(first, step.time_s);
    }
    throw Error(Error::Kind::InvalidArgument, RecordingName(this->Reader_.Path()),
                "the time is " + Seconds(time_s) + "; accepted: " + Seconds(first) + " on");
  }
  for (const PlaybackGap& gap : this->Steps_.gaps) {
    if (gap.before == *index + 1 && gap.begin_s &&
        time_s >= *gap.begin_s -
                      StepTimes::Rounding(*gap.begin_s,
                                          std::max(*gap.begin_s - steps[*index].time_s, 0.0))) {
      throw Error(Error::Kind::Corrupt, RecordingName(this->Reader_.Path()),
                  "at " + Seconds(time_s) + " its commands are lost: " + Seconds(*gap.begin_s) +
                      " to " + (gap.end_s ? Seconds(*gap.end_s) : "the end"));
    }
  }
  this->MoveTo(*index);
  return this->Time();
}

std::int64_t Playback::Step(std::int64_t n) {
  const auto before = std::int64_t(this->Index_);
  const auto last = std::int64_t(this->Steps_.steps.size()) - 1;
  const std::int64_t to = n > last - before ? last : std::max<std::int64_t>(before + n, 0);
  this->MoveTo(std::size_t(to));
  return to - before;
}

std::size_t Playback::Update() {
  const std::size_t before = this->Steps_.steps.size();
  this->Steps_ = StepsOf(this->Reader_);
  this->SetSteps();
  this->Files_.Update();
  return this->Steps_.steps.size() - before;
}

void Playback::MoveTo(std::size_t index) {
  const std::uint64_t target = this->Steps_.steps[index].end;
  std::optional<double> reached_s;
  if (!this->At_ || target != *this->At_) {
    const std::vector<std::uint64_t> snapshots = this->Reader_.Snapshots();
    const auto after = std::upper_bound(snapshots.begin(), snapshots.end(), target);
    const bool nearer = after != snapshots.begin() && this->At_ && *std::prev(after) > *this->At_;
    if (!this->At_ || target < *this->At_ || nearer) {
      const RecordedSnapshot snapshot = this->Reader_.SnapshotAt(target);
      this->Begin(snapshot);
      reached_s = snapshot.time_s;
    }
    std::uint64_t at = *this->At_;
    this->At_.reset(); // unknown, if one of these fails
    if (target > at) {
      this->Reader_.Read(at + 1, target, [&](RecordedCommand&& row) {
        this->Execute(std::move(row.command), "command ", row.seq);
        at = row.seq;
        reached_s = row.time_s;
        return true;
      });
    }
    this->At_ = at;
  }
  this->CheckStep(index, reached_s);
  this->Index_ = index;
}

// Steps are found by an index that has no checksums; the rows that it leads to have.
void Playback::CheckStep(std::size_t index, std::optional<double> reached_s) {
  const std::vector<PlaybackStep>& steps = this->Steps_.steps;
  bool good = !reached_s || *reached_s == steps[index].time_s;
  const std::uint64_t following = steps[index].end + 1;
  if (good && index + 1 < steps.size()) {
    this->Reader_.Read(following, following, [&](RecordedCommand&& row) {
      good = row.command.has_set_time() &&
             (row.time_s == steps[index + 1].time_s ||
              std::any_of(this->Steps_.gaps.begin(), this->Steps_.gaps.end(),
                          [&](const PlaybackGap& gap) { return gap.before == index + 1; }));
      return true;
    });
  }
  if (!good) {
    throw Error(Error::Kind::Corrupt, RecordingName(this->Reader_.Path()),
                "its index of times is damaged near command " + std::to_string(following));
  }
}

void Playback::Begin(const RecordedSnapshot& snapshot) {
  this->At_.reset();
  std::vector<std::string> viewports, scenes;
  for (const auto& entry : this->Interpreter_.GetState().viewports) {
    viewports.push_back(entry.first);
  }
  for (const auto& entry : this->Interpreter_.GetState().scenes) {
    scenes.push_back(entry.first);
  }
  for (const std::string& name : viewports) {
    v1::Command command;
    command.mutable_remove_viewport()->set_viewport(name);
    this->Execute(std::move(command), "before snapshot ", snapshot.seq);
  }
  for (const std::string& name : scenes) {
    v1::Command command;
    command.set_scene(name);
    command.mutable_remove_scene();
    this->Execute(std::move(command), "before snapshot ", snapshot.seq);
  }
  for (const v1::Command& command : snapshot.commands) {
    this->Execute(command, "snapshot ", snapshot.seq);
  }
  this->At_ = snapshot.seq;
}

void Playback::Execute(v1::Command command, const char* table, std::uint64_t seq) {
  const Registry::Entry* entry = this->Interpreter_.Commands().Find(command.command_case());
  const FilesGuard guard(this->Files_.Look());
  std::string rejected;
  if (entry && entry->effect != Effect::Change) {
    rejected =
        "command " + CommandName(command) + ": it changes nothing; recordings contain only changes";
  } else {
    this->Files_.Map(command);
    this->Files_.FillIn(command);
    rejected = this->Interpreter_.Execute(command).error().message();
  }
  if (!rejected.empty()) {
    throw Error(Error::Kind::Corrupt, RecordingName(this->Reader_.Path()),
                table + std::to_string(seq) + " is rejected: " + rejected);
  }
  if (command.has_open_terrain() && !this->Files_.Folder().empty()) {
    this->WaitForOverviews(command);
  }
}

// Large rasters were drawn from their overviews, which are rebuilt beside the unpacked file.
void Playback::WaitForOverviews(const v1::Command& opened) {
  v1::Command ask;
  ask.set_scene(opened.scene());
  ask.mutable_describe_terrain()->set_terrain(opened.open_terrain().name());
  while (this->Interpreter_.Execute(ask).terrain().overview_build() == v1::TerrainReply::BUILDING) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
}

} // namespace dspace::session
