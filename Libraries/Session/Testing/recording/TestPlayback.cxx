// Recordings read and carried out again: against what was given to the writer, and against an
// interpreter that was given the same commands from the start.
#include <algorithm>
#include <atomic>
#include <cmath>
#include <fstream>
#include <random>
#include <sstream>
#include <thread>

#include <sqlite3.h>

#include <dspace/recording/Playback.h>
#include <dspace/recording/RecordingFile.h>
#include <dspace/recording/RecordingWriter.h>

#include "CommandTestSupport.h"
#include "RecordingRows.h"

namespace dspace::testing {
namespace {

using session::Interpreter;
using session::Ledger;
using session::PlaybackGap;
using session::PlaybackStep;
using session::RecordedCommand;
using session::RecordingReader;
using session::StepTimes;

v1::Command Time(double time_s) {
  v1::Command command;
  command.mutable_set_time()->set_time_s(time_s);
  return command;
}

class PlaybackOf : public CommandTest {
protected:
  void Remove() {
    for (const char* end : {"", "-wal", "-shm"}) {
      std::remove((this->Path_ + end).c_str());
    }
  }
  void Change(const char* sql) {
    sqlite3* database = nullptr;
    ASSERT_EQ(sqlite3_open(this->Path_.c_str(), &database), SQLITE_OK);
    EXPECT_EQ(sqlite3_exec(database, sql, nullptr, nullptr, nullptr), SQLITE_OK)
        << sqlite3_errmsg(database);
    sqlite3_close(database);
  }

  // A frame that moves and frames that come, a time each (absent: every 0.5 s): recorded, with the
  // commands as they were accepted.
  std::vector<v1::Command> Drive(int steps, std::uint64_t snapshotCommands,
                                 const std::vector<double>& times = {}) {
    std::vector<v1::Command> accepted;
    Interpreter interpreter;
    Ledger ledger(&interpreter.GetState());
    session::RecordingOptions options;
    options.snapshotCommands = snapshotCommands;
    session::RecordingWriter writer(this->Path_, ledger, 0.0, options);
    interpreter.AddListener([&](const v1::Command& command, const v1::Reply& reply) {
      ledger.Add(command, reply);
      EXPECT_EQ(writer.Add(command, reply, ledger), "");
      accepted.push_back(command);
    });
    const auto run = [&](v1::Command command) {
      const v1::Reply reply = interpreter.Execute(command);
      EXPECT_FALSE(reply.has_error()) << reply.error().message();
    };
    v1::Command scene;
    scene.mutable_create_scene();
    run(scene);
    for (int i = 0; i < steps; ++i) {
      run(Time(times.empty() ? 0.5 * i : times[std::size_t(i)]));
      v1::Command frame;
      frame.mutable_create_frame()->set_name("f" + std::to_string(i));
      run(frame);
    }
    return accepted;
  }

