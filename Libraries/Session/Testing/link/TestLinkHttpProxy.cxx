// With an HTTP proxy in the environment, as behind a company's: the link goes straight to its
// address.
#include "LinkTestSupport.h"

#include <netinet/in.h>
#include <sys/socket.h>

#include <grpcpp/grpcpp.h>

namespace dspace::testing {
namespace {

// Names a port where nobody listens as the proxy of everything, until the test ends.
class LinkHttpProxy : public LinkTest {
protected:
  void SetUp() override {
    LinkTest::SetUp();
    this->Options.listen = "127.0.0.1:0";
    this->Dead_ = socket(AF_INET, SOCK_STREAM, 0); // taken, so that nobody else listens there
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(to);
    ASSERT_EQ(bind(this->Dead_, reinterpret_cast<sockaddr*>(&to), size), 0);
    ASSERT_EQ(getsockname(this->Dead_, reinterpret_cast<sockaddr*>(&to), &size), 0);
    const std::string proxy = "http://127.0.0.1:" + std::to_string(ntohs(to.sin_port));
    for (const char* name : Names) {
      setenv(name, proxy.c_str(), 1);
    }
    for (const char* name : {"no_proxy", "no_grpc_proxy"}) {
      unsetenv(name);
    }
  }
  void TearDown() override {
    LinkTest::TearDown();
    for (const char* name : Names) {
      unsetenv(name);
    }
    close(this->Dead_);
  }

  static constexpr const char* Names[] = {"http_proxy", "https_proxy", "grpc_proxy"};

private:
  int Dead_ = -1;
};

TEST_F(LinkHttpProxy, TheLinkGoesPastIt) {
  this->StartServer();
  const std::string address = this->Server->Address();
  // gRPC by itself would go to the proxy: else this would test nothing.
  const auto channel = grpc::CreateChannel(address, grpc::InsecureChannelCredentials());
  grpc_connectivity_state state = channel->GetState(true);
  while (state != GRPC_CHANNEL_READY && state != GRPC_CHANNEL_TRANSIENT_FAILURE) {
    channel->WaitForStateChange(state, std::chrono::system_clock::now() + std::chrono::seconds(1));
    state = channel->GetState(true);
  }
  EXPECT_EQ(state, GRPC_CHANNEL_TRANSIENT_FAILURE);

  session::RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  Accept(client.Execute(MakeFrame(2)));
  Accept(client.Execute(MakeStep({2}, 7)));
  EXPECT_EQ(client.Execute(AskPoses({2})).poses().pose(0), 7);
  session::WatcherOptions options;
  options.address = address;
  session::Watcher watcher(options);
  v1::WatchReply message;
  EXPECT_TRUE(watcher.Take(message, 20));
  EXPECT_TRUE(message.has_snapshot());
}

} // namespace
} // namespace dspace::testing
