// The driver of a server, and its reservation after a lost connection.
#include <csignal>
#include <numeric>

#include <sys/wait.h>

#include <dspace/link/ProcessName.h>

#include "RawDrive.h"

namespace dspace::testing {
namespace {

using session::RemoteClient;
using session::Watcher;

using LinkReservations = RawLinkTest;

TEST_F(LinkReservations, ASimulationReconnectsToAFullServer) {
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

TEST_F(LinkReservations, AClientThatWasLetInTriesAgainWhereThereIsNoRoom) {
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

TEST_F(LinkReservations, ADisconnectedWriterKeepsItsReservation) {
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
    EXPECT_NE(std::string(error.what()).find("'raw' is the driver and has lost its connection"),
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

TEST_F(LinkReservations, AWriterThatLeftOrDiedKeepsNoReservation) {
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

TEST_F(LinkReservations, AReservationExpires) {
  this->Options.reservation_s = 0.2;
  this->StartServer();
  RawDrive(this->Address(), KeyA).Break();
  EXPECT_TRUE(Within20s([&] { return RawDrive(this->Address(), KeyB).IsOpen; }));
  this->StopServer();
  for (const double wrong : {-1.0, 2e6, std::nan("")}) {
    this->Options.reservation_s = wrong;
    EXPECT_THROW(session::Server server(this->Options), Error) << wrong;
  }
}

TEST_F(LinkReservations, WhatAFormerWriterLeftBehindIsNotCarriedOut) {
  this->Options.reservation_s = 0;
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

// A simulation that comes back to a restarted server does not keep others out while it
// finds out.
TEST_F(LinkReservations, AnUnknownWriterGetsNoReservation) {
  this->StartServer();
  RawDrive former(this->Address(), KeyA, {}, true);
  EXPECT_FALSE(former.IsOpen);
  const grpc::Status status = former.Finish();
  EXPECT_EQ(status.error_code(), grpc::StatusCode::ABORTED);
  EXPECT_NE(status.error_message().find("restarted"), std::string::npos) << status.error_message();
  RemoteClient next(this->ClientOptions("next")); // at once, although no place was given up
  Accept(next.Execute(MakeScene()));
  RawDrive later(this->Address(), KeyB, {}, true);
  EXPECT_FALSE(later.IsOpen);
  EXPECT_EQ(later.Finish().error_code(), grpc::StatusCode::ALREADY_EXISTS);
  Accept(next.Execute(MakeFrame(2)));
}

// More streams than may be there at once end with replies that nobody reads.
TEST_F(LinkReservations, WhoDoesNotTakeItsLastRepliesIsCutOff) {
  this->Options.reservation_s = 0.5;
  this->StartServer();
  constexpr std::uint64_t Frames = 1000;
  {
    RemoteClient client(this->ClientOptions());
    Accept(client.Execute(MakeScene()));
    for (std::uint64_t id = 2; id < 2 + Frames; ++id) {
      Accept(client.Send(MakeFrame(id)));
    }
    Accept(client.Flush());
  }
  std::vector<std::uint64_t> frames(Frames);
  std::iota(frames.begin(), frames.end(), 2);
  std::vector<std::unique_ptr<RawDrive>> stalled;
  for (int i = 0; i < 10; ++i) {
    const std::string key(16, char('c' + i));
    ASSERT_TRUE(Within20s([&] {
      stalled.push_back(std::make_unique<RawDrive>(this->Address(), key));
      if (!stalled.back()->IsOpen) {
        stalled.pop_back();
        return false;
      }
      return true;
    })) << i;
    for (std::uint64_t number = 1; number <= 200; ++number) {
      stalled.back()->Send(number, AskPoses(frames)); // answered by 64 kB
    }
    stalled.back()->HalfClose();
  }
}

} // namespace
} // namespace dspace::testing
