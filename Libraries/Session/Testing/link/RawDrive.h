// A stream of the link message by message, and servers that nobody serves, for tests.
#ifndef DSPACE_TESTING_RAW_DRIVE_H
#define DSPACE_TESTING_RAW_DRIVE_H

#include <grpcpp/grpcpp.h>

#include <dspace/proto/service.grpc.pb.h>

#include "LinkTestSupport.h"

namespace dspace::testing {

inline bool Within20s(const std::function<bool()>& done) {
  for (const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(20);
       std::chrono::steady_clock::now() < end;) {
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
  RawDrive(const std::string& address, const std::string& key, const std::string& process = {},
           bool again = false) {
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
    request.mutable_open()->set_again(again);
    v1::DriveReply reply;
    if (this->Stream_->Write(request) && this->Stream_->Read(&reply)) {
      this->Opened = reply.opened();
      this->IsOpen = reply.has_opened();
    }
  }
  ~RawDrive() { this->Break(); }
  // What the server says at the end.
  grpc::Status Finish() {
    const grpc::Status status = this->Stream_->Finish();
    this->Stream_.reset();
    return status;
  }
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
  void HalfClose() { EXPECT_TRUE(this->Stream_->WritesDone()); }
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

class RawLinkTest : public LinkTest {
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

} // namespace dspace::testing

#endif
