// What is in a recording is a prefix of what was accepted, whatever happens to the writer.
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <chrono>
#include <csignal>
#include <cstring>
#include <filesystem>
#include <random>
#include <thread>

#include <sqlite3.h>

#include <dspace/recording/RecordingFile.h>
#include <dspace/recording/RecordingWriter.h>

#include "CommandTestSupport.h"
#include "Sanitized.h"

namespace dspace::testing {
namespace {

using session::Ledger;
using session::RecordingOptions;
using session::RecordingRow;
using session::RecordingWriter;

// A command whose content follows from its number.
v1::Command Numbered(std::uint64_t i) {
  v1::Command command;
  for (std::uint64_t k = 0; k < 20; ++k) {
    command.mutable_set_poses()->add_frame(2 + k);
    for (int c = 0; c < 8; ++c) {
      command.mutable_set_poses()->add_pose(double(i) + double(k) / 32);
    }
  }
  return command;
}

// The rows of a recording, read as any reader would; wrong checksums are failures of the test.
std::vector<RecordingRow> ReadRows(const std::string& path) {
  std::vector<RecordingRow> rows;
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READWRITE, nullptr), SQLITE_OK);
  sqlite3_busy_timeout(database, 10000);
  sqlite3_stmt* select = nullptr;
  EXPECT_EQ(sqlite3_prepare_v2(database,
                               "SELECT seq, time, wall, kind, payload, checksum FROM command "
                               "ORDER BY seq",
                               -1, &select, nullptr),
            SQLITE_OK)
      << sqlite3_errmsg(database);
  const auto blob = [select](int column) {
    return std::string(static_cast<const char*>(sqlite3_column_blob(select, column)),
                       std::size_t(sqlite3_column_bytes(select, column)));
  };
  while (sqlite3_step(select) == SQLITE_ROW) {
    RecordingRow row;
    row.seq = std::uint64_t(sqlite3_column_int64(select, 0));
    row.time_s = sqlite3_column_double(select, 1);
    row.wall_s = sqlite3_column_double(select, 2);
    row.kind = sqlite3_column_int(select, 3);
    row.payload = blob(4);
    EXPECT_EQ(blob(5), session::RecordingChecksum(row)) << row.seq;
    rows.push_back(std::move(row));
  }
  sqlite3_finalize(select);
  sqlite3_close(database);
  return rows;
}

// The first value that a question has for an answer.
std::string Ask(const std::string& path, const char* question) {
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READWRITE, nullptr), SQLITE_OK);
  std::string answer;
  sqlite3_exec(
      database, question,
      [](void* to, int, char** values, char**) {
        *static_cast<std::string*>(to) = values[0] ? values[0] : "";
        return 0;
      },
      &answer, nullptr);
  sqlite3_close(database);
  return answer;
}

void ExpectPrefix(const std::vector<RecordingRow>& rows) {
  for (std::size_t i = 0; i < rows.size(); ++i) {
    ASSERT_EQ(rows[i].seq, i + 1);
    ASSERT_EQ(rows[i].payload, Numbered(i + 1).SerializeAsString());
    ASSERT_EQ(rows[i].kind, 24);
  }
}

class Recording : public ::testing::Test {
protected:
  void Remove() {
    for (const char* end : {"", "-wal", "-shm"}) {
      std::remove((this->Path_ + end).c_str());
    }
  }
  const TemporaryFolder Folder_;
  const std::string Path_ = this->Folder_ / "recording.dspace";
};