  const TemporaryFolder Folder_;
  const std::string Path_ = this->Folder_ / "playback.dspace";
};

TEST_F(PlaybackOf, ReadsWhatWasAccepted) {
  const std::vector<v1::Command> accepted = this->Drive(40, 25);
  RecordingReader reader(this->Path_);
  EXPECT_EQ(reader.First(), 1u);
  ASSERT_EQ(reader.Last(), accepted.size());
  std::size_t count = 0;
  reader.Read(1, accepted.size(), [&](RecordedCommand&& row) {
    EXPECT_EQ(row.seq, count + 1);
    EXPECT_EQ(row.command.SerializeAsString(), accepted[count].SerializeAsString());
    ++count;
    return true;
  });
  EXPECT_EQ(count, accepted.size());
  reader.Read(5, 4, [](RecordedCommand&&) { return false; });
  EXPECT_GE(reader.Snapshots().size(), 3u);
  EXPECT_EQ(reader.Steps().size(), 40u);
}

// A movement in slices of one command each arrives where one piece does, from wherever it is, also
// when its aim changes on the way. Until then the step before is told.
TEST_F(PlaybackOf, SlicesArriveWhereOneMovementDoes) {
  this->Drive(40, 25);
  RecordingReader reader(this->Path_);
  Interpreter whole, sliced;
  session::Playback one(reader, whole);
  session::Playback other(reader, sliced);
  bool inSnapshot = false;
  int arrived = 0;
  session::PlaybackGuests guests;
  guests.beforeSnapshot = [&] { inSnapshot = true; };
  guests.afterSnapshot = [&] { inSnapshot = false; };
  guests.arrived = [&] { ++arrived; };
  other.SetGuests(guests);
  std::mt19937 random(5);
  int longest = 0;
  for (int round = 0; round < 60; ++round) {
    const std::size_t before = other.Index();
    if (round % 3 == 0) { // somewhere else first, for a while
      other.Aim(random() % 40);
      for (int i = int(random() % 5); i > 0 && !other.Continue(0.0); --i) {
      }
    }
    const std::size_t from = other.Index();
    const std::size_t to = random() % 40;
    other.Aim(to);
    int slices = 0;
    while (!other.Continue(0.0)) {
      EXPECT_TRUE(other.IsMoving());
      EXPECT_EQ(other.Index(), from) << before;
      ++slices;
    }
    longest = std::max(longest, slices);
    EXPECT_FALSE(other.IsMoving());
    EXPECT_FALSE(inSnapshot);
    one.Step(std::int64_t(to) - std::int64_t(one.Index()));
    EXPECT_EQ(other.Index(), to);
    EXPECT_EQ(other.Time(), one.Time());
    EXPECT_EQ(sliced.FindScene("scene")->Frames().Size(),
              whole.FindScene("scene")->Frames().Size());
    EXPECT_EQ(sliced.FindScene("scene")->Time(), one.Time());
  }
  EXPECT_GT(longest, 5);
  EXPECT_GE(arrived, 60);
  EXPECT_TRUE(other.Continue(0.0)); // nothing is left to do
  EXPECT_THROW(other.Aim(other.Steps().size()), Error);
}

// Every step, in a random order, is what the same commands make from the start.
TEST_F(PlaybackOf, AnyStepIsWhatItsCommandsMake) {
  const std::vector<v1::Command> accepted = this->Drive(40, 25);
  RecordingReader reader(this->Path_);
  Interpreter shown;
  session::Playback playback(reader, shown);
  std::mt19937 random(3);
  for (int round = 0; round < 60; ++round) {
    const int i = int(random() % 40);
    const double asked = 0.5 * i + (round % 2 ? 0.25 : 0.0);
    EXPECT_EQ(playback.Seek(asked), 0.5 * i);
    Interpreter expected;
    for (int k = 0; k < 3 + 2 * i; ++k) {
      v1::Command command = accepted[std::size_t(k)];
      ASSERT_FALSE(expected.Execute(command).has_error());
    }
    EXPECT_EQ(PictureOf(shown), PictureOf(expected)) << asked;
  }
  playback.Seek(0.0);
  EXPECT_EQ(playback.Step(3), 3);
  EXPECT_EQ(playback.Time(), 1.5);
  EXPECT_EQ(playback.Step(-2), -2);
  EXPECT_EQ(playback.Time(), 0.5);
  EXPECT_EQ(playback.Step(-100), -2); // the first step is what was before any time
  EXPECT_EQ(playback.Step(1000), 40);
  EXPECT_EQ(playback.Time(), 19.5);
}

// Times that a simulation adds up, as most do.
std::vector<double> AddedUp(int steps, double begin_s, double step_s) {
  std::vector<double> times = {begin_s};
  while (int(times.size()) < steps) {
    times.push_back(times.back() + step_s);
  }
  return times;
}

TEST_F(PlaybackOf, StepsThatWereAddedUpAreFound) {
  const std::vector<double> times = AddedUp(2000, 0.0, 0.001);
  ASSERT_GT(times[1000], 1.0);
  this->Drive(2000, 500, times);
  {
    RecordingReader reader(this->Path_);
    Interpreter shown;
    session::Playback playback(reader, shown);
    for (const int i : {1, 999, 1000, 1001, 1999, 1000, 3}) {
      EXPECT_EQ(playback.Seek(i / 1000.0), times[std::size_t(i)]); // its own time
      EXPECT_EQ(playback.Index(), std::size_t(i) + 1); // the first is what was before any time
    }
  }
  this->Change("DELETE FROM command WHERE seq = 2003"); // step 1000 lacks its frame
  this->Change("INSERT INTO meta VALUES('lost','2003-2003')");
  RecordingReader reader(this->Path_);
  Interpreter shown;
  session::Playback playback(reader, shown);
  EXPECT_EQ(playback.Seek(0.999), times[999]);
  try {
    playback.Seek(1.0);
    ADD_FAILURE() << "gave " << playback.Time();
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Corrupt);
  }
}

TEST_F(PlaybackOf, AnIndexOfTimesThatIsDamagedShowsNoWrongInstant) {
  this->Drive(10, 1000);
  // The row keeps its time and checksum; the index, which has none, has another time.
  this->Change("UPDATE command SET time = time + 100 WHERE seq = 8");
  this->Change("CREATE TABLE kept AS SELECT * FROM sqlite_master WHERE name = 'step';"
               "PRAGMA writable_schema = 1; DELETE FROM sqlite_master WHERE name = 'step'");
  this->Change("UPDATE command SET time = time - 100 WHERE seq = 8");
  this->Change("PRAGMA writable_schema = 1; INSERT INTO sqlite_master SELECT * FROM kept");
  this->Change("DROP TABLE kept");
  RecordingReader reader(this->Path_);
  Interpreter shown;
  session::Playback playback(reader, shown);
  for (const double time_s : {1.5, 1.7, 101.5}) { // the step is at 1.5 s
    try {
      playback.Seek(time_s);
      ADD_FAILURE() << time_s << " gave " << playback.Time();
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::Corrupt);
      EXPECT_NE(std::string(error.what()).find("index of times is damaged"), std::string::npos);
    }
  }
  EXPECT_EQ(playback.Seek(4.0), 4.0);
  EXPECT_EQ(playback.Seek(0.5), 0.5);
}

