// Bytes that are no message, or a damaged one, on the wire of a server.
#include "LinkTestSupport.h"

#include <chrono>
#include <random>

#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

namespace dspace::testing {
namespace {

// Set back or forward it does not matter to a wait.
using Clock = std::chrono::steady_clock;

// A deadline as gRPC has it.
gpr_timespec In(std::chrono::milliseconds time) {
  return gpr_time_add(gpr_now(GPR_CLOCK_MONOTONIC),
                      gpr_time_from_millis(time.count(), GPR_TIMESPAN));
}

// Sends bytes as the messages of one call, whatever they are; hears all answers. OK or not.
grpc::Status CallWith(grpc::GenericStub& stub, const std::string& method,
                      const std::vector<std::string>& messages) {
  grpc::ClientContext context;
  context.set_deadline(In(std::chrono::seconds(20)));
  grpc::CompletionQueue queue;
  const auto call = stub.PrepareCall(&context, method, &queue);
  void* tag = nullptr;
  bool good = false;
  const auto wait = [&] { return queue.Next(&tag, &good) && good; };
  call->StartCall(nullptr);
  bool open = wait();
  for (const std::string& message : messages) {
    if (open) {
      const grpc::Slice slice(message);
      call->Write(grpc::ByteBuffer(&slice, 1), nullptr);
      open = wait();
    }
  }
  if (open) {
    call->WritesDone(nullptr);
    wait();
  }
  grpc::ByteBuffer answer;
  do {
    call->Read(&answer, nullptr);
  } while (wait());
  grpc::Status status;
  call->Finish(&status, nullptr);
  wait();
  queue.Shutdown();
  return status;
}

std::string OpenBytes() {
  v1::DriveRequest request;
  request.mutable_open()->set_protocol("dspace.v1");
  request.mutable_open()->set_client("fuzz");
  request.mutable_open()->set_key(std::string(16, 'k'));
  return request.SerializeAsString();
}

std::vector<std::string> Corpus() {
  std::vector<std::string> corpus = {"", "\x0a", std::string(100, '\xff'), OpenBytes()};
  std::uint64_t number = 0;
  v1::Command table;
  table.mutable_set_color_bar()->set_name("bar");
  table.mutable_set_color_bar()->add_value(1e300);
  for (const v1::Command& command :
       {MakeScene(), MakeFrame(2), MakeStep({2}, 1), AskPoses({2}), table}) {
    v1::DriveRequest request;
    request.mutable_send()->set_number(++number);
    *request.mutable_send()->mutable_command() = command;
    corpus.push_back(request.SerializeAsString());
  }
  std::string deep; // messages within messages, beyond what protobuf reads
  for (int i = 0; i < 300; ++i) {
    deep = "\x12" + std::string(1, char(std::min<std::size_t>(deep.size(), 127))) + deep;
  }
  corpus.push_back(deep);
  return corpus;
}

std::string Mutate(std::string bytes, std::mt19937& random) {
  for (unsigned n = random() % 6; n > 0 && !bytes.empty(); --n) {
    const std::size_t at = random() % bytes.size();
    switch (random() % 3) {
    case 0:
      bytes[at] = char(random());
      break;
    case 1:
      bytes.erase(at, 1 + random() % 8);
      break;
    default:
      bytes.insert(at, 1 + random() % 8, char(random()));
    }
  }
  return bytes;
}

TEST_F(LinkTest, DamagedMessagesDoNoHarm) {
  this->StartServer();
  grpc::GenericStub stub(
      grpc::CreateChannel(this->Server->Address(), grpc::InsecureChannelCredentials()));
  const std::vector<std::string> corpus = Corpus();
  std::mt19937 random(3);
  const auto end = Clock::now() + std::chrono::seconds(4);
  int calls = 0;
  while (Clock::now() < end || calls <= 10) {
    std::vector<std::string> messages;
    if (random() % 4 != 0) {
      messages.push_back(OpenBytes());
    }
    for (unsigned n = random() % 6; n > 0; --n) {
      messages.push_back(Mutate(corpus[random() % corpus.size()], random));
    }
    const char* methods[] = {"/dspace.v1.Dspace/Drive", "/dspace.v1.Dspace/Drive",
                             "/dspace.v1.Dspace/Tell", "/dspace.v1.Dspace/Hello",
                             "/dspace.v1.Dspace/Nothing"};
    CallWith(stub, methods[random() % 5], messages);
    ++calls;
  }
  auto options = this->ClientOptions();
  options.takeOver = true;
  session::RemoteClient client(options);
  v1::Command scene = MakeScene();
  scene.set_scene("after");
  Accept(client.Execute(scene));
  EXPECT_EQ(this->Server->GetCounts().viewers, 0u);
}

TEST_F(LinkTest, OtherProtocolsAreRejectedByName) {
  this->Options.maximumMessage = 2000;
  this->StartServer();
  grpc::GenericStub stub(
      grpc::CreateChannel(this->Server->Address(), grpc::InsecureChannelCredentials()));
  const std::string drive = "/dspace.v1.Dspace/Drive";
  v1::DriveRequest request;
  request.mutable_open()->set_protocol("dspace.v2");
  grpc::Status status = CallWith(stub, drive, {request.SerializeAsString()});
  EXPECT_EQ(status.error_code(), grpc::StatusCode::FAILED_PRECONDITION);
  EXPECT_NE(status.error_message().find("'dspace.v2'"), std::string::npos);
  EXPECT_NE(status.error_message().find("'dspace.v1'"), std::string::npos);
  request.mutable_open()->set_protocol("dspace.v1");
  request.mutable_open()->set_key("short");
  status = CallWith(stub, drive, {request.SerializeAsString()});
  EXPECT_NE(status.error_message().find("16 to 64"), std::string::npos) << status.error_message();
  // A number that does not follow.
  v1::DriveRequest send;
  send.mutable_send()->set_number(7);
  status = CallWith(stub, drive, {OpenBytes(), send.SerializeAsString()});
  EXPECT_NE(status.error_message().find("the next number"), std::string::npos)
      << status.error_message();
  // Too large: the stream ends, and nothing was done.
  send.mutable_send()->set_number(1);
  send.mutable_send()->mutable_command()->set_scene(std::string(10000, 'x'));
  status = CallWith(stub, drive, {OpenBytes(), send.SerializeAsString()});
  EXPECT_EQ(status.error_code(), grpc::StatusCode::RESOURCE_EXHAUSTED) << status.error_message();
  EXPECT_EQ(this->Server->GetCounts().commands, 0u);
}

TEST_F(LinkTest, AWriterThatDoesNotReadIsCutOffAndMemoryIsBounded) {
  this->Options.unreadBytes = 1 << 20;
  this->StartServer();
  {
    session::RemoteClient client(this->ClientOptions());
    Accept(client.Execute(MakeScene()));
    for (std::uint64_t id = 2; id < 3002; ++id) {
      Accept(client.Send(MakeFrame(id)));
    }
    Accept(client.Flush());
  }
  const std::uint64_t before = this->Server->GetCounts().commands;
  grpc::GenericStub stub(
      grpc::CreateChannel(this->Server->Address(), grpc::InsecureChannelCredentials()));
  grpc::ClientContext context;
  context.set_deadline(In(std::chrono::seconds(60)));
  grpc::CompletionQueue queue;
  const auto call = stub.PrepareCall(&context, "/dspace.v1.Dspace/Drive", &queue);
  void* tag = nullptr;
  bool good = false;
  const auto write = [&](const std::string& bytes) {
    const grpc::Slice slice(bytes);
    call->Write(grpc::ByteBuffer(&slice, 1), nullptr);
    return queue.Next(&tag, &good) && good;
  };
  call->StartCall(nullptr);
  ASSERT_TRUE(queue.Next(&tag, &good) && good);
  ASSERT_TRUE(write(OpenBytes()));
  // Answers of 150 kB each, two hundred times what may wait, none of them read.
  std::size_t most = 0;
  std::uint64_t number = 0;
  const auto cut = [&] {
    const auto counts = this->Server->GetCounts();
    return counts.commands > before && counts.connections == 0;
  };
  while (!cut() && number < 1400) {
    v1::DriveRequest request;
    request.mutable_send()->set_number(++number);
    request.mutable_send()->mutable_command()->mutable_list_frames();
    const grpc::Slice slice(request.SerializeAsString());
    call->Write(grpc::ByteBuffer(&slice, 1), nullptr);
    // A client that reads nothing does not hear that it was cut off.
    while (queue.AsyncNext(&tag, &good, In(std::chrono::milliseconds(100))) ==
               grpc::CompletionQueue::TIMEOUT &&
           !cut()) {
    }
    most = std::max(most, this->Server->GetCounts().waitingBytes);
  }
  for (const auto end = Clock::now() + std::chrono::seconds(20); !cut() && Clock::now() < end;) {
    std::this_thread::sleep_for(std::chrono::milliseconds(10));
    most = std::max(most, this->Server->GetCounts().waitingBytes);
  }
  EXPECT_TRUE(cut());
  EXPECT_LT(most, std::size_t(3) << 20);
  EXPECT_GT(this->Server->GetCounts().commands, before);
  context.TryCancel();
  queue.Shutdown();
  while (queue.AsyncNext(&tag, &good, In(std::chrono::seconds(20))) ==
         grpc::CompletionQueue::GOT_EVENT) {
  }
  auto others = this->ClientOptions(); // go on; its place is kept for a while, though
  others.takeOver = true;
  session::RemoteClient client(others);
  Accept(client.Execute(MakeFrame(9999)));
}

TEST_F(LinkTest, ConnectionsAreLimited) {
  this->Options.maximumConnections = 3;
  this->StartServer();
  session::RemoteClient client(this->ClientOptions());
  session::WatcherOptions options;
  options.address = this->Server->Address();
  options.timeout_s = 20;
  session::Watcher one(options);
  session::Watcher two(options);
  EXPECT_THROW(session::Watcher three(options), Error);
  Accept(client.Execute(MakeScene()));
}

} // namespace
} // namespace dspace::testing
