// An asynchronous call that sends a viewer's event to the driver. Inside the library only.
#ifndef DSPACE_SESSION_VIEWER_EVENT_CALL_H
#define DSPACE_SESSION_VIEWER_EVENT_CALL_H

#include <algorithm>
#include <chrono>
#include <memory>

#include <grpcpp/grpcpp.h>

#include <dspace/proto/service.grpc.pb.h>

namespace dspace::session {

// One asynchronous call of the RPC Tell. It starts in the constructor and ends after `timeout_s` at
// the latest. The destructor cancels it.
class ViewerEventCall {
public:
  ViewerEventCall(v1::Dspace::Stub& stub, const v1::TellRequest& request, double timeout_s) {
    this->Context_.set_deadline(In(timeout_s));
    this->Call_ = stub.AsyncTell(&this->Context_, request, &this->Queue_);
    this->Call_->Finish(&this->Reply_, &this->Status_, nullptr);
  }
  ViewerEventCall(const ViewerEventCall&) = delete;
  ViewerEventCall& operator=(const ViewerEventCall&) = delete;
  ~ViewerEventCall() {
    if (!this->Done_) {
      this->Context_.TryCancel();
    }
    this->Queue_.Shutdown();
    void* tag = nullptr; // gRPC may write to the members until the queue is drained
    bool good = false;
    while (this->Queue_.Next(&tag, &good)) {
    }
  }

  // Waits up to this time. Returns whether the call has ended.
  bool Wait(double seconds) {
    void* tag = nullptr;
    bool good = false;
    this->Done_ = this->Done_ || this->Queue_.AsyncNext(&tag, &good, In(seconds)) ==
                                     grpc::CompletionQueue::GOT_EVENT;
    return this->Done_;
  }
  // The results, after the call has ended.
  bool Done() const { return this->Done_; }
  const grpc::Status& Status() const { return this->Status_; }
  bool Delivered() const { return this->Reply_.delivered(); }

private:
  static std::chrono::system_clock::time_point In(double seconds) {
    return std::chrono::system_clock::now() +
           std::chrono::duration_cast<std::chrono::milliseconds>(
               std::chrono::duration<double>(std::clamp(seconds, 0.0, 1e6)));
  }

  grpc::CompletionQueue Queue_;
  grpc::ClientContext Context_;
  std::unique_ptr<grpc::ClientAsyncResponseReader<v1::TellReply>> Call_;
  v1::TellReply Reply_;
  grpc::Status Status_;
  bool Done_ = false;
};

} // namespace dspace::session

#endif
