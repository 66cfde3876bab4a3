// Either side of the link is killed at random moments.
#include "LinkTestSupport.h"

#include <chrono>
#include <csignal>
#include <random>

#include <spawn.h>
#include <sys/wait.h>

extern char** environ;

namespace dspace::testing {
namespace {

using session::RemoteClient;

// A LinkProcess; killed with the object.
class Child {
public:
  Child(const char* what, const std::string& address) {
    int ends[2];
    EXPECT_EQ(pipe(ends), 0);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], 1);
    posix_spawn_file_actions_addclose(&actions, ends[0]);
    posix_spawn_file_actions_addclose(&actions, ends[1]);
    std::string program = LINK_PROCESS;
    std::string word = what;
    std::string place = address;
    char* arguments[] = {program.data(), word.data(), place.data(), nullptr};
    EXPECT_EQ(posix_spawn(&this->Id_, program.c_str(), &actions, nullptr, arguments, environ), 0);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    char text[6] = {};
    EXPECT_EQ(read(ends[0], text, 6), 6) << what; // "ready\n"
    close(ends[0]);
  }
  ~Child() { this->Kill(); }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  void Kill() {
    if (this->Id_ > 0) {
      kill(this->Id_, SIGKILL);
      waitpid(this->Id_, nullptr, 0);
      this->Id_ = 0;
    }
  }

private:
  pid_t Id_ = 0;
};

using LinkKills = LinkTest;

TEST_F(LinkKills, TheWriterDiesAndTheStateIsWhole) {
  this->StartServer();
  std::mt19937 random(11);
  double before = -1;
  for (int i = 0; i < 12; ++i) { // a process takes a while to start
    {
      Child driver("drive", this->Server->Address());
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 40000));
    }
    auto options = this->ClientOptions("after");
    options.takeOver = true; // it may not have been noticed yet
    RemoteClient client(options);
    const v1::Reply reply = client.Execute(AskPoses({2, 3}));
    ASSERT_FALSE(reply.has_error()) << reply.error().message();
    EXPECT_EQ(reply.poses().pose(0), reply.poses().pose(8)); // no half step
    EXPECT_GE(reply.poses().pose(0), before);                // and none back
    before = reply.poses().pose(0);
  }
  EXPECT_GT(before, 0);
}

TEST_F(LinkKills, TheServerDiesAndTheClientIsToldInTime) {
  std::mt19937 random(12);
  for (int i = 0; i < 12; ++i) { // a process takes a while to start
    Child server("serve", this->Options.listen);
    auto options = this->ClientOptions();
    options.timeout_s = 20;
    RemoteClient client(options);
    Accept(client.Execute(MakeScene()));
    Accept(client.Execute(MakeFrame(2)));
    std::unique_ptr<Child> next;
    std::thread killer([&] {
      std::this_thread::sleep_for(std::chrono::microseconds(random() % 40000));
      server.Kill();
      next = std::make_unique<Child>("serve", this->Options.listen);
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
    EXPECT_NE(reply.error().message().find("started anew"), std::string::npos)
        << reply.error().message();
  }
}

} // namespace
} // namespace dspace::testing
