// What a server and its clients let others cost them, who drives when, and what a child process of
// a client may do.
#include <csignal>
#include <stdexcept>

#include <grpcpp/grpcpp.h>
#include <sys/wait.h>

#include <dspace/session/ProcessName.h>
#include <dspace/session/service.grpc.pb.h>

#include "LinkTestSupport.h"

namespace dspace::testing {
namespace {

using Clock = std::chrono::steady_clock;
using session::RemoteClient;
using session::Watcher;

bool Within20s(const std::function<bool()>& done) {
  for (const auto end = Clock::now() + std::chrono::seconds(20); Clock::now() < end;) {
    if (done()) {
      return true;
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  return false;
}

// A stream of Drive, message by message, on a connection of its own.
class RawDrive {
public:
  RawDrive(const std::string& address, const std::string& key, const std::string& process = {}) {
    grpc::ChannelArguments arguments;
    arguments.SetInt(GRPC_ARG_USE_LOCAL_SUBCHANNEL_POOL, 1);
    this->Stub_ = v1::Dspace::NewStub(
        grpc::CreateCustomChannel(address, grpc::InsecureChannelCredentials(), arguments));
    this->Stream_ = this->Stub_->Drive(&this->Context_);
    v1::DriveRequest request;
    request.mutable_open()->set_protocol(session::LinkProtocol);
    request.mutable_open()->set_client("raw");
    request.mutable_open()->set_key(key);
    request.mutable_open()->set_process(process);
    v1::DriveReply reply;
    if (this->Stream_->Write(request) && this->Stream_->Read(&reply)) {
      this->Opened = reply.opened();
      this->IsOpen = reply.has_opened();
    }
  }
  ~RawDrive() { this->Break(); }
  // As a connection that is lost: without a goodbye.
  grpc::Status Break() {
    if (!this->Stream_) {
      return grpc::Status::OK;
    }
    this->Context_.TryCancel();
    const grpc::Status status = this->Stream_->Finish();
    this->Stream_.reset();
    return status;
  }
  void Send(std::uint64_t number, const v1::Command& command) {
    v1::DriveRequest request;
    request.mutable_send()->set_number(number);
    *request.mutable_send()->mutable_command() = command;
    EXPECT_TRUE(this->Stream_->Write(request));
  }
  // The events that come before the command of this number is done.
  int WaitFor(std::uint64_t number) {
    int events = 0;
    v1::DriveReply reply;
    while (this->Stream_->Read(&reply)) {
      events += reply.has_event();
      if (reply.has_done() && reply.done().number() >= number) {
        return events;
      }
    }
    ADD_FAILURE() << "the stream has ended";
    return events;
  }
  bool IsOpen = false;
  v1::Opened Opened;

private:
  std::unique_ptr<v1::Dspace::Stub> Stub_;
  grpc::ClientContext Context_;
  std::unique_ptr<grpc::ClientReaderWriter<v1::DriveRequest, v1::DriveReply>> Stream_;
};

const std::string KeyA(16, 'a');
const std::string KeyB(16, 'b');

class LinkLimits : public LinkTest {
protected:
  // Nobody carries out what it queues.
  void StartIdleServer() { this->Server = std::make_unique<session::Server>(this->Options); }
  void TearDown() override {
    if (!this->Thread.joinable()) {
      this->Server.reset();
    }
    LinkTest::TearDown();
  }
  std::string Address() const { return this->Server->Address(); }
  session::WatcherOptions ToWatch() const {
    session::WatcherOptions options;
    options.address = this->Server->Address();
    options.timeout_s = 20;
    return options;
  }
  // Whether the server has noticed that nobody is connected.
  bool NobodyDrives() const {
    const auto stub = v1::Dspace::NewStub(
        grpc::CreateChannel(this->Address(), grpc::InsecureChannelCredentials()));
    return Within20s([&] {
      grpc::ClientContext context;
      v1::HelloRequest request;
      request.set_protocol(session::LinkProtocol);
      v1::HelloReply reply;
      return stub->Hello(&context, request, &reply).ok() && reply.writer().empty();
    });
  }
};

v1::ViewerEvent MakeEvent(int number, std::size_t bytes) {
  v1::ViewerEvent event;
  event.mutable_answer()->set_question(std::to_string(number));
  event.mutable_answer()->set_answer(std::string(bytes, 'x'));
  return event;
}

TEST_F(LinkLimits, EventsThatNobodyReadsTakeBoundedMemoryAndCutNobodyOff) {
  this->Options.unreadBytes = 4 << 20; // of replies
  this->StartServer();
  Watcher watcher(this->ToWatch());
  RawDrive writer(this->Address(), KeyA);
  ASSERT_TRUE(writer.IsOpen);
  int delivered = 0;
  for (int i = 0; i < 60; ++i) {
    delivered += watcher.Tell(MakeEvent(i, 1000000));
  }
  // 8 MiB wait in the server, some on the way.
  EXPECT_GE(delivered, 8);
  EXPECT_LT(delivered, 30);
  EXPECT_LT(this->Server->GetCounts().waitingBytes, std::size_t(9) << 20);
  writer.Send(1, MakeScene());
  EXPECT_EQ(writer.WaitFor(1), delivered);
  EXPECT_THROW(watcher.Tell(MakeEvent(0, 2 << 20)), Error);
}

TEST_F(LinkLimits, EventsThatASimulationDoesNotTakeAreTheNewestOfBoundedSize) {
  this->StartServer();
  Watcher watcher(this->ToWatch());
  RemoteClient client(this->ClientOptions());
  constexpr int Events = 40;
  for (int i = 0; i < Events; ++i) {
    ASSERT_TRUE(Within20s([&] { return watcher.Tell(MakeEvent(i, 1000000)); }));
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

TEST_F(LinkLimits, ASimulationComesBackWhereAllPlacesAreTaken) {
  this->Options.maximumConnections = 2;
  this->StartServer();
  Watcher watcher(this->ToWatch());
  EXPECT_THROW(Watcher second(this->ToWatch()), Error); // one place is for whoever drives
  RawDrive first(this->Address(), KeyA);
  ASSERT_TRUE(first.IsOpen);
  first.Send(1, MakeScene());
  first.WaitFor(1);
  // Its connection broke on its own side only: the server has not noticed.
  RawDrive again(this->Address(), KeyA);
  ASSERT_TRUE(again.IsOpen);
  EXPECT_TRUE(again.Opened.resumed());
  EXPECT_EQ(again.Opened.last(), 1u);
}

// Opens the first stream and breaks it, has no room for the next two, and lets the fourth go on.
class CrowdedServer : public v1::Dspace::Service {
public:
  grpc::Status Drive(grpc::ServerContext*,
                     grpc::ServerReaderWriter<v1::DriveReply, v1::DriveRequest>* stream) override {
    const int call = this->Calls++;
    if (call == 1 || call == 2) {
      return {grpc::StatusCode::RESOURCE_EXHAUSTED, "there are too many"};
    }
    v1::DriveRequest request;
    stream->Read(&request);
    v1::DriveReply reply;
    reply.mutable_opened()->set_protocol(session::LinkProtocol);
    reply.mutable_opened()->set_resumed(call > 0);
    reply.mutable_opened()->set_maximum_message(1 << 20);
    stream->Write(reply);
    if (call == 0) {
      return {grpc::StatusCode::UNAVAILABLE, "broken"};
    }
    while (stream->Read(&request)) {
      reply.mutable_done()->set_number(request.send().number());
      reply.mutable_done()->mutable_reply();
      stream->Write(reply);
    }
    return grpc::Status::OK;
  }
  std::atomic<int> Calls = 0;
};

TEST_F(LinkLimits, AClientThatWasLetInTriesAgainWhereThereIsNoRoom) {
  CrowdedServer service;
  grpc::ServerBuilder builder;
  builder.AddListeningPort(this->Options.listen, grpc::InsecureServerCredentials());
  builder.RegisterService(&service);
  const auto server = builder.BuildAndStart();
  {
    RemoteClient client(this->ClientOptions());
    Accept(client.Execute(MakeScene()));
    EXPECT_EQ(service.Calls, 4);
  }
  // One that was never let in is told at once.
  service.Calls = 1;
  EXPECT_THROW(RemoteClient client(this->ClientOptions()), Error);
  EXPECT_EQ(service.Calls, 2);
  server->Shutdown(std::chrono::system_clock::now());
}

TEST_F(LinkLimits, WhoLostItsConnectionKeepsItsPlace) {
  this->StartServer();
  {
    RawDrive first(this->Address(), KeyA, session::ProcessName());
    ASSERT_TRUE(first.IsOpen);
    first.Send(1, MakeScene());
    first.WaitFor(1);
  }
  ASSERT_TRUE(this->NobodyDrives());
  try {
    RemoteClient second(this->ClientOptions("second"));
    FAIL() << "another one was let in";
  } catch (const Error& error) {
    EXPECT_EQ(error.GetKind(), Error::Kind::AlreadyExists);
    EXPECT_NE(std::string(error.what()).find("'raw' drives and has lost its connection"),
              std::string::npos)
        << error.what();
  }
  {
    RawDrive again(this->Address(), KeyA);
    EXPECT_TRUE(again.Opened.resumed());
    EXPECT_EQ(again.Opened.last(), 1u);
  }
  auto options = this->ClientOptions("second");
  options.takeOver = true;
  RemoteClient second(options);
  Accept(second.Execute(MakeFrame(2)));
  // The first one's late try takes nothing away from it.
  RawDrive late(this->Address(), KeyA);
  EXPECT_FALSE(late.IsOpen);
  Accept(second.Execute(MakeFrame(3)));
}

TEST_F(LinkLimits, WhoLeavesOrHasDiedKeepsNoPlace) {
  this->StartServer();
  for (std::uint64_t i = 1; i < 4; ++i) {
    RemoteClient client(this->ClientOptions());
    Accept(client.Execute(i == 1 ? MakeScene() : MakeFrame(i)));
  }
  // A process that has died, and one of before the machine was started.
  const pid_t child = fork();
  if (child == 0) {
    pause();
    _exit(0);
  }
  std::string dead = session::ProcessName();
  EXPECT_FALSE(session::HasDied(dead));
  for (const char* other : {"", "x", "a b 1 2", "a b c d"}) {
    EXPECT_FALSE(session::HasDied(other)) << other;
  }
  const std::string mine = " " + std::to_string(getpid()) + " ";
  ASSERT_NE(dead.find(mine), std::string::npos);
  EXPECT_TRUE(session::HasDied(dead + "0")); // it has another one's number by now
  EXPECT_FALSE(session::HasDied("1" + dead));
  kill(child, SIGKILL);
  ASSERT_EQ(waitpid(child, nullptr, 0), child);
  dead.replace(dead.find(mine), mine.size(), " " + std::to_string(child) + " ");
  EXPECT_TRUE(session::HasDied(dead));
  RawDrive(this->Address(), KeyA, dead).Break();
  ASSERT_TRUE(this->NobodyDrives());
  RemoteClient next(this->ClientOptions());
  Accept(next.Execute(MakeFrame(9)));
}

TEST_F(LinkLimits, APlaceIsKeptForAWhile) {
  this->Options.seat_s = 0.2;
  this->StartServer();
  RawDrive(this->Address(), KeyA).Break();
  EXPECT_TRUE(Within20s([&] { return RawDrive(this->Address(), KeyB).IsOpen; }));
  this->StopServer();
  for (const double wrong : {-1.0, 2e6, std::nan("")}) {
    this->Options.seat_s = wrong;
    EXPECT_THROW(session::Server server(this->Options), Error) << wrong;
  }
}

TEST_F(LinkLimits, WhatAFormerWriterLeftBehindIsNotCarriedOut) {
  this->Options.seat_s = 0;
  this->StartIdleServer();
  {
    RawDrive first(this->Address(), KeyA);
    ASSERT_TRUE(first.IsOpen);
    for (std::uint64_t i = 1; i <= 5; ++i) {
      first.Send(i, MakeFrame(100 + i));
    }
    ASSERT_TRUE(Within20s([&] { return this->Server->GetCounts().waitingBytes > 5 * 100; }));
  }
  ASSERT_TRUE(this->NobodyDrives());
  RawDrive second(this->Address(), KeyB);
  ASSERT_TRUE(second.IsOpen);
  EXPECT_FALSE(second.Opened.resumed());
  second.Send(1, MakeScene());
  std::vector<v1::Command> done;
  const session::Server::SessionWork work = {[&](v1::Command& command) {
                                               done.push_back(command);
                                               return v1::Reply();
                                             },
                                             [] { return std::vector<v1::Command>(); }};
  ASSERT_TRUE(Within20s([&] {
    this->Server->Run(work, 0.05);
    return !done.empty();
  }));
  this->Server->Run(work, 0.05);
  ASSERT_EQ(done.size(), 1u);
  EXPECT_TRUE(done[0].has_create_scene());
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

TEST_F(LinkLimits, ASnapshotThatFailsIsToldAndEndsNothing) {
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
    EXPECT_NE(std::string(error.what()).find("there is no snapshot: as it happens"),
              std::string::npos)
        << error.what();
  }
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
}

TEST_F(LinkLimits, AChildProcessIsToldAndMayCloseWhatItsParentOpened) {
#ifdef __SANITIZE_ADDRESS__
  GTEST_SKIP() << "the sanitizer's allocator may be locked by another thread when a process forks";
#endif
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
      watcher->Tell(MakeEvent(0, 1));
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
  EXPECT_TRUE(watcher->Tell(MakeEvent(0, 1)));
}

} // namespace
} // namespace dspace::testing
