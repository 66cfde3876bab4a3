// The same client goes on with the same living server after connections that broke at any byte.
#include "LinkProxy.h"
#include "LinkTestSupport.h"

namespace dspace::testing {
namespace {

using session::RemoteClient;
using session::Watcher;

class LinkBroken : public LinkTest {
protected:
  // A server of which every step that it carries out is kept, in order.
  void Serve() {
    this->Options.maximumConnections = 200;
    this->Options.keepalive_s = 1;
    this->StartServer();
    this->Served->interpreter.AddListener([this](const v1::Command& command, const v1::Reply&) {
      if (command.has_set_time()) {
        this->Seen.push_back(command.set_time().time_s());
      }
    });
  }
  session::RemoteClientOptions Through(const std::string& socket) const {
    auto options = this->ClientOptions();
    options.address = "unix:" + this->Folder + "/" + socket;
    options.keepalive_s = 0.5;
    options.timeout_s = 60;
    return options;
  }
  std::unique_ptr<LinkProxy> MakeProxy(const std::string& socket, unsigned seed, double bytes) {
    return std::make_unique<LinkProxy>(this->Folder + "/" + socket, this->Folder + "/socket", seed,
                                       bytes);
  }
  void ExpectSteps(int steps) {
    this->StopServer();
    ASSERT_EQ(this->Seen.size(), std::size_t(steps));
    for (int i = 0; i < steps; ++i) {
      ASSERT_EQ(this->Seen[std::size_t(i)], i);
    }
  }

  std::vector<double> Seen;
};

v1::Command MakeTime(double time_s) {
  v1::Command command;
  command.mutable_set_time()->set_time_s(time_s);
  return command;
}

constexpr int Steps = 10000;

TEST_F(LinkBroken, LockstepLosesNothingAndRepeatsNothing) {
  this->Serve();
  const auto proxy = this->MakeProxy("proxy", 21, 80000);
  {
    RemoteClient client(this->Through("proxy"));
    Accept(client.Execute(MakeScene()));
    v1::Command ask;
    ask.mutable_get_time();
    for (int i = 0; i < Steps; ++i) {
      const v1::Reply reply = client.Execute(MakeTime(i));
      ASSERT_FALSE(reply.has_error()) << i << ": " << reply.error().message();
      if (i % 10 == 0) { // the answer is this command's, not one of another
        ASSERT_EQ(client.Execute(ask).time().time_s(), i);
      }
    }
    EXPECT_GT(client.GetCounts().reconnections, 10u);
    EXPECT_GT(proxy->Cuts(), 10);
    EXPECT_GT(proxy->Dumb(), 0);
  }
  this->ExpectSteps(Steps);
}

TEST_F(LinkBroken, FreeRunningLosesNothingAndRepeatsNothing) {
  this->Serve();
  const auto proxy = this->MakeProxy("proxy", 22, 30000);
  {
    RemoteClient client(this->Through("proxy"));
    Accept(client.Execute(MakeScene()));
    std::mt19937 random(1);
    v1::Command wrong = MakeFrame(5000);
    wrong.mutable_create_frame()->set_parent(99999);
    for (int i = 0; i < Steps; ++i) {
      const v1::Reply reply = client.Send(MakeTime(i));
      ASSERT_FALSE(reply.has_error()) << i << ": " << reply.error().message();
      if (random() % 200 == 0) {
        Accept(client.Flush());
        ASSERT_FALSE(client.Send(wrong).has_error()); // an error comes once, whatever is cut
        ASSERT_EQ(client.Flush().error().kind(), v1::Error::NOT_FOUND);
        Accept(client.Flush());
      }
    }
    Accept(client.Flush());
    EXPECT_GT(client.GetCounts().reconnections, 5u);
  }
  this->ExpectSteps(Steps);
}

TEST_F(LinkBroken, AViewerEndsUpWithTheServersState) {
  this->Serve();
  const auto proxy = this->MakeProxy("proxy", 23, 100000);
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  std::vector<std::uint64_t> frames;
  for (std::uint64_t id = 2; id < 22; ++id) {
    frames.push_back(id);
    Accept(client.Execute(MakeFrame(id)));
  }
  session::WatcherOptions options;
  options.address = "unix:" + this->Folder + "/proxy";
  options.keepalive_s = 0.5;
  options.timeout_s = 30;
  Watcher watcher(options);
  std::uint64_t sequence = 21;
  auto copy = std::make_unique<session::Interpreter>();
  std::uint64_t at = 0;
  int snapshots = 0;
  v1::WatchReply message;
  const auto hear = [&](double wait_s) {
    if (!watcher.Take(message, wait_s)) {
      return false;
    }
    if (message.has_snapshot()) {
      ++snapshots;
      copy = std::make_unique<session::Interpreter>();
      for (v1::Command& command : *message.mutable_snapshot()->mutable_command()) {
        EXPECT_FALSE(copy->Execute(command).has_error()) << command.ShortDebugString();
      }
    } else if (message.has_command()) {
      EXPECT_EQ(message.sequence(), at + 1); // none is left out, none comes twice
      EXPECT_FALSE(copy->Execute(*message.mutable_command()).has_error());
    }
    at = message.sequence();
    return true;
  };
  for (int i = 0; i < 2000; ++i) {
    Accept(client.Send(MakeStep(frames, i)));
    ++sequence;
    if (i % 100 == 99) {
      Accept(client.Flush());
      while (at < sequence) {
        ASSERT_TRUE(hear(20));
      }
    }
  }
  Accept(client.Flush());
  proxy->Heal();
  while (at < sequence) {
    ASSERT_TRUE(hear(20));
  }
  EXPECT_GT(snapshots, 5);
  EXPECT_GT(proxy->Cuts(), 5);
  v1::Command ask = AskPoses(frames);
  EXPECT_EQ(copy->Execute(ask).SerializeAsString(), client.Execute(ask).SerializeAsString());
}

} // namespace
} // namespace dspace::testing
