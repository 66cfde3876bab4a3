// The diagnoses of failed connections, compared with sockets in known states.
#include <fstream>

#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/un.h>

#include <dspace/link/LinkDiagnosis.h>

#include "LinkTestSupport.h"

namespace dspace::testing {
namespace {

using session::DiagnoseConnection;

class LinkDiagnosis : public LinkTest {
protected:
  // A listening socket that takes nobody in, until the test ends.
  void Listen(const std::string& path) {
    this->Descriptor = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un to{};
    to.sun_family = AF_UNIX;
    path.copy(to.sun_path, sizeof(to.sun_path) - 1);
    ASSERT_EQ(bind(this->Descriptor, reinterpret_cast<sockaddr*>(&to), sizeof(to)), 0);
    ASSERT_EQ(listen(this->Descriptor, 8), 0);
  }
  // A port that the system gives; it is listened to or not.
  int Port(bool listens) {
    this->Descriptor = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in to{};
    to.sin_family = AF_INET;
    to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof(to);
    EXPECT_EQ(bind(this->Descriptor, reinterpret_cast<sockaddr*>(&to), size), 0);
    EXPECT_TRUE(!listens || listen(this->Descriptor, 8) == 0);
    EXPECT_EQ(getsockname(this->Descriptor, reinterpret_cast<sockaddr*>(&to), &size), 0);
    return ntohs(to.sin_port);
  }
  void TearDown() override {
    if (this->Descriptor >= 0) {
      close(this->Descriptor);
    }
    LinkTest::TearDown();
  }
  static void ExpectSays(const std::string& said, const std::string& expected) {
    EXPECT_NE(said.find(expected), std::string::npos) << said;
    EXPECT_NE(said.find("; accepted: "), std::string::npos) << said;
  }

  int Descriptor = -1;
};

TEST_F(LinkDiagnosis, OfASocket) {
  const std::string path = this->Folder + "/other";
  ExpectSays(DiagnoseConnection("unix:" + path, false), "the socket does not exist");
  std::ofstream(path) << "a file";
  ExpectSays(DiagnoseConnection("unix:" + path, false), "the file is not a socket");
  std::filesystem::remove(path);
  this->Listen(path);
  ExpectSays(DiagnoseConnection("unix:" + path, false), "requires certificates");
  ExpectSays(DiagnoseConnection("unix:" + path, true), "certificates of one authority");
  for (int i = 0; i < 20; ++i) { // none of which it takes in
    ExpectSays(DiagnoseConnection("unix:" + path, false), "does not accept this client");
  }
  close(this->Descriptor);
  this->Descriptor = -1;
  ExpectSays(DiagnoseConnection("unix:" + path, false),
             "no process listens there"); // the socket is left
}

TEST_F(LinkDiagnosis, OfAPort) {
  const std::string free = std::to_string(this->Port(false));
  ExpectSays(DiagnoseConnection("127.0.0.1:" + free, false), "no process listens there");
  ExpectSays(DiagnoseConnection("localhost:" + free, false), "no process listens there");
  close(this->Descriptor);
  const std::string taken = std::to_string(this->Port(true));
  ExpectSays(DiagnoseConnection("127.0.0.1:" + taken, false), "does not accept this client");
  ExpectSays(DiagnoseConnection("no.such.host.invalid:" + taken, false), "may be unknown");
}

TEST_F(LinkDiagnosis, IsWhatAClientSays) {
  auto options = this->ClientOptions();
  options.address = "unix:" + this->Folder + "/nobody";
  options.timeout_s = 0.5;
  session::WatcherOptions watch;
  watch.address = options.address;
  watch.timeout_s = 0.5;
  const auto said = [](const std::function<void()>& connect) {
    try {
      connect();
    } catch (const Error& error) {
      EXPECT_EQ(error.GetKind(), Error::Kind::DeadlineExceeded);
      return std::string(error.what());
    }
    return std::string();
  };
  for (const std::string& text : {said([&] { session::RemoteClient client(options); }),
                                  said([&] { session::Watcher watcher(watch); })}) {
    ExpectSays(text, "within 0.5 s: the socket does not exist");
  }
}

} // namespace
} // namespace dspace::testing
