// One writer and viewers over the link, without pictures.
#include "LinkTestSupport.h"

#include <fstream>

namespace dspace::testing {
namespace {

using session::RemoteClient;
using session::Watcher;

TEST_F(LinkTest, AnswersAreThoseOfALocalInterpreter) {
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  session::Interpreter local;
  v1::Command wrong = MakeFrame(7); // its parent is not there
  wrong.mutable_create_frame()->set_parent(99);
  v1::Command unknown;
  unknown.GetReflection()->MutableUnknownFields(&unknown)->AddVarint(999, 1);
  v1::Command list;
  list.mutable_list_frames();
  for (const v1::Command& each : {MakeScene(), MakeFrame(5), MakeStep({5}, 2.5), wrong, unknown,
                                  MakeScene(), AskPoses({5}), list}) {
    v1::Command command = each;
    EXPECT_EQ(client.Execute(each).SerializeAsString(), local.Execute(command).SerializeAsString())
        << each.ShortDebugString();
  }
}

TEST_F(LinkTest, LockstepLosesNothingAndRepeatsNothing) {
  this->StartServer();
  // Every command that is carried out, in order.
  std::vector<double> seen;
  this->Served->interpreter.AddListener([&](const v1::Command& command, const v1::Reply&) {
    if (command.has_set_time()) {
      seen.push_back(command.set_time().time_s());
    }
  });
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  constexpr int Steps = 10000;
  v1::Command command;
  for (int i = 0; i < Steps; ++i) {
    command.mutable_set_time()->set_time_s(i);
    Accept(client.Execute(command));
  }
  this->StopServer();
  ASSERT_EQ(seen.size(), std::size_t(Steps));
  for (int i = 0; i < Steps; ++i) {
    ASSERT_EQ(seen[std::size_t(i)], i);
  }
}

TEST_F(LinkTest, ASecondWriterIsRejectedOrTakesOver) {
  this->StartServer();
  RemoteClient first(this->ClientOptions("first"));
  Accept(first.Execute(MakeScene()));
  try {
    RemoteClient second(this->ClientOptions("second"));
    FAIL() << "a second writer was let in";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::AlreadyExists);
    EXPECT_NE(std::string(error.what()).find("'first' is the driver"), std::string::npos)
        << error.what();
  }
  Accept(first.Execute(MakeFrame(2)));
  auto options = this->ClientOptions("second");
  options.takeOver = true;
  RemoteClient second(options);
  Accept(second.Execute(MakeFrame(3)));
  EXPECT_EQ(first.TakeEvents([](const v1::ViewerEvent&) {}, 1e6), 0u); // not so long
  EXPECT_NE(first.Broken().error().message().find("'second' has taken over"), std::string::npos);
  EXPECT_FALSE(second.Broken().has_error());
  const v1::Reply reply = first.Execute(MakeFrame(4));
  EXPECT_NE(reply.error().message().find("'second' has taken over"), std::string::npos)
      << reply.ShortDebugString();
  v1::Command list;
  list.mutable_list_frames();
  EXPECT_EQ(second.Execute(list).frames().frame_size(), 3); // the root, 2, 3
}

TEST_F(LinkTest, UnmovedFramesCostNothingAndTheStateIsTheSame) {
  this->StartServer();
  auto options = this->ClientOptions();
  RemoteClient client(options);
  session::Interpreter local;
  const auto both = [&](const v1::Command& each) {
    v1::Command command = each;
    const v1::Reply reply = local.Execute(command);
    const v1::Reply remote = client.Execute(each);
    EXPECT_EQ(remote.error().message(), reply.error().message());
  };
  both(MakeScene());
  std::vector<std::uint64_t> frames;
  for (std::uint64_t id = 2; id < 12; ++id) {
    both(MakeFrame(id));
    frames.push_back(id);
  }
  both(MakeStep(frames, 1));
  const auto before = client.GetCounts();
  for (int i = 0; i < 100; ++i) {
    both(MakeStep(frames, 1));
  }
  EXPECT_EQ(client.GetCounts().sent, before.sent);
  EXPECT_EQ(client.GetCounts().posesLeftOut - before.posesLeftOut, 1000u);
  // One of them moves; a zero of the other sign is another pose.
  v1::Command step = MakeStep(frames, 1);
  step.mutable_set_poses()->set_pose(8 * 3, 4);
  step.mutable_set_poses()->set_pose(8 * 4 + 1, -0.0);
  both(step);
  EXPECT_EQ(client.GetCounts().posesLeftOut - before.posesLeftOut, 1008u);
  // A frame that stands twice is refused as ever, and so is one that is gone.
  both(MakeStep({2, 2}, 1));
  v1::Command remove;
  remove.mutable_remove_frame()->set_frame(2);
  both(remove);
  both(MakeStep(frames, 1));
  // What moves frames by other means makes them be sent again.
  v1::Command hang;
  hang.mutable_reparent_frame()->set_frame(4);
  hang.mutable_reparent_frame()->set_parent(3);
  hang.mutable_reparent_frame()->set_keep_world_pose(true);
  frames.erase(frames.begin());
  both(MakeStep(frames, 1));
  both(hang);
  both(MakeStep(frames, 1));
  v1::Command ask = AskPoses(frames);
  EXPECT_EQ(client.Execute(ask).SerializeAsString(), local.Execute(ask).SerializeAsString());
}

TEST_F(LinkTest, AMessageBeyondTheLimitIsRejectedAndTheLinkContinues) {
  this->Options.maximumMessage = 10000;
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  v1::Command large = MakeFrame(2);
  large.mutable_create_frame()->set_name(std::string(20000, 'x'));
  const v1::Reply reply = client.Execute(large);
  EXPECT_EQ(reply.error().kind(), v1::Error::RESOURCE);
  EXPECT_NE(reply.error().message().find("up to 10000"), std::string::npos);
  Accept(client.Execute(MakeFrame(2)));
}

TEST_F(LinkTest, AddressesBeyondThisMachineNeedCertificates) {
  for (const char* address : {"0.0.0.0:0", "[::]:0", "192.168.1.1:0", "127.0.0.1.example.org:0",
                              "localhost.example.org:0", "example.org:0"}) {
    session::ServerOptions options;
    options.listen = address;
    try {
      session::Server server(options);
      ADD_FAILURE() << address << " was accepted";
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::InvalidArgument);
      EXPECT_NE(std::string(error.what()).find("insecure"), std::string::npos) << error.what();
    }
  }
  for (const char* address : {"", ":1", "host", "host:", "host:65536", "host:-1", "host:1x",
                              "a b:1", "::1:1", "unix:", "http://host:1", "dns:///host:1"}) {
    EXPECT_THROW(session::LinkAddress::Parse(address), Error) << address;
  }
  for (const char* address : {"127.0.0.1:0", "127.9.9.9:1", "localhost:0", "[::1]:0"}) {
    EXPECT_TRUE(session::LinkAddress::Parse(address).loopback) << address;
  }
}

