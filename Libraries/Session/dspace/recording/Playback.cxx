#include <dspace/recording/Playback.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <sstream>
#include <thread>
#include <utility>

#include <dspace/Error.h>
#include <dspace/messages/CommandTraits.h>
#include <dspace/recording/RecordingDatabase.h>

namespace dspace::session {
namespace {

constexpr double LongestWait = 0.002; // [s]

std::string Seconds(double time_s) {
  std::ostringstream text;
  text << time_s << " s";
  return text.str();
}

} // namespace

PlaybackSources PlaybackSources::Read(RecordingReader& reader, bool checkFiles,
                                      CancelCheck checkCancel) {
  PlaybackSources sources;
  sources.steps = StepsOf(reader);
  if (sources.steps.steps.empty()) {
    RejectNoSteps(reader);
  }
  if (checkCancel) {
    checkCancel();
  }
  sources.files = std::make_unique<RecordedFiles>(reader, checkFiles, std::move(checkCancel));
  return sources;
}

Playback::Playback(RecordingReader& reader, Interpreter& interpreter, PlaybackSources sources,
                   PlaybackGuests guests)
    : Reader_(reader), Interpreter_(interpreter), Steps_(std::move(sources.steps)),
      Files_(std::move(sources.files)), Guests_(std::move(guests)) {
  this->SetSteps();
  this->Aim(0);
}

Playback::Playback(RecordingReader& reader, Interpreter& interpreter, bool checkFiles)
    : Playback(reader, interpreter, PlaybackSources::Read(reader, checkFiles), {}) {
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
  this->Files_->Update();
  return this->Steps_.steps.size() - before;
}

void Playback::MoveTo(std::size_t index) {
  this->Aim(index);
  while (!this->Continue(std::numeric_limits<double>::infinity())) {
  }
}

void Playback::Aim(std::size_t index) {
  if (index >= this->Steps_.steps.size()) {
    throw Error(Error::Kind::InvalidArgument, RecordingName(this->Reader_.Path()),
                "the step is " + std::to_string(index) + "; accepted: 0 to " +
                    std::to_string(this->Steps_.steps.size() - 1));
  }
  if (this->Aim_ != index) {
    this->Aim_ = index;
    this->Reached_s_.reset();
  }
  const std::uint64_t target = this->Steps_.steps[index].end;
  if (this->Base_ && this->SnapshotOnTheWay(target) != this->Base_->seq) {
    this->Base_.reset(); // half of it is there
  }
}

std::optional<std::uint64_t> Playback::SnapshotOnTheWay(std::uint64_t target) {
  if (this->At_ == target) {
    return {};
  }
  const std::vector<std::uint64_t> snapshots = this->Reader_.Snapshots();
  const auto after = std::upper_bound(snapshots.begin(), snapshots.end(), target);
  const std::uint64_t last = after == snapshots.begin() ? 0 : *std::prev(after);
  const bool nearer = after != snapshots.begin() && this->At_ && last > *this->At_;
  return !this->At_ || target < *this->At_ || nearer ? std::optional<std::uint64_t>(last)
                                                     : std::nullopt;
}

bool Playback::Continue(double seconds) {
  if (!this->Aim_) {
    return true;
  }
  const std::size_t index = *this->Aim_;
  try {
    if (!this->Proceed(this->Steps_.steps[index].end, seconds)) {
      return false;
    }
    this->CheckStep(index, this->Reached_s_);
  } catch (...) {
    this->Aim_.reset();
    this->Base_.reset();
    this->Ahead_.reset();
    throw;
  }
  this->Index_ = index;
  this->Aim_.reset();
  if (this->Guests_.arrived) {
    this->Guests_.arrived();
  }
  return true;
}

bool Playback::Proceed(std::uint64_t target, double seconds) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  const auto late = [&] {
    return std::chrono::duration<double>(Clock::now() - began).count() >= seconds;
  };
  // A slice waits for files no longer than this [s]: its thread has other things to do.
  const double wait = std::isinf(seconds) ? seconds : std::min(seconds, LongestWait);
  if (!this->Base_ && this->SnapshotOnTheWay(target)) {
    this->Begin(target);
  }
  if (this->Base_) {
    const std::vector<v1::Command>& commands = this->Base_->commands;
    this->NoteForeign(this->Base_->foreignText, "snapshot ", this->Base_->seq);
    while (this->BaseDone_ < commands.size()) {
      if (!this->Execute(commands[this->BaseDone_], "snapshot ", this->Base_->seq, wait)) {
        return false;
      }
      ++this->BaseDone_;
      if (late() && this->BaseDone_ < commands.size()) {
        return false;
      }
    }
    this->At_ = this->Base_->seq;
    this->Reached_s_ = this->Base_->time_s;
    this->Base_.reset();
    if (this->Guests_.afterSnapshot) {
      this->Guests_.afterSnapshot();
    }
  }
  std::uint64_t at = *this->At_;
  bool stopped = false;
  if (target > at) {
    this->At_.reset(); // unknown, if one of these fails
    this->Reader_.Read(at + 1, target, [&](RecordedCommand&& row) {
      this->NoteForeign(row.foreignText, "command ", row.seq);
      if (!this->Execute(std::move(row.command), "command ", row.seq, wait)) {
        stopped = true;
        return false;
      }
      at = row.seq;
      this->Reached_s_ = row.time_s;
      stopped = late();
      return !stopped;
    });
    this->At_ = at;
  }
  if (at != target && !stopped) { // rows out of order, or a row that is not there
    throw Error(Error::Kind::Corrupt, RecordingName(this->Reader_.Path()),
                "no commands lead to command " + std::to_string(target) +
                    ", at which a step ends; they end at " + std::to_string(at));
  }
  return at == target && this->HasOverviews(wait);
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

// Removes everything; the commands of the snapshot follow.
void Playback::Begin(std::uint64_t target) {
  RecordedSnapshot snapshot = this->Reader_.SnapshotAt(target);
  this->At_.reset();
  this->Building_.reset();
  if (this->Guests_.beforeSnapshot) {
    this->Guests_.beforeSnapshot();
  }
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
    this->Execute(std::move(command), "before snapshot ", snapshot.seq, 0.0);
  }
  for (const std::string& name : scenes) {
    v1::Command command;
    command.set_scene(name);
    command.mutable_remove_scene();
    this->Execute(std::move(command), "before snapshot ", snapshot.seq, 0.0);
  }
  this->Base_ = std::move(snapshot);
  this->BaseDone_ = 0;
}