TEST_F(PlaybackOf, RejectsDamage) {
  this->Drive(10, 1000);
  this->Change("UPDATE command SET time = time + 1 WHERE seq = 7");
  const auto says = [&](const char* words, Error::Kind kind, const auto& run) {
    try {
      run();
      ADD_FAILURE() << words;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), kind);
      EXPECT_NE(std::string(error.what()).find(words), std::string::npos) << error.what();
    }
  };
  {
    RecordingReader reader(this->Path_);
    Interpreter shown;
    session::Playback playback(reader, shown);
    says("command 7 is damaged", Error::Kind::Corrupt, [&] { playback.Seek(4.0); });
    says("accepted: 0 s on", Error::Kind::InvalidArgument, [&] { playback.Seek(-1.0); });
  }
  this->Change("DELETE FROM command WHERE seq IN (7, 8)");
  {
    RecordingReader reader(this->Path_);
    says("7 to 8 are missing", Error::Kind::Corrupt,
         [&] { reader.Read(1, 20, [](RecordedCommand&&) { return true; }); });
  }
  this->Change("UPDATE meta SET value = 2 WHERE key = 'format'");
  says("format is 2", Error::Kind::Unsupported, [&] { RecordingReader reader(this->Path_); });
  says("no such file", Error::Kind::NotFound, [&] { RecordingReader reader("/none.dspace"); });
  const TemporaryFile text("text.dspace", std::string(5000, 'x'));
  says("not a recording: its first bytes are 'xxxxxxxxxxxxxxxx'", Error::Kind::Unsupported,
       [&] { RecordingReader reader(text.Path()); });
  const TemporaryFile empty("empty.dspace", "");
  says("not a recording: it is empty", Error::Kind::Unsupported,
       [&] { RecordingReader reader(empty.Path()); });
  this->Change("DROP TABLE meta; DROP TABLE command");
  says("without a recording's tables", Error::Kind::Unsupported,
       [&] { RecordingReader reader(this->Path_); });
}