TEST_F(Recording, AStateThatIsTooLargeIsAnErrorOrTakenNoMore) {
  v1::Command scene;
  scene.mutable_create_scene();
  Ledger ledger;
  ledger.Add(scene, {});
  const auto grow = [&ledger](int frame) {
    v1::Command command;
    command.mutable_create_frame()->set_id(std::uint64_t(frame) + 2);
    command.mutable_create_frame()->set_name("frame " + std::to_string(frame));
    ledger.Add(command, {});
    return command;
  };
  RecordingOptions options;
  options.snapshotBytes = 1;
  options.largestSnapshot = 10000;
  {
    RecordingWriter writer(this->Path_, ledger, 0.0, options);
    for (int i = 0; i < 2000; ++i) {
      const v1::Command command = grow(i);
      EXPECT_EQ(writer.Add(command, {}, ledger), "");
    }
    EXPECT_EQ(writer.Flush(), "");
    EXPECT_EQ(writer.Counts().written, 2000u); // nothing is lost by it
    EXPECT_GT(writer.Counts().snapshots, 2u);
    EXPECT_LT(writer.Counts().snapshots, 10u);
  }
  this->Remove();
  try {
    RecordingWriter writer(this->Path_, ledger, 0.0, options);
    FAIL() << "it was taken";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Resource);
    EXPECT_NE(std::string(error.what()).find("up to 10000"), std::string::npos) << error.what();
  }
  EXPECT_NE(access(this->Path_.c_str(), F_OK), 0); // nothing is left behind
}

TEST_F(Recording, HoldsWhatWasAcceptedAndIsReadMeanwhile) {
  RecordingOptions options;
  options.snapshotCommands = 100;
  {
    RecordingWriter writer(this->Path_, Ledger(), 0.0, options);
    for (std::uint64_t i = 1; i <= 1000; ++i) {
      EXPECT_EQ(writer.Add(Numbered(i), {}, Ledger()), "");
      if (i % 250 == 0) {
        EXPECT_EQ(writer.Flush(), "");
        const std::vector<RecordingRow> rows = ReadRows(this->Path_); // while it is open
        EXPECT_EQ(rows.size(), i);
        ExpectPrefix(rows);
      }
    }
    EXPECT_EQ(writer.Counts().accepted, 1000u);
    EXPECT_EQ(writer.Counts().written, 1000u);
    EXPECT_EQ(writer.Counts().bytes, 1000 * Numbered(1).ByteSizeLong());
    EXPECT_EQ(writer.Counts().snapshots, 11u);
  }
  EXPECT_EQ(ReadRows(this->Path_).size(), 1000u);
}

// The log is moved into the file while more is written, and does not grow without end.
TEST_F(Recording, ItsLogStaysSmall) {
  RecordingOptions options;
  options.checkpointPages = 8;
  options.commitEvery_s = 0.001;
  std::uintmax_t greatest = 0;
  {
    RecordingWriter writer(this->Path_, Ledger(), 0.0, options);
    for (std::uint64_t i = 1; i <= 4000; ++i) {
      writer.Add(Numbered(i), {}, Ledger());
      if (i % 50 == 0) {
        writer.Flush();
        greatest = std::max(greatest, std::filesystem::file_size(this->Path_ + "-wal"));
      }
    }
    EXPECT_GT(std::filesystem::file_size(this->Path_), 2000 * Numbered(1).ByteSizeLong());
  }
  EXPECT_GT(greatest, 8u * 65536u);
  EXPECT_LT(greatest, (4u * 8u + 16u) * 65560u); // four times as many, and a transaction
  EXPECT_GT(4000 * Numbered(1).ByteSizeLong(), (4u * 8u + 16u) * 65560u);
  EXPECT_FALSE(std::filesystem::exists(this->Path_ + "-wal"));
  const std::vector<RecordingRow> rows = ReadRows(this->Path_);
  EXPECT_EQ(rows.size(), 4000u);
  ExpectPrefix(rows);
}

// After a jump the state is another one, and the file says that a command is not there.
TEST_F(Recording, AJumpLeavesAGap) {
  const Ledger later;
  {
    RecordingWriter writer(this->Path_, Ledger(), 0.0);
    writer.Add(Numbered(1), {}, Ledger());
    writer.Add(Numbered(2), {}, Ledger());
    writer.Resync(later, 9.0, nullptr);
    writer.Add(Numbered(4), {}, later);
    writer.Resync(later, 8.0, nullptr);
  }
  const std::vector<RecordingRow> rows = ReadRows(this->Path_);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[2].seq, 4u);
  EXPECT_EQ(rows[2].time_s, 9.0);
  EXPECT_EQ(rows[2].payload, Numbered(4).SerializeAsString());
  EXPECT_EQ(Ask(this->Path_, "SELECT value FROM meta WHERE key = 'lost'"), "3-3 5-5");
  EXPECT_EQ(Ask(this->Path_, "SELECT group_concat(seq || ':' || time, ' ') FROM snapshot"),
            "0:0.0 3:9.0 5:8.0");
}