TEST_F(LinkTest, ASocketThatIsInUseIsNotTakenAway) {
  this->StartServer();
  EXPECT_THROW(session::Server other(this->Options), Error);
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  // Somebody's file is no socket.
  const std::string file = this->Folder + "/file";
  std::ofstream(file) << "mine";
  session::ServerOptions options;
  options.listen = "unix:" + file;
  EXPECT_THROW(session::Server other(options), Error);
  EXPECT_TRUE(std::filesystem::is_regular_file(file));
}

TEST_F(LinkTest, AMissingServerIsAnErrorWithinTheTimeout) {
  auto options = this->ClientOptions();
  options.timeout_s = 0.5;
  EXPECT_THROW(RemoteClient client(options), Error);
  session::WatcherOptions watch;
  watch.address = options.address;
  watch.timeout_s = 0.5;
  EXPECT_THROW(Watcher watcher(watch), Error);
}

// Applies all that comes until the state has this sequence number; false after 20 s.
bool Follow(Watcher& watcher, session::Interpreter& copy, std::uint64_t sequence) {
  v1::WatchReply message;
  while (watcher.Take(message, 20)) {
    if (message.has_snapshot()) {
      for (v1::Command& command : *message.mutable_snapshot()->mutable_command()) {
        EXPECT_FALSE(copy.Execute(command).has_error());
      }
    } else if (message.has_command()) {
      EXPECT_FALSE(copy.Execute(*message.mutable_command()).has_error());
    }
    if (message.sequence() >= sequence) {
      return true;
    }
  }
  return false;
}