// A search among rows that are out of order finds other snapshots than a list of them does.
TEST_F(PlaybackOf, SnapshotsOutOfOrderEndInAnError) {
  constexpr std::size_t Size = 512;
  this->Drive(40, 4);
  this->Change("PRAGMA journal_mode=DELETE; PRAGMA page_size=512; VACUUM");
  std::stringstream content;
  content << std::ifstream(this->Path_, std::ios::binary).rdbuf();
  const std::string bytes = content.str();
  std::size_t page = 0; // where the root of the snapshots begins
  {
    const Database file(this->Path_, SQLITE_OPEN_READONLY);
    file.Ask(
        "SELECT rootpage FROM sqlite_master WHERE name = 'snapshot'", {},
        [&](sqlite3_stmt* row) { page = std::size_t(sqlite3_column_int64(row, 0) - 1) * Size; });
  }
  ASSERT_EQ(bytes.at(page), 5) << "no inner page of a table";
  const auto number = [&](std::size_t at) {
    return std::size_t(std::uint8_t(bytes.at(at))) << 8 | std::uint8_t(bytes.at(at + 1));
  };
  const std::size_t cells = number(page + 3);
  ASSERT_GE(cells, 2u);
  int rejected = 0;
  for (std::size_t cell = 0; cell < cells; ++cell) {
    const std::size_t key = page + number(page + 12 + 2 * cell) + 4; // the greatest row of a child
    for (const char changed : {'\x01', '\x05', '\x7f'}) {
      std::string other = bytes;
      other.at(key) = changed;
      std::ofstream(this->Path_, std::ios::binary) << other;
      const auto rejects = [&](const auto& act) {
        try {
          act();
        } catch (const Error& error) {
          EXPECT_EQ(error.GetKind(), Error::Kind::Corrupt) << error.what();
          ++rejected;
        }
      };
      rejects([&] {
        RecordingReader reader(this->Path_);
        Interpreter shown;
        session::Playback playback(reader, shown);
        const auto steps = std::int64_t(playback.Steps().size());
        for (std::int64_t i = 0; i < steps; ++i) { // to the end, and back from it to each step
          rejects([&] { playback.Step(steps); });
          rejects([&] { playback.Step(-i); });
        }
      });
    }
  }
  EXPECT_GT(rejected, 0);
}

// Nor is a file damaged that another process holds.
TEST_F(PlaybackOf, ALockIsNoDamage) {
  this->Drive(3, 1000);
  RecordingReader reader(this->Path_);
  reader.SetTimeout(0.01);
  sqlite3* other = nullptr;
  ASSERT_EQ(sqlite3_open(this->Path_.c_str(), &other), SQLITE_OK);
  EXPECT_EQ(sqlite3_exec(other, "BEGIN EXCLUSIVE", nullptr, nullptr, nullptr), SQLITE_OK);
  try {
    reader.Last();
    ADD_FAILURE() << "it was read";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Io);
    EXPECT_NE(std::string(error.what()).find("locked"), std::string::npos) << error.what();
  }
  sqlite3_close(other);
  EXPECT_EQ(reader.Last(), 7u);
}

// Steps are of one moment: what comes while they are read belongs to no step before it.
TEST_F(PlaybackOf, StepsAreOfOneMoment) {
  std::atomic<bool> stop{false};
  session::RecordingOptions options;
  options.commitEvery_s = 0.001;
  options.snapshotCommands = 50;
  session::RecordingWriter writer(this->Path_, Ledger(), 0.0, options);
  ASSERT_EQ(writer.Flush(), ""); // the first state is there
  std::thread simulation([&] {
    for (int i = 1; !stop; ++i) {
      writer.Add(Time(i), {}, Ledger());
      writer.Add(v1::Command(), {}, Ledger());
      writer.Flush();
    }
  });
  std::size_t most = 0;
  for (int round = 0; round < 200 || most < 20; ++round) {
    RecordingReader reader(this->Path_);
    const session::PlaybackSteps found = session::StepsOf(reader);
    EXPECT_TRUE(found.gaps.empty());
    if (found.steps.empty()) {
      ADD_FAILURE() << "no step";
      break;
    }
    most = std::max(most, found.steps.size());
    for (std::size_t i = 1; i < found.steps.size(); ++i) {
      EXPECT_EQ(found.steps[i].time_s, found.steps[i - 1].time_s + 1.0);
      EXPECT_LE(found.steps[i].end, found.steps[i - 1].end + 2);
    }
    if (found.steps.back().end == 0) { // no command yet
      continue;
    }
    // The last command of the last step is of its time.
    const std::uint64_t end = found.steps.back().end;
    reader.ReadRows(end, end, [&](session::RecordingRow&& row) {
      EXPECT_EQ(row.time_s, found.steps.back().time_s);
      return true;
    });
  }
  stop = true;
  simulation.join();
}