TEST_F(Recording, TimeIsTheSimulations) {
  {
    RecordingWriter writer(this->Path_, Ledger(), 5.0);
    writer.Add(Numbered(1), {}, Ledger());
    v1::Command time;
    time.mutable_set_time()->set_time_s(6.5);
    writer.Add(time, {}, Ledger());
    writer.Add(Numbered(2), {}, Ledger());
  }
  const std::vector<RecordingRow> rows = ReadRows(this->Path_);
  ASSERT_EQ(rows.size(), 3u);
  EXPECT_EQ(rows[0].time_s, 5.0);
  EXPECT_EQ(rows[1].time_s, 6.5);
  EXPECT_EQ(rows[2].time_s, 6.5);
  EXPECT_LE(rows[0].wall_s, rows[2].wall_s);
}

// The clock of the machine may be set back.
TEST_F(Recording, WallTimeNeverGoesBack) {
  const std::vector<double> told = {100.0, 101.0, 50.0, 51.0, 102.0, 7.0};
  std::size_t next = 0;
  RecordingOptions options;
  options.clock = [&] { return told.at(next++); };
  {
    RecordingWriter writer(this->Path_, Ledger(), 0.0, options); // its first snapshot
    writer.Add(Numbered(1), {}, Ledger());
    writer.Add(Numbered(2), {}, Ledger());
    writer.Resync(Ledger(), 0.0, nullptr); // 3, a snapshot
    writer.Add(Numbered(4), {}, Ledger());
    writer.Add(Numbered(5), {}, Ledger());
  }
  std::vector<double> noted;
  for (const RecordingRow& row : ReadRows(this->Path_)) {
    noted.push_back(row.wall_s);
  }
  EXPECT_EQ(noted, (std::vector<double>{101.0, 101.0, 102.0, 102.0}));
  EXPECT_EQ(Ask(this->Path_, "SELECT group_concat(wall, ' ') FROM snapshot"), "100.0 101.0");
}

TEST_F(Recording, RejectsWhatItCannotDo) {
  const auto refused = [&](const std::string& path, const RecordingOptions& options,
                           Error::Kind kind) {
    try {
      RecordingWriter writer(path, Ledger(), 0.0, options);
      ADD_FAILURE() << path;
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), kind) << error.what();
      EXPECT_NE(std::string(error.what()).find(path), std::string::npos) << error.what();
    }
  };
  refused("/no/such/folder/a.dspace", {}, Error::Kind::Io);
  const TemporaryFile there("there.dspace", "not ours");
  refused(there.Path(), {}, Error::Kind::AlreadyExists);
  RecordingOptions never;
  never.commitEvery_s = 0.0;
  refused(this->Path_, never, Error::Kind::InvalidArgument);
}

// A recording process is killed at random moments: what is there then is whole.
TEST_F(Recording, KilledAtAnyMomentItIsAPrefix) {
  std::mt19937 random(7);
  std::size_t held = 0;
  for (int round = 0; round < 30; ++round) {
    this->Remove();
    int ends[2];
    ASSERT_EQ(pipe(ends), 0);
    const pid_t child = fork();
    ASSERT_GE(child, 0);
    if (child == 0) {
      RecordingOptions options;
      options.commitEvery_s = 0.002;
      options.snapshotCommands = 50;
      RecordingWriter writer(this->Path_, Ledger(), 0.0, options);
      if (write(ends[1], "", 1) != 1) { // it is a recording from here on
        _exit(1);
      }
      for (std::uint64_t i = 1;; ++i) {
        writer.Add(Numbered(i), {}, Ledger());
        if (i % 100 == 0) {
          std::this_thread::sleep_for(std::chrono::milliseconds(1));
        }
      }
    }
    close(ends[1]); // so that a child that fails ends the wait
    char begun = 1;
    ASSERT_EQ(read(ends[0], &begun, 1), 1);
    close(ends[0]);
    std::this_thread::sleep_for(std::chrono::microseconds(random() % 100000));
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
    const std::vector<RecordingRow> rows = ReadRows(this->Path_);
    ExpectPrefix(rows);
    if (HasFatalFailure()) {
      return;
    }
    held += rows.size();
  }
  EXPECT_GT(held, 0u);
}