TEST_F(LinkTest, TenViewersSeeTheSameState) {
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  session::WatcherOptions options;
  options.address = this->Server->Address();
  std::vector<std::unique_ptr<Watcher>> watchers;
  std::vector<std::uint64_t> frames;
  std::uint64_t sequence = 1;
  for (std::uint64_t id = 2; id < 12; ++id) { // each comes at another moment
    frames.push_back(id);
    Accept(client.Execute(MakeFrame(id)));
    Accept(client.Execute(MakeStep(frames, double(id))));
    watchers.push_back(std::make_unique<Watcher>(options));
    sequence += 2;
  }
  for (int i = 0; i < 200; ++i) {
    Accept(client.Send(MakeStep(frames, i + 100.5)));
    ++sequence;
  }
  Accept(client.Flush());
  const std::string state = client.Execute(AskPoses(frames)).SerializeAsString();
  for (const auto& watcher : watchers) {
    session::Interpreter copy;
    ASSERT_TRUE(Follow(*watcher, copy, sequence));
    v1::Command ask = AskPoses(frames);
    EXPECT_EQ(copy.Execute(ask).SerializeAsString(), state);
  }
}

TEST_F(LinkTest, AViewerThatDoesNotReadGetsANewSnapshotAndDelaysNoOther) {
  this->Options.unreadBytes = 200000;
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  std::vector<std::uint64_t> frames;
  for (std::uint64_t id = 2; id < 102; ++id) {
    frames.push_back(id);
    Accept(client.Execute(MakeFrame(id)));
  }
  session::WatcherOptions options;
  options.address = this->Server->Address();
  options.waitingBytes = 1;
  Watcher stalled(options);
  constexpr int Steps = 3000; // of 7 kB each: a hundred times what may wait
  std::size_t most = 0;
  for (int i = 0; i < Steps; ++i) {
    Accept(client.Send(MakeStep(frames, i)));
    if (i % 100 == 0) {
      Accept(client.Flush());
      most = std::max(most, this->Server->GetCounts().waitingBytes);
    }
  }
  Accept(client.Flush());
  EXPECT_LT(most, 250000u);
  session::Interpreter copy;
  v1::WatchReply message;
  bool again = false;
  std::uint64_t last = 0;
  std::vector<v1::Command> commands;
  while (last < std::uint64_t(Steps) + 101 && stalled.Take(message, 20)) {
    again = again || (message.has_snapshot() && last > 0);
    last = message.sequence();
    if (message.has_snapshot()) {
      commands.assign(message.snapshot().command().begin(), message.snapshot().command().end());
    } else if (message.has_command()) {
      commands.push_back(message.command());
    }
  }
  EXPECT_TRUE(again);
  for (v1::Command& command : commands) {
    ASSERT_FALSE(copy.Execute(command).has_error()) << command.ShortDebugString();
  }
  v1::Command ask = AskPoses(frames);
  EXPECT_EQ(copy.Execute(ask).SerializeAsString(), client.Execute(ask).SerializeAsString());
}

TEST_F(LinkTest, EventsOfViewersReachTheWriter) {
  this->StartServer();
  session::WatcherOptions options;
  options.address = this->Server->Address();
  options.name = "operator";
  Watcher watcher(options);
  v1::ViewerEvent event;
  event.mutable_answer()->set_question("deploy?");
  event.mutable_answer()->set_answer("go");
  EXPECT_FALSE(watcher.SendEvent(event)); // nobody drives
  RemoteClient client(this->ClientOptions());
  EXPECT_TRUE(watcher.SendEvent(event));
  std::vector<v1::ViewerEvent> heard;
  client.TakeEvents([&](const v1::ViewerEvent& each) { heard.push_back(each); }, 20);
  ASSERT_EQ(heard.size(), 1u);
  EXPECT_EQ(heard[0].answer().answer(), "go");
  EXPECT_EQ(heard[0].from(), "operator");
}

} // namespace
} // namespace dspace::testing
