// Each side of the link is killed at a hundred random moments (DSPACE_LONG: a thousand; with the
// address sanitizer twenty, since its processes are slow to begin).
#include "LinkTestSupport.h"
#include "Sanitized.h"

#include <chrono>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <random>

#include <spawn.h>
#include <sqlite3.h>
#include <sys/wait.h>

#include <dspace/recording/RecordingFile.h>

extern char** environ;

namespace dspace::testing {
namespace {

using session::RemoteClient;
using session::Watcher;

int Kills() {
  const char* given = std::getenv("DSPACE_LONG");
  if (given && *given) {
    return 1000;
  }
  return testing::Sanitized() ? 20 : 100;
}

// LinkProcess, which makes the processes that are to be killed.
class ChildProcesses {
public:
  ChildProcesses() {
    int in[2];
    int out[2];
    EXPECT_EQ(pipe(in), 0);
    EXPECT_EQ(pipe(out), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, in[0], 0);
    posix_spawn_file_actions_adddup2(&actions, out[1], 1);
    for (const int end : {in[0], in[1], out[0], out[1]}) {
      posix_spawn_file_actions_addclose(&actions, end);
    }
    std::string program = LINK_PROCESS;
    char* arguments[] = {program.data(), nullptr};
    EXPECT_EQ(posix_spawn(&this->Id_, program.c_str(), &actions, nullptr, arguments, environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    close(in[0]);
    close(out[1]);
    this->To_ = fdopen(in[1], "w");
    this->From_ = fdopen(out[0], "r");
  }
  ~ChildProcesses() {
    std::fclose(this->To_);
    std::fclose(this->From_);
    waitpid(this->Id_, nullptr, 0);
  }
  ChildProcesses(const ChildProcesses&) = delete;
  ChildProcesses& operator=(const ChildProcesses&) = delete;

  // The id of a process that is ready; 0: it failed.
  pid_t Make(const std::string& line) {
    std::fprintf(this->To_, "%s\n", line.c_str());
    std::fflush(this->To_);
    int id = 0;
    EXPECT_EQ(std::fscanf(this->From_, "%d", &id), 1);
    EXPECT_GT(id, 0) << line;
    return id;
  }

private:
  pid_t Id_ = 0;
  FILE* To_ = nullptr;
  FILE* From_ = nullptr;
};

void Kill(pid_t id) {
  if (id > 0) {
    kill(id, SIGKILL);
    while (kill(id, 0) == 0) { // until its socket is free
      std::this_thread::sleep_for(std::chrono::microseconds(200));
    }
  }
}

// The steps of a recording as any reader finds them; checks every row on the way.
std::vector<double> StepsOf(const std::string& path) {
  std::vector<double> steps;
  sqlite3* database = nullptr;
  EXPECT_EQ(sqlite3_open_v2(path.c_str(), &database, SQLITE_OPEN_READWRITE, nullptr), SQLITE_OK);
  sqlite3_stmt* select = nullptr;
  EXPECT_EQ(sqlite3_prepare_v2(database,
                               "SELECT seq, time, wall, kind, payload, checksum FROM command "
                               "ORDER BY seq",
                               -1, &select, nullptr),
            SQLITE_OK)
      << sqlite3_errmsg(database);
  const auto blob = [&](int column) {
    return std::string(static_cast<const char*>(sqlite3_column_blob(select, column)),
                       std::size_t(sqlite3_column_bytes(select, column)));
  };
  std::uint64_t seq = 0;
  int state = 0;
  while ((state = sqlite3_step(select)) == SQLITE_ROW) {
    session::RecordingRow row;
    row.seq = std::uint64_t(sqlite3_column_int64(select, 0));
    row.time_s = sqlite3_column_double(select, 1);
    row.wall_s = sqlite3_column_double(select, 2);
    row.kind = sqlite3_column_int(select, 3);
    row.payload = blob(4);
    EXPECT_EQ(row.seq, ++seq); // none is left out
    EXPECT_EQ(blob(5), session::RecordingChecksum(row));
    v1::Command command;
    EXPECT_TRUE(command.ParseFromString(row.payload));
    if (command.has_set_poses()) {
      steps.push_back(command.set_poses().pose(0));
    }
  }
  EXPECT_EQ(state, SQLITE_DONE) << sqlite3_errmsg(database);
  sqlite3_finalize(select);
  sqlite3_close(database);
  return steps;
}

using LinkKills = LinkTest;

std::chrono::microseconds Moment(std::mt19937& random) {
  return std::chrono::microseconds(random() % 20000);
}

TEST_F(LinkKills, WritersDieAndNothingIsLostRepeatedOrHalf) {
  ChildProcesses children;
  this->StartServer();
  std::vector<double> seen; // by the server, of all writers
  this->Served->interpreter.AddListener([&](const v1::Command& command, const v1::Reply&) {
    if (command.has_set_poses()) {
      seen.push_back(command.set_poses().pose(0));
      seen.push_back(command.set_poses().pose(8));
    }
  });
  session::WatcherOptions options;
  options.address = this->Server->Address();
  Watcher watcher(options);
  std::mt19937 random(11);
  const int kills = Kills();
  for (int i = 0; i < kills; ++i) {
    const pid_t driver = children.Make("drive " + this->Server->Address());
    std::this_thread::sleep_for(Moment(random));
    Kill(driver);
  }
  auto after = this->ClientOptions("after");
  after.takeOver = true; // it may not have been noticed yet that the last one is gone
  std::string state;
  {
    RemoteClient client(after);
    state = client.Execute(AskPoses({2, 3})).SerializeAsString();
  }
  const std::uint64_t commands = 3 + seen.size() / 2; // the scene and two frames
  auto copy = std::make_unique<session::Interpreter>();
  v1::WatchReply message;
  while (message.sequence() < commands || message.has_writer()) {
    ASSERT_TRUE(watcher.Take(message, 20));
    if (message.has_snapshot()) {
      copy = std::make_unique<session::Interpreter>();
      for (v1::Command& command : *message.mutable_snapshot()->mutable_command()) {
        EXPECT_FALSE(copy->Execute(command).has_error());
      }
    } else if (message.has_command()) {
      EXPECT_FALSE(copy->Execute(*message.mutable_command()).has_error());
    }
  }
  v1::Command ask = AskPoses({2, 3});
  EXPECT_EQ(copy->Execute(ask).SerializeAsString(), state);
  this->StopServer();
  EXPECT_GT(seen.size(), 0u);
  for (std::size_t i = 0; i < seen.size(); ++i) {
    ASSERT_EQ(seen[i], double(i / 2 + 1)); // each once, in order, both frames
  }
}

TEST_F(LinkKills, ServersDieAndClientsReportItAndRecordingsAreSound) {
  ChildProcesses children;
  std::mt19937 random(12);
  const std::string listen = this->Options.listen;
  std::size_t recorded = 0;
  const int kills = Kills();
  for (int i = 0; i < kills; ++i) {
    const std::string file = this->Folder + "/run" + std::to_string(i) + ".dspace";
    const pid_t server = children.Make("serve " + listen + " " + file);
    ASSERT_GT(server, 0);
    auto options = this->ClientOptions();
    options.timeout_s = 20;
    RemoteClient client(options);
    Accept(client.Execute(MakeScene()));
    Accept(client.Execute(MakeFrame(2)));
    session::WatcherOptions watch;
    watch.address = listen;
    Watcher watcher(watch);
    pid_t next = 0;
    std::thread killer([&] {
      std::this_thread::sleep_for(Moment(random));
      Kill(server);
      next = children.Make("serve " + listen + " " + file + "2");
    });
    v1::Reply reply;
    int step = 0;
    while (!reply.has_error()) {
      reply = ++step % 7 == 0 ? client.Execute(AskPoses({2})) : client.Send(MakeStep({2}, step));
      if (!reply.has_error() && step % 7 == 0) {
        EXPECT_EQ(reply.poses().pose(0), step - 1);
      }
    }
    killer.join();
    // Another server on the same socket is not taken for the one that had the scene.
    EXPECT_EQ(reply.error().kind(), v1::Error::IO) << reply.error().message();
    EXPECT_NE(reply.error().message().find("restarted"), std::string::npos)
        << reply.error().message();
    // What was recorded is the beginning of what was sent.
    const std::vector<double> steps = StepsOf(file);
    double expected = 0;
    for (const double value : steps) {
      expected += std::fmod(expected + 1, 7) == 0 ? 2 : 1;
      ASSERT_EQ(value, expected);
    }
    EXPECT_LT(expected, step);
    recorded += steps.size();
    // The viewer comes back by itself, to a server that has nothing, and so does a new simulation.
    v1::WatchReply message;
    bool empty = false;
    while (!empty && watcher.Take(message, 20)) {
      empty = message.has_snapshot() && message.snapshot().command_size() == 0;
    }
    EXPECT_TRUE(empty);
    RemoteClient anew(options);
    Accept(anew.Execute(MakeScene()));
    Kill(next);
    for (const char* end : {"", "2"}) { // as many as there are kills are too large for /tmp
      for (const char* part : {"", "-wal", "-shm"}) {
        std::filesystem::remove(file + end + part);
      }
    }
  }
  EXPECT_GT(recorded, 0u);
}

TEST_F(LinkKills, ViewersDieWithoutEffectOnOthers) {
  ChildProcesses children;
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  Accept(client.Execute(MakeFrame(2)));
  std::mt19937 random(13);
  int step = 0;
  std::uint64_t reconnections = 0;
  const int kills = Kills();
  for (int i = 0; i < kills; ++i) {
    const pid_t viewer = children.Make("watch " + this->Server->Address());
    const auto end = std::chrono::steady_clock::now() + Moment(random);
    while (std::chrono::steady_clock::now() < end) {
      const v1::Reply reply =
          ++step % 7 == 0 ? client.Execute(AskPoses({2})) : client.Send(MakeStep({2}, step));
      ASSERT_FALSE(reply.has_error()) << reply.error().message();
    }
    Kill(viewer);
    const v1::Reply reply = client.Execute(MakeStep({2}, ++step));
    ASSERT_FALSE(reply.has_error()) << reply.error().message();
  }
  reconnections = client.GetCounts().reconnections;
  EXPECT_EQ(reconnections, 0u);
  EXPECT_EQ(client.Execute(AskPoses({2})).poses().pose(0), step);
  // Those who are gone are forgotten.
  const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
  while (this->Server->GetCounts().viewers > 0 && std::chrono::steady_clock::now() < end) {
    Accept(client.Execute(MakeStep({2}, ++step))); // who is written to is found to be gone
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
  }
  EXPECT_EQ(this->Server->GetCounts().viewers, 0u);
}

} // namespace
} // namespace dspace::testing
