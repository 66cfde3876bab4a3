// The limits of a server and its clients, and what a child process of a client may do.
#include <algorithm>
#include <atomic>
#include <stdexcept>

#include <fcntl.h>
#include <sys/stat.h>
#include <sys/wait.h>

#include <dspace/Budgets.h>

#include "RawDrive.h"
#include "Sanitized.h"

namespace dspace::testing {
namespace {

using session::RemoteClient;
using session::Watcher;

using Clock = std::chrono::steady_clock;
using LinkLimits = RawLinkTest;

v1::ViewerEvent MakeEvent(int number, std::size_t bytes) {
  v1::ViewerEvent event;
  event.mutable_answer()->set_question(std::to_string(number));
  event.mutable_answer()->set_answer(std::string(bytes, 'x'));
  return event;
}

TEST_F(LinkLimits, UnreadEventsTakeBoundedMemoryAndDisconnectNoClient) {
  this->Options.unreadBytes = 4 << 20; // of replies
  this->StartServer();
  Watcher watcher(this->ToWatch());
  RawDrive writer(this->Address(), KeyA);
  ASSERT_TRUE(writer.IsOpen);
  int delivered = 0;
  for (int i = 0; i < 60; ++i) {
    delivered += watcher.SendEvent(MakeEvent(i, 1000000));
  }
  // 8 MiB wait in the server, some on the way.
  EXPECT_GE(delivered, 8);
  EXPECT_LT(delivered, 30);
  EXPECT_LT(this->Server->GetCounts().waitingBytes, std::size_t(9) << 20);
  writer.Send(1, MakeScene());
  EXPECT_EQ(writer.WaitFor(1), delivered);
  EXPECT_THROW(watcher.SendEvent(MakeEvent(0, 2 << 20)), Error);
}

TEST_F(LinkLimits, EventsThatASimulationDoesNotTakeAreTheNewestOfBoundedSize) {
  this->StartServer();
  Watcher watcher(this->ToWatch());
  RemoteClient client(this->ClientOptions());
  constexpr int Events = 40;
  for (int i = 0; i < Events; ++i) {
    ASSERT_TRUE(Within20s([&] { return watcher.SendEvent(MakeEvent(i, 1000000)); }));
  }
  Accept(client.Execute(MakeScene())); // comes after them
  std::vector<std::string> heard;
  client.TakeEvents(
      [&](const v1::ViewerEvent& event) { heard.push_back(event.answer().question()); });
  ASSERT_EQ(heard.size(), 16u); // of a megabyte and its own fields, in 16 MiB
  for (std::size_t i = 0; i < heard.size(); ++i) {
    EXPECT_EQ(heard[i], std::to_string(Events - 16 + int(i)));
  }
}

TEST_F(LinkLimits, WhatWaitsIsCountedAsItLiesInMemory) {
  this->Options.queuedBytes = 1 << 20;
  this->StartIdleServer();
  v1::Command table; // 20 kB on the wire
  for (int i = 0; i < 10000; ++i) {
    table.mutable_set_text_table()->add_row();
  }
  const std::size_t bytes = table.SpaceUsedLong();
  ASSERT_GT(bytes, 25 * table.ByteSizeLong()); // of which 20 are sent
  RawDrive writer(this->Address(), KeyA);
  for (std::uint64_t i = 1; i <= 20; ++i) {
    writer.Send(i, table);
  }
  const auto waiting = [&] { return this->Server->GetCounts().waitingBytes; };
  EXPECT_TRUE(Within20s([&] { return waiting() >= bytes; }));
  std::this_thread::sleep_for(std::chrono::milliseconds(100));
  EXPECT_LE(waiting(), this->Options.queuedBytes);
}

// Both sides stay a few steps ahead of one another, but only while the other one goes on.
// What the server's queue does not take waits in the client.
TEST_F(LinkLimits, ACommandOfTooManyElementsIsAnErrorOfItsOwn) {
  SetBudget("message_elements", 1000);
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  v1::Command table; // two bytes for each row
  for (int i = 0; i < 2000; ++i) {
    table.mutable_set_text_table()->add_row();
  }
  const v1::Reply reply = client.Execute(table);
  EXPECT_EQ(reply.error().kind(), v1::Error::RESOURCE);
  EXPECT_NE(reply.error().message().find("command 2: its "), std::string::npos);
  EXPECT_NE(reply.error().message().find("the limit message_elements is 1000"), std::string::npos)
      << reply.error().message();
  v1::Command next;
  next.mutable_create_frame()->set_name("after");
  Accept(client.Execute(next));
  SetBudget("message_elements", 10000);
  EXPECT_EQ(client.Execute(table).error().message().find("message_elements"), std::string::npos);
  const BudgetInfo& info = Budgets()[static_cast<std::size_t>(Budget::MessageElements)];
  SetBudget(info.name, info.standard);
}

TEST_F(LinkLimits, AServerThatStallsIsSentAWindowful) {
  for (const std::size_t queue : {std::size_t(256) << 20, std::size_t(1) << 20}) {
    this->Options.queuedBytes = queue;
    this->StartIdleServer(); // which carries out nothing yet
    session::RemoteClientOptions to = this->ClientOptions();
    to.timeout_s = 30;
    RemoteClient client(to);
    Accept(client.Send(MakeScene()));
    std::vector<std::uint64_t> frames;
    for (std::uint64_t id = 2; id < 602; ++id) {
      frames.push_back(id);
      Accept(client.Send(MakeFrame(id)));
    }
    std::size_t sent = 0;
    int step = 0;
    while (sent < std::size_t(12) << 20) { // of 16 MiB
      const v1::Command command = MakeStep(frames, ++step);
      sent += command.ByteSizeLong();
      client.Begin(command, false);
      ASSERT_TRUE(client.Wait(10)) << "step " << step; // of milliseconds
      Accept(client.Take());
    }
    const std::size_t most = std::min(sent, queue / 2);
    EXPECT_TRUE(Within20s([&] { return this->Server->GetCounts().waitingBytes >= most; }));
    this->Served = std::make_unique<ServedInterpreter>();
    this->Thread = std::thread([this] {
      while (this->Server->Run(this->Served->Work(), 10)) {
      }
    });
    Accept(client.Flush());
    const v1::Reply reply = client.Execute(AskPoses(frames));
    ASSERT_EQ(reply.poses().pose_size(), int(8 * frames.size()));
    for (int i = 0; i < reply.poses().pose_size(); i += 8) {
      ASSERT_EQ(reply.poses().pose(i), step);
    }
    EXPECT_EQ(this->Server->GetCounts().commands, 602u + std::uint64_t(step));
    this->StopServer();
  }
}

TEST_F(LinkLimits, TheRateHoldsAcrossConnections) {
  this->Options.maximumRate = 50;
  this->StartServer();
  const auto began = Clock::now();
  std::uint64_t number = 0;
  for (int connection = 0; connection < 3; ++connection) {
    RawDrive writer(this->Address(), KeyA);
    ASSERT_TRUE(writer.IsOpen);
    for (int i = 0; i < 40; ++i) {
      writer.Send(++number, MakeScene());
    }
    writer.WaitFor(number);
  }
  // A second's worth may come at once.
  const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
  EXPECT_LE(double(number), 50 * (seconds + 1) + 2);
}

TEST_F(LinkLimits, SnapshotsAreMadeOncePerStateAndNotAtEveryCall) {
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  for (int i = 0; i < 20; ++i) {
    Watcher watcher(this->ToWatch());
  }
  EXPECT_EQ(this->Server->GetCounts().snapshots, 1u);
  const auto began = Clock::now();
  constexpr int Times = 20;
  v1::WatchReply message;
  for (int i = 0; i < Times; ++i) {
    Accept(client.Execute(MakeFrame(std::uint64_t(i) + 2)));
    Watcher watcher(this->ToWatch());
    ASSERT_TRUE(watcher.Take(message, 20));
    ASSERT_TRUE(message.has_snapshot());
    EXPECT_EQ(message.snapshot().command_size(), i + 2); // of now
  }
  const double seconds = std::chrono::duration<double>(Clock::now() - began).count();
  EXPECT_LE(double(this->Server->GetCounts().snapshots), seconds / 0.1 + 2);
}

TEST_F(LinkLimits, AFailedSnapshotIsReportedAndEndsNothing) {
  this->Server = std::make_unique<session::Server>(this->Options);
  this->Served = std::make_unique<ServedInterpreter>();
  auto work = this->Served->Work();
  work.snapshot = []() -> std::vector<v1::Command> { throw std::runtime_error("as it happens"); };
  this->Thread = std::thread([this, work] {
    while (this->Server->Run(work, 10)) {
    }
  });
  try {
    Watcher watcher(this->ToWatch());
    FAIL() << "a viewer has something to show";
  } catch (const Error& error) {
    EXPECT_NE(std::string(error.what()).find("the snapshot failed: as it happens"),
              std::string::npos)
        << error.what();
  }
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
}

TEST_F(LinkLimits, AChildProcessGetsAnErrorAndMayCloseTheClientsOfItsParent) {
  if (testing::Sanitized()) {
    GTEST_SKIP()
        << "the sanitizer's allocator may be locked by another thread when a process forks";
  }
  this->StartServer();
  auto client = std::make_unique<RemoteClient>(this->ClientOptions());
  auto watcher = std::make_unique<Watcher>(this->ToWatch());
  Accept(client->Execute(MakeScene()));
  const pid_t child = fork();
  if (child == 0) {
    const v1::Reply reply = client->Execute(MakeFrame(2));
    const bool told =
        reply.error().kind() == v1::Error::UNSUPPORTED &&
        reply.error().message().find("accepted: a connection of its own") != std::string::npos;
    bool refused = false;
    try {
      watcher->SendEvent(MakeEvent(0, 1));
    } catch (const Error& error) {
      refused = error.GetKind() == Error::Kind::Unsupported;
    }
    const bool silent = client->TakeEvents([](const v1::ViewerEvent&) {}, 5) == 0 &&
                        !watcher->Connected() && client->Flush().has_error();
    client.reset();
    watcher.reset();
    _exit(told && refused && silent ? 0 : 1);
  }
  int status = -1;
  const bool ended = Within20s([&] { return waitpid(child, &status, WNOHANG) == child; });
  if (!ended) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  EXPECT_TRUE(ended);
  EXPECT_EQ(status, 0);
  Accept(client->Execute(MakeFrame(2))); // and the parent goes on
  EXPECT_TRUE(watcher->SendEvent(MakeEvent(0, 1)));
}

// Whatever the process's mask; and what its other threads make meanwhile is not closed to others.
TEST_F(LinkLimits, ASocketIsItsOwnersAndFilesOfOtherThreadsAreAsTheyWere) {
  const mode_t mask = umask(0);
  std::atomic<bool> over{false};
  std::size_t made = 0;
  std::size_t closed = 0;
  std::thread other([&] {
    const std::string file = this->Folder + "/file";
    while (!over) {
      struct stat info = {};
      const int descriptor = open(file.c_str(), O_CREAT | O_EXCL | O_WRONLY | O_CLOEXEC, 0666);
      made += fstat(descriptor, &info) == 0 ? 1 : 0;
      closed += (info.st_mode & 0777) != 0666 ? 1 : 0;
      close(descriptor);
      unlink(file.c_str());
    }
  });
  for (int i = 0; i < 50; ++i) {
    const session::Server server(this->Options);
    struct stat info = {};
    EXPECT_EQ(lstat((this->Folder + "/socket").c_str(), &info), 0);
    EXPECT_EQ(info.st_mode & 0777, 0700u);
  }
  over = true;
  other.join();
  umask(mask);
  EXPECT_GT(made, 0u);
  EXPECT_EQ(closed, 0u);
}

} // namespace
} // namespace dspace::testing
