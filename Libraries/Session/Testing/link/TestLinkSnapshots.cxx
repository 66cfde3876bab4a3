// Snapshots of any size: in parts, whole for who takes no parts, and an error where that is too
// large.
#include "LinkTestSupport.h"

#include <dspace/link/LinkChannel.h>
#include <dspace/link/SnapshotMessages.h>

namespace dspace::testing {
namespace {

using session::RemoteClient;
using session::SnapshotJoin;
using session::SnapshotMessages;
using session::Watcher;

class SnapshotTest : public LinkTest {
protected:
  static constexpr int Frames = 3000;

  void BuildFrames(RemoteClient& client) {
    Accept(client.Execute(MakeScene()));
    for (std::uint64_t id = 2; id < 2 + Frames; ++id) {
      Accept(client.Send(MakeFrame(id)));
    }
    Accept(client.Flush());
  }

  session::WatcherOptions WatchOptions() const {
    session::WatcherOptions options;
    options.address = this->Server->Address();
    return options;
  }

  static std::string FramesOf(session::Interpreter& interpreter) {
    v1::Command list;
    list.mutable_list_frames();
    return interpreter.Execute(list).SerializeAsString();
  }

  // The first messages that a viewer hears, until the snapshot is whole.
  std::vector<v1::WatchReply> Hear(bool parts) {
    const auto channel = session::MakeChannel(this->Server->Address(), {}, 20);
    const auto stub = v1::Dspace::NewStub(channel);
    grpc::ClientContext context;
    context.set_deadline(std::chrono::system_clock::now() + std::chrono::seconds(20));
    v1::WatchRequest request;
    request.set_protocol("dspace.v1");
    request.set_parts(parts);
    const auto stream = stub->Watch(&context, request);
    std::vector<v1::WatchReply> heard;
    do {
      heard.emplace_back();
      if (!stream->Read(&heard.back())) {
        ADD_FAILURE() << stream->Finish().error_message();
        return heard;
      }
    } while (heard.back().snapshot().more());
    context.TryCancel();
    stream->Finish();
    return heard;
  }
};

TEST_F(SnapshotTest, OneThatIsLargerThanAMessageReachesAViewerWhole) {
  this->Options.maximumMessage = 10000;
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  this->BuildFrames(client);
  const std::vector<v1::WatchReply> parts = this->Hear(true);
  EXPECT_GT(parts.size(), 5u);
  session::Interpreter second;
  std::size_t bytes = 0;
  for (std::size_t i = 0; i < parts.size(); ++i) {
    EXPECT_LE(parts[i].ByteSizeLong(), 10000u);
    EXPECT_EQ(parts[i].snapshot().part(), i);
    EXPECT_EQ(parts[i].sequence(), std::uint64_t(Frames) + 1);
    bytes += parts[i].ByteSizeLong();
    for (v1::Command command : parts[i].snapshot().command()) {
      Accept(second.Execute(command));
    }
  }
  EXPECT_GT(bytes, 50000u);
  const std::string frames = FramesOf(this->Served->interpreter);
  EXPECT_EQ(FramesOf(second), frames);
  // One of before there were parts.
  const std::vector<v1::WatchReply> whole = this->Hear(false);
  ASSERT_EQ(whole.size(), 1u);
  session::Interpreter third;
  for (v1::Command command : whole[0].snapshot().command()) {
    Accept(third.Execute(command));
  }
  EXPECT_EQ(FramesOf(third), frames);
  // And one of this version, for whom it is one message too.
  Watcher watcher(this->WatchOptions());
  v1::WatchReply message;
  ASSERT_TRUE(watcher.Take(message, 20));
  EXPECT_EQ(message.snapshot().SerializeAsString(), whole[0].snapshot().SerializeAsString());
}

// Larger than what may wait for a viewer, while a simulation goes on.
TEST_F(SnapshotTest, OneThatIsLargeArrivesHoweverMuchComesAfterIt) {
  this->Options.maximumMessage = 4000;
  this->Options.unreadBytes = 20000;
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  this->BuildFrames(client);
  constexpr int Trails = 2000; // of 3.6 kB
  for (int i = 0; i < Trails; ++i) {
    v1::Command create;
    create.mutable_create_trail()->set_capacity(200);
    create.mutable_create_trail()->mutable_object()->set_id(std::uint32_t(100 + i));
    create.mutable_create_trail()->mutable_object()->set_name("trail " + std::to_string(i));
    Accept(client.Send(create));
    v1::Command append;
    append.mutable_append_trail()->set_object(std::uint32_t(100 + i));
    for (int j = 0; j < 450; ++j) {
      append.mutable_append_trail()->add_point(i + 0.01 * j);
    }
    Accept(client.Send(append));
  }
  Accept(client.Flush());
  auto options = this->WatchOptions();
  options.waitingBytes = 1;
  std::atomic<bool> enough{false};
  std::thread simulation([&] {
    for (int i = 0; !enough; ++i) {
      Accept(client.Send(MakeStep({2, 3, 4, 5, 6, 7, 8, 9}, i)));
    }
    Accept(client.Flush());
  });
  Watcher watcher(options);
  v1::WatchReply message;
  int snapshots = 0;
  for (int i = 0; i < 200 && snapshots < 3 && watcher.Take(message, 60); ++i) {
    std::this_thread::sleep_for(std::chrono::milliseconds(2)); // it is slow
    if (message.has_snapshot()) {
      ++snapshots;
      EXPECT_GE(message.snapshot().command_size(), 1 + Frames + 2 * Trails);
    }
  }
  enough = true;
  simulation.join();
  EXPECT_GT(snapshots, 0);
}

TEST_F(SnapshotTest, OneThatIsTooLargeIsAnError) {
  std::vector<v1::Command> commands{MakeScene()};
  for (std::uint64_t id = 2; id < 102; ++id) {
    commands.push_back(MakeFrame(id));
  }
  session::SnapshotLimits limits;
  limits.part = 300;
  limits.largest = 1000;
  SnapshotMessages messages(commands, 7, limits);
  EXPECT_GT(messages.For(true).size(), 5u);
  try {
    messages.For(false);
    FAIL() << "it was made whole";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::Resource);
    EXPECT_NE(std::string(error.what()).find("up to 1000"), std::string::npos) << error.what();
  }
  commands.push_back(MakeFrame(102));
  commands.back().mutable_create_frame()->set_name(std::string(2000, 'x'));
  SnapshotMessages large(commands, 7, limits);
  EXPECT_THROW(large.For(true), Error);
  // Parts come together again; one that is missing is found out.
  SnapshotJoin join;
  std::vector<v1::WatchReply> parts;
  for (const SnapshotMessages::Message& each : messages.For(true)) {
    parts.push_back(*each.reply);
  }
  v1::WatchReply part = parts[0];
  EXPECT_FALSE(join.Take(part));
  part = parts[0]; // another one begins
  EXPECT_FALSE(join.Take(part));
  part = parts[2];
  EXPECT_THROW(join.Take(part), Error);
}

// A viewer that has been connected says why it is not any more, and goes on once that is over.
TEST_F(SnapshotTest, AViewerReportsWhyItIsRejected) {
  this->Options.unreadBytes = 20000;
  this->Server = std::make_unique<session::Server>(this->Options);
  this->Served = std::make_unique<ServedInterpreter>();
  this->Served->server = this->Server.get();
  std::atomic<bool> fails{false};
  auto work = this->Served->Work();
  work.snapshot = [&, plain = work.snapshot]() {
    if (fails) {
      throw Error(Error::Kind::Resource, "snapshot", "it has no end");
    }
    return plain();
  };
  this->Thread = std::thread([&] {
    while (this->Server->Run(work, 10)) {
    }
  });
  RemoteClient client(this->ClientOptions());
  this->BuildFrames(client);
  auto options = this->WatchOptions();
  options.waitingBytes = 1;
  Watcher watcher(options);
  EXPECT_EQ(watcher.Rejection(), "");
  fails = true;
  v1::WatchReply message;
  std::string why;
  for (int i = 0; i < 3000 && why.empty(); ++i) { // it does not read, and falls behind
    for (int j = 0; j < 100; ++j) {
      Accept(client.Send(MakeStep({2, 3, 4, 5, 6, 7, 8, 9}, i)));
    }
    Accept(client.Flush());
    if (this->Server->GetCounts().waitingBytes < 20000) {
      while (watcher.Take(message, 0.0)) { // until it starts again
      }
    }
    why = watcher.Rejection();
  }
  EXPECT_NE(why.find("it has no end"), std::string::npos) << why;
  EXPECT_FALSE(watcher.Connected());
  fails = false;
  bool again = false;
  for (int i = 0; i < 1000 && !again; ++i) {
    again = watcher.Take(message, 1.0) && message.has_snapshot();
  }
  EXPECT_TRUE(again);
  EXPECT_EQ(watcher.Rejection(), "");
  this->StopServer(); // whose thread has references to what is above
}

} // namespace
} // namespace dspace::testing