bool Playback::Execute(v1::Command command, const char* table, std::uint64_t seq, double seconds) {
  const Registry::Entry* entry = this->Interpreter_.Commands().Find(command.command_case());
  const FilesGuard guard(this->Files_->Look());
  if (!this->HasOverviews(seconds)) {
    return false;
  }
  std::string rejected;
  if (entry && entry->effect != Effect::Change) {
    rejected =
        "command " + CommandName(command) + ": it changes nothing; recordings contain only changes";
  } else {
    this->Files_->Map(command);
    this->Files_->FillIn(command);
    if (!this->IsReady(command, seconds)) {
      return false;
    }
    if (command.has_remove_scene() && this->Guests_.makeRoom) {
      this->Guests_.makeRoom(command);
    }
    const bool isRead = this->Ahead_ && this->AheadOf_ == command.SerializeAsString();
    const std::optional<CommandAhead> ahead =
        isRead ? std::exchange(this->Ahead_, std::nullopt) : std::nullopt;
    rejected = (ahead ? ahead->execute() : this->Interpreter_.Execute(command)).error().message();
    if (!rejected.empty() && this->Guests_.makeRoom && this->Guests_.makeRoom(command)) {
      rejected = this->Interpreter_.Execute(command).error().message();
    }
  }
  if (!rejected.empty()) {
    throw Error(Error::Kind::Corrupt, RecordingName(this->Reader_.Path()),
                table + std::to_string(seq) + " is rejected: " + rejected);
  }
  if (command.has_open_terrain() && !this->Files_->Folder().empty()) {
    this->Building_.emplace();
    this->Building_->set_scene(command.scene());
    this->Building_->mutable_describe_terrain()->set_terrain(command.open_terrain().name());
  }
  return true;
}

// Whether its files are read, as far as another thread reads them. A read that an earlier aim began
// is used if it is for the same command. Else it may finish beside the new one, but a third one
// waits.
bool Playback::IsReady(const v1::Command& command, double seconds) {
  const CommandTraits* traits = CommandTraits::Find(command.command_case());
  if (!this->Guests_.readAhead || !traits || !traits->ReadsFiles()) {
    return true;
  }
  std::string wanted = command.SerializeAsString();
  if (!this->Ahead_ || this->AheadOf_ != wanted) {
    if (this->Left_ && !this->Left_->isRead(seconds)) {
      return false;
    }
    this->Left_ = std::exchange(this->Ahead_, std::nullopt);
    this->Ahead_ = this->Guests_.readAhead(command, this->Files_->Look());
    this->AheadOf_ = std::move(wanted);
  }
  return !this->Ahead_ || this->Ahead_->isRead(seconds);
}

// Each row once, however often it is executed.
void Playback::NoteForeign(bool foreign, const char* table, std::uint64_t seq) {
  constexpr std::size_t Most = 1000;
  if (foreign && this->Foreign_.size() < Most &&
      this->Foreign_.insert(table + std::to_string(seq)).second) {
    this->Notes_.push_back(RecordingName(this->Reader_.Path()) + ": " + table +
                           std::to_string(seq) + ForeignTextNote);
  }
}

std::vector<std::string> Playback::TakeNotes() {
  return std::exchange(this->Notes_, {});
}

// Large rasters were drawn from their overviews, which are rebuilt beside the unpacked file.
bool Playback::HasOverviews(double seconds) {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point began = Clock::now();
  while (this->Building_ &&
         this->Interpreter_.Execute(*this->Building_).terrain().overview_build() ==
             v1::TerrainReply::BUILDING) {
    if (std::chrono::duration<double>(Clock::now() - began).count() >= seconds) {
      return false;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
  this->Building_.reset();
  return true;
}

} // namespace dspace::session
