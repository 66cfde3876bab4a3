// A server of a plain interpreter (no pictures), in threads of the test's own process.
#ifndef DSPACE_LINK_TEST_SUPPORT_H
#define DSPACE_LINK_TEST_SUPPORT_H

#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <string>
#include <thread>

#include <unistd.h>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/ledger/Ledger.h>
#include <dspace/link/client/RemoteClient.h>
#include <dspace/link/server/Server.h>
#include <dspace/link/watching/Watcher.h>

namespace dspace::testing {

// An interpreter that a server feeds and that feeds viewers.
struct ServedInterpreter {
  session::Interpreter interpreter;
  session::Ledger ledger{&interpreter.GetState()};
  session::Server* server = nullptr;

  ServedInterpreter() {
    this->interpreter.AddListener([this](const v1::Command& command, const v1::Reply& reply) {
      this->ledger.Add(command, reply);
      if (this->server) {
        this->server->Publish(command);
      }
    });
  }
  session::Server::SessionWork Work() {
    return {[this](v1::Command& command) { return this->interpreter.Execute(command); },
            [this] { return this->ledger.Commands(); }};
  }
};

class LinkTest : public ::testing::Test {
protected:
  void SetUp() override {
    char name[] = "/tmp/dspace-link-XXXXXX";
    this->Folder = mkdtemp(name);
    this->Options.listen = "unix:" + this->Folder + "/socket";
  }
  void TearDown() override {
    this->StopServer();
    std::filesystem::remove_all(this->Folder);
  }

  void StartServer() {
    this->Server = std::make_unique<session::Server>(this->Options);
    this->Served = std::make_unique<ServedInterpreter>();
    this->Served->server = this->Server.get();
    this->Thread = std::thread([this] {
      while (this->Server->Run(this->Served->Work(), 10)) {
      }
    });
  }
  void StopServer() {
    if (this->Server) {
      this->Server->Stop();
      this->Thread.join();
      this->Server.reset();
      this->Served.reset();
    }
  }

  session::RemoteClientOptions ClientOptions(const std::string& name = "test") const {
    session::RemoteClientOptions options;
    options.address = this->Server ? this->Server->Address() : this->Options.listen;
    options.name = name;
    options.timeout_s = 30;
    return options;
  }

  std::string Folder;
  session::ServerOptions Options;
  std::unique_ptr<session::Server> Server;
  std::unique_ptr<ServedInterpreter> Served;
  std::thread Thread;
};

inline v1::Command MakeScene() {
  v1::Command command;
  command.mutable_create_scene();
  return command;
}

inline v1::Command MakeFrame(std::uint64_t id) {
  v1::Command command;
  command.mutable_create_frame()->set_id(id);
  command.mutable_create_frame()->set_name("frame " + std::to_string(id));
  return command;
}

// One step: each of the frames at x = value.
inline v1::Command MakeStep(const std::vector<std::uint64_t>& frames, double value) {
  v1::Command command;
  for (const std::uint64_t frame : frames) {
    command.mutable_set_poses()->add_frame(frame);
    for (const double v : {value, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
      command.mutable_set_poses()->add_pose(v);
    }
  }
  return command;
}

inline v1::Command AskPoses(const std::vector<std::uint64_t>& frames) {
  v1::Command command;
  command.mutable_get_poses()->set_local(true);
  for (const std::uint64_t frame : frames) {
    command.mutable_get_poses()->add_frame(frame);
  }
  return command;
}

inline void Accept(const v1::Reply& reply) {
  ASSERT_FALSE(reply.has_error()) << reply.error().message();
}

} // namespace dspace::testing

#endif