// A recording of nothing but times, one a command, with states after some and without others.
class WholeSteps : public PlaybackOf {
protected:
  std::string Of(const std::vector<double>& times, const std::vector<int>& states,
                 const std::string& lost) {
    this->Remove();
    {
      session::RecordingWriter writer(this->Path_, Ledger(), 0.0);
      for (const double time : times) {
        writer.Add(Time(time), {}, Ledger());
      }
    }
    this->Change("DELETE FROM snapshot");
    for (const int seq : states) {
      session::RecordingRow row;
      row.snapshot = true;
      row.seq = std::uint64_t(seq);
      row.time_s = seq ? times[std::size_t(seq) - 1] : 0.0;
      std::string sum;
      for (const char c : session::RecordingChecksum(row)) {
        char digits[3];
        std::snprintf(digits, sizeof digits, "%02x", unsigned(static_cast<unsigned char>(c)));
        sum += digits;
      }
      this->Change(("INSERT INTO snapshot VALUES(" + std::to_string(seq) + "," +
                    std::to_string(row.time_s) + ",0,0,x'',x'" + sum + "')")
                       .c_str());
    }
    std::istringstream words(lost);
    for (std::string word; words >> word;) {
      const std::size_t dash = word.find('-');
      this->Change(("DELETE FROM command WHERE seq BETWEEN " + word.substr(0, dash) + " AND " +
                    word.substr(dash + 1))
                       .c_str());
    }
    if (!lost.empty()) {
      this->Change(("INSERT INTO meta VALUES('lost','" + lost + "')").c_str());
    }
    RecordingReader reader(this->Path_);
    const session::PlaybackSteps found = session::StepsOf(reader);
    std::ostringstream text;
    for (const PlaybackStep& step : found.steps) {
      text << step.time_s << ":" << step.end << " ";
    }
    for (const PlaybackGap& gap : found.gaps) {
      text << "[" << gap.first << "-" << gap.last << " ";
      gap.begin_s ? text << *gap.begin_s : text << "start";
      text << " to ";
      gap.end_s ? text << *gap.end_s : text << "end";
      text << " after " << gap.before << "]";
    }
    return text.str();
  }
};

// The same cases, by hand, as for the Python reader (test_recordings_damage.py).
TEST_F(WholeSteps, AfterLostCommandsTheNextStateGoesOn) {
  std::vector<double> times;
  for (int i = 1; i <= 10; ++i) {
    times.push_back(i);
  }
  EXPECT_EQ(this->Of(times, {0}, ""), "1:1 2:2 3:3 4:4 5:5 6:6 7:7 8:8 9:9 10:10 ");
  EXPECT_EQ(this->Of(times, {0, 6}, "4-5"), "1:1 2:2 6:6 7:7 8:8 9:9 10:10 [4-6 3 to 6 after 2]");
  EXPECT_EQ(this->Of(times, {0, 3}, "4-5"), "1:1 2:2 [4-10 3 to end after 2]");
  EXPECT_EQ(this->Of(times, {0, 9}, "3-3 7-8"), "1:1 9:9 10:10 [3-9 2 to 9 after 1]");
  EXPECT_EQ(this->Of(times, {0, 5, 9}, "3-3 7-8"),
            "1:1 5:5 9:9 10:10 [3-5 2 to 5 after 1][7-9 6 to 9 after 2]");
  EXPECT_EQ(this->Of(times, {4}, "1-2"), "4:4 5:5 6:6 7:7 8:8 9:9 10:10 [1-4 start to 4 after 0]");
  EXPECT_EQ(this->Of({}, {0}, ""), "0:0 ");
}

TEST(StepTimes, IsOfTheLatestRunThatReachesTheTime) {
  const StepTimes steps({0.0, 5.0, 10.0, 0.0, 3.0});
  const std::vector<std::pair<double, int>> expected = {{2, 3}, {3, 4},  {5, 1},
                                                        {7, 1}, {10, 2}, {11, 4}};
  for (const auto& [time, index] : expected) {
    EXPECT_EQ(steps.IndexAt(time), std::size_t(index)) << time;
  }
  EXPECT_FALSE(steps.IndexAt(-0.5));
  EXPECT_FALSE(steps.IndexAt(std::nan("")));
  EXPECT_EQ(StepTimes({1.0, 1.0, 1.0}).IndexAt(1.0), std::size_t(2));
}

