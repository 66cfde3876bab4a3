// Real-time pace, on a clock that the test makes up, and through a client, which is never early.
#include "LinkTestSupport.h"

#include <chrono>
#include <cmath>

#include <dspace/link/Pacer.h>

namespace dspace::testing {
namespace {

using session::Pacer;

TEST(Pacer, WaitsForWhatIsLeftOfTheTimeSinceTheFirst) {
  Pacer pacer;
  EXPECT_EQ(pacer.Ahead("scene", 5, 100), 0); // none
  pacer.SetRate(2);                           // simulation seconds a second
  EXPECT_EQ(pacer.Ahead("scene", 5, 100), 0);
  EXPECT_EQ(pacer.Ahead("scene", 6, 100), 0.5);
  EXPECT_EQ(pacer.Ahead("scene", 6, 100.25), 0.25);
  EXPECT_EQ(pacer.Ahead("scene", 6, 100.5), 0);
  EXPECT_EQ(pacer.Ahead("scene", 7, 109), 0);    // late by 8 s:
  EXPECT_EQ(pacer.Ahead("scene", 23, 109), 0);   // it catches up,
  EXPECT_EQ(pacer.Ahead("scene", 24, 109), 0.5); // and no more
  EXPECT_EQ(pacer.Ahead("scene", 4, 109.5), 0);  // back: the count starts again
  EXPECT_EQ(pacer.Ahead("scene", 6, 109.5), 1);
  pacer.SetRate(1);
  EXPECT_EQ(pacer.Ahead("scene", 8, 200), 0); // again
  EXPECT_EQ(pacer.Ahead("scene", 9, 200), 1);
  EXPECT_EQ(pacer.Ahead("scene", std::nan(""), 200), 0);
  pacer.SetRate(0);
  EXPECT_EQ(pacer.Ahead("scene", 1e9, 200), 0);
  for (const double bad : {-1.0, std::nan(""), HUGE_VAL}) {
    EXPECT_THROW(pacer.SetRate(bad), Error) << bad;
  }
}

TEST(Pacer, EachSceneHasItsClockAndAnotherEpochIsNotWaitedFor) {
  Pacer pacer;
  pacer.SetRate(1);
  EXPECT_EQ(pacer.Ahead("a", 0, 100), 0);
  EXPECT_EQ(pacer.Ahead("b", 1.5, 100), 0); // its first
  EXPECT_EQ(pacer.Ahead("a", 2, 101), 1);
  EXPECT_EQ(pacer.Ahead("b", 4, 101), 1.5);
  EXPECT_EQ(pacer.Ahead("a", 3601, 101), 3600); // an hour is waited for, more is not
  EXPECT_EQ(pacer.Ahead("a", 3602, 101), 0);
  EXPECT_EQ(pacer.Ahead("a", 3603, 101), 1); // and there it starts again
  EXPECT_EQ(pacer.Ahead("a", 7e8, 101), 0);
  EXPECT_EQ(pacer.Ahead("a", 1e300, 101), 0);
  pacer.SetRate(1e-300);
  EXPECT_EQ(pacer.Ahead("a", 0, 101), 0);
  EXPECT_EQ(pacer.Ahead("a", 1e300, 101), 0); // beyond any double
  EXPECT_EQ(pacer.Ahead("b", 4, 101), 0);
}

v1::Command MakeTime(double time_s) {
  v1::Command command;
  command.mutable_set_time()->set_time_s(time_s);
  return command;
}

TEST_F(LinkTest, APacedClientIsNeverEarly) {
  this->StartServer();
  auto options = this->ClientOptions();
  options.pace = 10;
  session::RemoteClient client(options);
  Accept(client.Execute(MakeScene()));
  using Clock = std::chrono::steady_clock;
  const auto began = Clock::now();
  for (int i = 0; i <= 20; ++i) {
    Accept(i % 2 == 0 ? client.Execute(MakeTime(0.1 * i)) : client.Send(MakeTime(0.1 * i)));
    EXPECT_GE(std::chrono::duration<double>(Clock::now() - began).count(), 0.01 * i - 1e-9) << i;
  }
  Accept(client.Flush());
  client.SetPace(0);
  Accept(client.Execute(MakeTime(1e9))); // at once
}

TEST_F(LinkTest, WaitsInPartsAndWhatWasAbandoned) {
  this->StartServer();
  auto options = this->ClientOptions();
  options.pace = 1e-3; // a second lasts a quarter of an hour
  session::RemoteClient client(options, session::RemoteClient::NonBlocking());
  while (!client.WaitForConnect(0.001)) {
  }
  EXPECT_EQ(client.GetServer().commandSet, unsigned(v1::COMMAND_SET_VERSION));
  EXPECT_EQ(client.Take().error().kind(), v1::Error::INTERNAL); // nothing was begun
  Accept(client.Execute(MakeScene()));
  Accept(client.Execute(MakeTime(1)));
  client.Begin(MakeTime(2));
  EXPECT_FALSE(client.Wait(0.001));
  EXPECT_FALSE(client.Wait(0));
  client.Abandon(); // it was never sent
  v1::Command ask;
  ask.mutable_get_time();
  EXPECT_EQ(client.Execute(ask).time().time_s(), 1);
  // An error of what was abandoned is nobody's.
  v1::Command wrong = MakeFrame(7);
  wrong.mutable_create_frame()->set_parent(99);
  client.Begin(wrong);
  (void)client.Wait(0);
  client.Begin(ask);
  while (!client.Wait(0.001)) {
  }
  const v1::Reply reply = client.Take();
  EXPECT_EQ(reply.time().time_s(), 1) << reply.ShortDebugString();
  client.BeginFlush();
  while (!client.Wait(0.001)) {
  }
  Accept(client.Take());
}

} // namespace
} // namespace dspace::testing
