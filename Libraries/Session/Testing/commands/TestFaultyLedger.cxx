// A command that the ledger cannot take in is recorded and reaches viewers all the same; the
// simulation is told, and nobody gets a snapshot that lacks it.
#include <filesystem>
#include <thread>

#include <unistd.h>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/link/client/RemoteClient.h>
#include <dspace/link/watching/Watcher.h>
#include <dspace/recording/RecordingReader.h>

#include "vtkDspaceServer.h"
#include "vtkDspaceSession.h"
#include "vtkNew.h"

namespace dspace::testing {
namespace {

using session::RemoteClient;
using session::Watcher;

// RemoveRobot is accepted whatever it names: the ledger knows no such robot and throws.
void BreakRemoveRobot(vtkDspaceSession& session) {
  using C = v1::Command;
  session.GetInterpreter().Commands().Add(C::kRemoveRobot, &C::mutable_remove_robot,
                                          [](const session::Context&, v1::RemoveRobot&) {});
}

v1::Command Create(const std::string& scene) {
  v1::Command command;
  command.set_scene(scene);
  command.mutable_create_scene();
  return command;
}

v1::Command RemoveRobot(const std::string& scene) {
  v1::Command command;
  command.set_scene(scene);
  command.mutable_remove_robot()->set_robot("none");
  return command;
}

v1::Command SetTime(const std::string& scene, double time) {
  v1::Command command;
  command.set_scene(scene);
  command.mutable_set_time()->set_time_s(time);
  return command;
}

v1::Command Remove(const std::string& scene) {
  v1::Command command;
  command.set_scene(scene);
  command.mutable_remove_scene();
  return command;
}

v1::Reply Execute(vtkDspaceSession& session, const v1::Command& command) {
  v1::Reply reply;
  EXPECT_TRUE(reply.ParseFromString(session.Execute(command.SerializeAsString())));
  EXPECT_FALSE(reply.has_error()) << reply.error().message();
  return reply;
}

class FaultyLedger : public ::testing::Test {
protected:
  void SetUp() override {
    char name[] = "/tmp/dspace-ledger-XXXXXX";
    this->Folder = mkdtemp(name);
  }
  void TearDown() override { std::filesystem::remove_all(this->Folder); }
  std::string Folder;
};

TEST_F(FaultyLedger, CostsARecordingNoCommand) {
  const std::string path = this->Folder + "/a.dspace";
  vtkNew<vtkDspaceSession> session;
  BreakRemoveRobot(*session);
  Execute(*session, Create("one"));
  Execute(*session, Create("two"));
  ASSERT_EQ(session->Record(path, 0.001), "");
  const v1::Reply told = Execute(*session, RemoveRobot("one"));
  ASSERT_EQ(told.warning_size(), 1);
  EXPECT_NE(told.warning(0).find("remove_robot"), std::string::npos) << told.warning(0);
  EXPECT_NE(told.warning(0).find("until scene 'one' is removed"), std::string::npos)
      << told.warning(0);
  // More commands than there are between two snapshots: none is taken, and none is told of again.
  for (int i = 1; i <= 20001; ++i) {
    ASSERT_EQ(Execute(*session, SetTime(i % 2 ? "one" : "two", i)).warning_size(), 0);
  }
  EXPECT_THROW(session->GetLedger().Commands(), Error);
  EXPECT_EQ(session->StopRecording(), "");
  EXPECT_EQ(session->GetRecordingCount("written"), 20002u);
  EXPECT_EQ(session->GetRecordingCount("snapshots"), 1u);

  session::RecordingReader reader(path);
  std::uint64_t rows = 0;
  reader.Read(1, 20002, [&rows](session::RecordedCommand&& row) {
    EXPECT_EQ(row.seq, ++rows);
    EXPECT_EQ(row.command.has_remove_robot(), rows == 1);
    return true;
  });
  EXPECT_EQ(rows, 20002u);

  EXPECT_NE(session->Record(this->Folder + "/b.dspace", 0.1).find("remove_robot"),
            std::string::npos);
  EXPECT_FALSE(std::filesystem::exists(this->Folder + "/b.dspace"));
  Execute(*session, Remove("one"));                      // then all is known again
  EXPECT_EQ(session->GetLedger().Commands().size(), 3u); // the other scene, its first time, and now
  EXPECT_EQ(session->Record(this->Folder + "/b.dspace", 0.1), "");
}

TEST_F(FaultyLedger, IsTakenForWholeAgainByNoOtherCommand) {
  vtkNew<vtkDspaceSession> session;
  Execute(*session, Create("one"));
  v1::Command viewport; // one that could not be made here
  viewport.set_scene("one");
  viewport.mutable_create_viewport()->set_name("view");
  EXPECT_EQ(session->AddFailed(viewport, "no room"), "");
  try {
    session->GetLedger().Commands();
    ADD_FAILURE() << "a snapshot without a command";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("create_viewport"), std::string::npos);
    EXPECT_NE(std::string(error.what()).find("no room"), std::string::npos);
  }
  Execute(*session, Remove("one"));
  EXPECT_THROW(session->GetLedger().Commands(), Error);
}

TEST_F(FaultyLedger, KeepsNoCommandFromViewers) {
  vtkNew<vtkDspaceServer> server;
  server->SetListen("unix:" + this->Folder + "/socket");
  server->AddAllowedRoot(this->Folder);
  BreakRemoveRobot(*server->GetSession());
  ASSERT_EQ(server->Start(), "");
  std::thread thread([&server] {
    while (server->Run(1)) {
    }
  });
  {
    session::RemoteClientOptions drives;
    drives.address = server->GetAddress();
    RemoteClient client(drives);
    session::WatcherOptions watches;
    watches.address = server->GetAddress();
    Watcher watcher(watches);
    std::vector<v1::Command> heard;
    const auto hear = [&](std::size_t count) {
      v1::WatchReply message;
      while (heard.size() < count && watcher.Take(message, 30)) {
        if (message.has_command()) {
          EXPECT_EQ(message.sequence(), heard.size() + 1);
          heard.push_back(message.command());
        }
      }
    };
    v1::WatchReply first;
    ASSERT_TRUE(watcher.Take(first, 30));
    ASSERT_TRUE(first.has_snapshot());
    EXPECT_EQ(client.Execute(Create("one")).sequence(), 1u);
    const v1::Reply told = client.Execute(RemoveRobot("one"));
    EXPECT_EQ(told.sequence(), 2u);
    ASSERT_EQ(told.warning_size(), 1);
    EXPECT_NE(told.warning(0).find("remove_robot"), std::string::npos) << told.warning(0);
    EXPECT_EQ(client.Execute(SetTime("one", 1)).sequence(), 3u);
    hear(3);
    ASSERT_EQ(heard.size(), 3u);
    EXPECT_TRUE(heard[1].has_remove_robot());
    EXPECT_TRUE(heard[2].has_set_time());

    try {
      const Watcher late(watches);
      ADD_FAILURE() << "somebody got a snapshot that lacks a command";
    } catch (const Error& error) {
      EXPECT_NE(std::string(error.what()).find("remove_robot"), std::string::npos) << error.what();
    }
    EXPECT_EQ(client.Execute(Remove("one")).warning_size(), 0);
    Watcher later(watches);
    ASSERT_TRUE(later.Take(first, 30));
    EXPECT_TRUE(first.has_snapshot());
    EXPECT_EQ(first.sequence(), 4u);
    EXPECT_EQ(first.snapshot().command_size(), 0);
  }
  server->Stop();
  thread.join();
}

} // namespace
} // namespace dspace::testing