// The same cases as for the Python reader (test_recordings_rounding.py).
TEST(StepTimes, AStepThatIsLateByARoundingIsNotAfterItsTime) {
  for (const double step_s : {0.001, 0.01, 0.1, 1.0 / 3.0}) {
    const StepTimes steps(AddedUp(2001, 0.0, step_s));
    for (int i = 1; i <= 2000; ++i) {
      EXPECT_EQ(steps.IndexAt(i * step_s), std::size_t(i)) << i << " of " << step_s;
      EXPECT_EQ(steps.IndexAt((i - 0.01) * step_s), std::size_t(i) - 1) << i;
    }
  }
}

TEST(StepTimes, TimesAsLargeAsEphemerisSecondsAreMet) {
  for (const double step_s : {1e-3, 1e-4, 1e-5}) { // a double's spacing is 1.2e-7 there
    std::vector<double> times;
    for (int i = 0; i < 500; ++i) {
      times.push_back(8e8 + i * step_s);
    }
    const StepTimes steps(times);
    for (std::size_t i = 0; i < times.size(); ++i) {
      for (const double asked :
           {times[i], std::nextafter(times[i], 0.0), std::nextafter(times[i], 1e9)}) {
        EXPECT_EQ(steps.IndexAt(asked), i) << step_s;
      }
      EXPECT_EQ(steps.IndexAt(times[i] + 0.9 * step_s), i) << step_s;
    }
  }
  std::vector<double> times = {8e8}; // as close as can be
  while (times.size() < 20) {
    times.push_back(std::nextafter(times.back(), 1e9));
  }
  for (std::size_t i = 0; i < times.size(); ++i) {
    EXPECT_EQ(StepTimes(times).IndexAt(times[i]), i);
  }
}

TEST(StepTimes, RoundingsAtTheEndsOfRunsAndBetweenCloseSteps) {
  const double late = 1.0000000000000007;
  const auto at = [](const std::vector<double>& times, double asked) {
    const auto found = StepTimes(times).IndexAt(asked);
    return found ? int(*found) : -1;
  };
  EXPECT_EQ(at({0.0, 0.9, late, late, 1.1}, 1.0), 3);
  EXPECT_EQ(at({0.1 + 0.2, 0.5}, 0.3), 0); // the first of all
  EXPECT_EQ(at({0.1 + 0.2, 0.5}, 0.29), -1);
  EXPECT_EQ(at({late}, 1.0), -1); // alone: two spacings
  EXPECT_EQ(at({0.1 + 0.2}, 0.3), 0);
  EXPECT_EQ(at({0.0, 1.0, 2.0, 0.0, 0.5, 1.0 - 1e-15}, 1.0), 5); // reaches it
  EXPECT_EQ(at({0.0, 1.0, 2.0, 0.0, 0.5, 1.0 - 1e-3}, 1.0), 1);
  EXPECT_EQ(at({0.0, 1.0, 2.0, 1e-15, 1.0}, 0.0), 3);
  EXPECT_EQ(at({0.0, 1.0, 1.0 + 1e-7, 2.0}, 1.0), 1); // the exact one
  EXPECT_EQ(at({0.0, 1.0, 1.0 + 1e-7, 2.0}, 1.0 - 1e-6), 1);
  EXPECT_EQ(at({0.0, 1.0, 1.0 + 1e-7, 2.0}, 1.0 + 5e-8), 1);
  EXPECT_EQ(at({0.0, 1.0, 1.0 + 1e-7, 2.0}, 1.0 + 1e-7 - 5e-11), 2);
  EXPECT_EQ(at({0.0, 1000.0}, 1000.0 - 0.9e-4), 1); // at most 0.1 ms
  EXPECT_EQ(at({0.0, 1000.0}, 1000.0 - 1.1e-4), 0);
}

} // namespace
} // namespace dspace::testing