// A child of the process that records says so, and may end as it likes.
TEST_F(Recording, AChildProcessLeavesItAlone) {
  if (testing::Sanitized()) {
    GTEST_SKIP()
        << "the sanitizer's allocator may be locked by another thread when a process forks";
  }
  auto writer = std::make_unique<RecordingWriter>(this->Path_, Ledger(), 0.0, RecordingOptions());
  EXPECT_EQ(writer->Add(Numbered(1), {}, Ledger()), "");
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    alarm(20); // it hangs
    const bool told =
        writer->Add(Numbered(2), {}, Ledger()).find("this one is its child") != std::string::npos;
    const bool once = writer->Add(Numbered(3), {}, Ledger()).empty();
    const bool refused = !writer->Flush().empty() && !writer->Counts().failure.empty();
    writer.reset();
    _exit(told && once && refused ? 0 : 1);
  }
  int status = -1;
  ASSERT_EQ(waitpid(child, &status, 0), child);
  EXPECT_EQ(status, 0);
  EXPECT_EQ(writer->Add(Numbered(2), {}, Ledger()), "");
  writer.reset();
  const std::vector<RecordingRow> rows = ReadRows(this->Path_);
  ExpectPrefix(rows);
  EXPECT_EQ(rows.size(), 2u);
}

// The simulation is told once and goes on; what was written stays.
TEST_F(Recording, ADiskThatIsFullEndsItWithOneWarning) {
  RecordingOptions options;
  options.maximumPages = 30;
  options.commitEvery_s = 0.001;
  RecordingWriter writer(this->Path_, Ledger(), 0.0, options);
  int told = 0;
  std::string said;
  for (std::uint64_t i = 1; i <= 2000; ++i) {
    const std::string failure = writer.Add(Numbered(i), {}, Ledger());
    if (!failure.empty()) {
      ++told;
      said = failure;
    }
    if (i % 100 == 0) {
      writer.Flush();
    }
  }
  EXPECT_EQ(told, 1);
  EXPECT_NE(said.find("full"), std::string::npos) << said;
  EXPECT_NE(said.find(this->Path_), std::string::npos) << said;
  const std::vector<RecordingRow> rows = ReadRows(this->Path_);
  EXPECT_EQ(rows.size(), writer.Counts().written);
  EXPECT_GT(rows.size(), 100u);
  EXPECT_LT(rows.size(), 2000u);
  ExpectPrefix(rows);
}

// As the one above, by the operating system: no file may grow further.
TEST_F(Recording, AFileThatMayNotGrowEndsIt) {
  const pid_t child = fork();
  ASSERT_GE(child, 0);
  if (child == 0) {
    std::signal(SIGXFSZ, SIG_IGN);
    RecordingWriter writer(this->Path_, Ledger(), 0.0);
    const rlimit limit = {3 << 20, 3 << 20};
    setrlimit(RLIMIT_FSIZE, &limit);
    int told = 0;
    for (std::uint64_t i = 1; i <= 2000; ++i) {
      told += writer.Add(Numbered(i), {}, Ledger()).empty() ? 0 : 1;
      if (i % 50 == 0) {
        writer.Flush();
      }
    }
    _exit(told == 1 ? 0 : 1);
  }
  int status = 0;
  waitpid(child, &status, 0);
  EXPECT_TRUE(WIFEXITED(status) && WEXITSTATUS(status) == 0) << status;
  const std::vector<RecordingRow> rows = ReadRows(this->Path_);
  EXPECT_GT(rows.size(), 50u);
  EXPECT_LT(rows.size(), 2000u);
  ExpectPrefix(rows);
}

} // namespace
} // namespace dspace::testing
