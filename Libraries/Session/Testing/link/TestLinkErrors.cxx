// Errors and warnings of commands that were sent without waiting.
#include "LinkTestSupport.h"

#include <future>

namespace dspace::testing {
namespace {

using session::RemoteClient;

TEST_F(LinkTest, PipelinedCommandsComeInOrderAndTheirErrorsToo) {
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  for (std::uint64_t id = 2; id < 2002; ++id) {
    Accept(client.Send(MakeFrame(id)));
  }
  Accept(client.Flush());
  v1::Command wrong = MakeFrame(5000);
  wrong.mutable_create_frame()->set_parent(99999);
  Accept(client.Send(wrong));
  const v1::Reply reply = client.Flush();
  EXPECT_EQ(reply.error().kind(), v1::Error::NOT_FOUND) << reply.ShortDebugString();
  Accept(client.Flush()); // told once
  v1::Command list;
  list.mutable_list_frames();
  EXPECT_EQ(client.Execute(list).frames().frame_size(), 2001);
}

// The server could not parse it, and the client would wait for ever.
TEST_F(LinkTest, ACommandWhoseTextIsNotUtf8IsNotSent) {
  this->StartServer();
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  v1::Command wrong = MakeFrame(7);
  wrong.mutable_create_frame()->set_name("M\xE4st");
  for (const v1::Reply& reply : {client.Execute(wrong), client.Send(wrong)}) {
    EXPECT_EQ(reply.error().kind(), v1::Error::INVALID_ARGUMENT);
    EXPECT_EQ(reply.error().message(), "command create_frame: its field 'name' is not UTF-8; "
                                       "accepted: text of UTF-8");
  }
  Accept(client.Execute(MakeFrame(7))); // the link goes on
}

// Whoever was interrupted twice, or waited too long, is not told of it by what comes later.
TEST_F(LinkTest, ErrorsOfWhatWasAbandonedHitNothingElse) {
  this->StartServer();
  std::promise<void> go;
  this->Served->interpreter.AddListener([&](const v1::Command& command, const v1::Reply&) {
    if (command.has_set_time()) {
      go.get_future().wait();
    }
  });
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  v1::Command hold;
  hold.mutable_set_time()->set_time_s(1);
  client.Begin(hold);
  EXPECT_FALSE(client.Wait(0.01));
  client.Abandon();
  for (const std::uint64_t id : {5000, 5001, 5002}) {
    v1::Command wrong = MakeFrame(id);
    wrong.mutable_create_frame()->set_parent(99999);
    client.Begin(wrong);
    EXPECT_FALSE(client.Wait(0.01));
    client.Abandon();
  }
  v1::Command unheard = MakeFrame(6000);
  unheard.mutable_create_frame()->set_parent(88888);
  Accept(client.Send(unheard));
  go.set_value();
  EXPECT_NE(client.Flush().error().message().find("88888"), std::string::npos);
  Accept(client.Execute(MakeFrame(7)));
}

// What is waited for is never carried out after something that was refused and not waited for.
TEST_F(LinkTest, AWaitingCommandIsNotExecutedAfterAnError) {
  this->StartServer();
  std::promise<void> go;
  std::vector<double> times;
  this->Served->interpreter.AddListener([&](const v1::Command& command, const v1::Reply&) {
    if (command.has_set_time()) {
      times.push_back(command.set_time().time_s());
      if (times.size() == 1) {
        go.get_future().wait();
      }
    }
  });
  RemoteClient client(this->ClientOptions());
  Accept(client.Execute(MakeScene()));
  v1::Command time;
  time.mutable_set_time()->set_time_s(1);
  Accept(client.Send(time)); // holds the server
  v1::Command wrong = MakeFrame(5000);
  wrong.mutable_create_frame()->set_parent(99999);
  Accept(client.Send(wrong));
  time.mutable_set_time()->set_time_s(2);
  client.Begin(time);
  EXPECT_FALSE(client.Wait(0.05));
  go.set_value();
  while (!client.Wait(1)) {
  }
  EXPECT_NE(client.Take().error().message().find("99999"), std::string::npos);
  Accept(client.Execute(time)); // said again
  Accept(client.Send(MakeFrame(8)));
  Accept(client.Execute(MakeFrame(9)));
  EXPECT_EQ(times, (std::vector<double>{1, 2}));
}

TEST_F(LinkTest, WhatIsBeforeACommandMustBeDoneWithinItsTimeout) {
  this->StartServer();
  std::promise<void> go;
  this->Served->interpreter.AddListener([&](const v1::Command& command, const v1::Reply&) {
    if (command.has_set_time()) {
      go.get_future().wait();
    }
  });
  session::RemoteClientOptions options = this->ClientOptions();
  options.timeout_s = 5;
  RemoteClient client(options);
  Accept(client.Execute(MakeScene()));
  v1::Command hold;
  hold.mutable_set_time()->set_time_s(1);
  Accept(client.Send(hold));
  const v1::Reply late = client.Execute(MakeFrame(7));
  EXPECT_EQ(late.error().kind(), v1::Error::DEADLINE_EXCEEDED);
  EXPECT_NE(late.error().message().find("not completed within 5 s; this command was not sent"),
            std::string::npos)
      << late.ShortDebugString();
  go.set_value();
  Accept(client.Flush());
  Accept(client.Execute(MakeFrame(7))); // for the first time
}

} // namespace
} // namespace dspace::testing
