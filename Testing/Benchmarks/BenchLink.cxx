// The simulation link: steps of 1,000 frames against a raw gRPC stream of the same bytes, and the
// round trip of lockstep. Both over a Unix socket to servers in one other process.
#include <atomic>
#include <cmath>
#include <ctime>
#include <filesystem>
#include <thread>

#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <grpcpp/generic/async_generic_service.h>
#include <grpcpp/generic/generic_stub.h>
#include <grpcpp/grpcpp.h>

#include "Alternate.h"

#include <dspace/interpreter/Interpreter.h>
#include <dspace/link/client/RemoteClient.h>
#include <dspace/link/server/Server.h>

namespace {

using namespace dspace;
using Clock = std::chrono::steady_clock;

constexpr int Frames = 1000;
constexpr int Steps = 500;

// Reads messages and does nothing with them; answers the last one.
class RawServer {
public:
  explicit RawServer(const std::string& address) {
    grpc::ServerBuilder builder;
    builder.AddListeningPort(address, grpc::InsecureServerCredentials());
    builder.RegisterAsyncGenericService(&this->Service_);
    this->Queue_ = builder.AddCompletionQueue();
    this->Server_ = builder.BuildAndStart();
    this->Thread_ = std::thread([this] { this->Serve(); });
  }
  ~RawServer() {
    this->Server_->Shutdown(std::chrono::system_clock::now());
    this->Queue_->Shutdown();
    this->Thread_.join();
  }

private:
  bool Next() {
    void* tag = nullptr;
    bool good = false;
    return this->Queue_->Next(&tag, &good) && good;
  }
  void Serve() {
    grpc::GenericServerContext context;
    grpc::GenericServerAsyncReaderWriter stream(&context);
    this->Service_.RequestCall(&context, &stream, this->Queue_.get(), this->Queue_.get(), nullptr);
    if (!this->Next()) {
      return;
    }
    grpc::ByteBuffer message;
    int read = 0;
    while (true) {
      stream.Read(&message, nullptr);
      if (!this->Next()) {
        return;
      }
      if (++read % Steps == 0) {
        const grpc::Slice done("done");
        stream.Write(grpc::ByteBuffer(&done, 1), nullptr);
        if (!this->Next()) {
          return;
        }
      }
    }
  }
  grpc::AsyncGenericService Service_;
  std::unique_ptr<grpc::ServerCompletionQueue> Queue_;
  std::unique_ptr<grpc::Server> Server_;
  std::thread Thread_;
};

class RawClient {
public:
  explicit RawClient(const std::string& address)
      : Stub_(grpc::CreateChannel(address, grpc::InsecureChannelCredentials())),
        Call_(Stub_.PrepareCall(&Context_, "/raw", &Queue_)) {
    this->Call_->StartCall(nullptr);
    this->Wait();
  }
  ~RawClient() {
    this->Context_.TryCancel();
    grpc::Status status;
    this->Call_->Finish(&status, nullptr);
    this->Wait();
    this->Queue_.Shutdown();
  }
  void Write(const std::string& bytes) {
    const grpc::Slice slice(bytes);
    this->Call_->Write(grpc::ByteBuffer(&slice, 1), nullptr);
    this->Wait();
  }
  void Read() {
    grpc::ByteBuffer answer;
    this->Call_->Read(&answer, nullptr);
    this->Wait();
  }

private:
  void Wait() {
    void* tag = nullptr;
    bool good = false;
    this->Queue_.Next(&tag, &good);
  }
  grpc::ClientContext Context_;
  grpc::CompletionQueue Queue_;
  grpc::GenericStub Stub_;
  std::unique_ptr<grpc::GenericClientAsyncReaderWriter> Call_;
};

v1::Command MakeStep(int step) {
  v1::Command command;
  for (int i = 0; i < Frames; ++i) {
    command.mutable_set_poses()->add_frame(std::uint64_t(i) + 2);
    for (const double v : {double(step), 0.5 * i, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0}) {
      command.mutable_set_poses()->add_pose(v);
    }
  }
  return command;
}

constexpr int Pairs = 15;

// The process of the servers, until it is told to end.
int Serve(const std::string& folder, int told) {
  session::Interpreter interpreter;
  session::ServerOptions options;
  options.listen = "unix:" + folder + "/link";
  options.maximumRate = 1e9;
  session::Server server(options);
  RawServer rawServer("unix:" + folder + "/raw");
  std::thread runner([&] {
    while (server.Run({[&](v1::Command& command) { return interpreter.Execute(command); },
                       [] { return std::vector<v1::Command>(); }},
                      10)) {
    }
  });
  char word = 'r';
  bool good = write(told, &word, 1) == 1;
  good = good && read(told, &word, 1) >= 0; // the other end is closed
  server.Stop();
  runner.join();
  return good ? 0 : 1;
}

// CPU seconds of this process and of the servers': other work on the machine weighs less on them
// than on the rate.
double CpuSeconds(pid_t servers) {
  double total = 0;
  for (const pid_t each : {getpid(), servers}) {
    clockid_t clock;
    timespec now = {};
    if (clock_getcpuclockid(each, &clock) != 0 || clock_gettime(clock, &now) != 0) {
      return std::nan("");
    }
    total += double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
  }
  return total;
}

void Drive(const std::string& folder, pid_t servers) {
  session::RemoteClientOptions to;
  to.address = "unix:" + folder + "/link";
  session::RemoteClient client(to);
  v1::Command command;
  command.mutable_create_scene();
  client.Execute(command);
  for (int i = 0; i < Frames; ++i) {
    v1::Command frame;
    frame.mutable_create_frame()->set_id(std::uint64_t(i) + 2);
    frame.mutable_create_frame()->set_name("f" + std::to_string(i));
    client.Execute(frame);
  }
  RawClient raw("unix:" + folder + "/raw");
  int step = 0;
  bool good = true;
  const std::size_t bytes = MakeStep(1).ByteSizeLong();
  std::vector<double> linkCpu; // microseconds a step, of each turn
  std::vector<double> rawCpu;
  // Both make a new message each step, from the simulation's numbers.
  const auto turns = bench::Alternate(
      Pairs,
      [&] {
        const double began = CpuSeconds(servers);
        for (int i = 0; i < Steps; ++i) {
          good = !client.Send(MakeStep(++step)).has_error() && good;
        }
        good = !client.Flush().has_error() && good;
        linkCpu.push_back(1e6 * (CpuSeconds(servers) - began) / Steps);
      },
      [&] {
        const double began = CpuSeconds(servers);
        for (int i = 0; i < Steps; ++i) {
          raw.Write(MakeStep(++step).SerializeAsString());
        }
        raw.Read();
        rawCpu.push_back(1e6 * (CpuSeconds(servers) - began) / Steps);
      });
  char behind[160];
  std::snprintf(behind, sizeof(behind),
                "rate %.2f of the raw stream's (goal 0.7), steps of %d frames, %zu bytes%s",
                1 / bench::Median(turns.ratio), Frames, bytes, good ? "" : ", WITH ERRORS");
  bench::Print("steps over the link against a raw gRPC stream", turns, Steps, behind);
  std::printf(
      "CPU time of both processes: %.0f us a step over the link, %.0f over the raw stream\n",
      bench::Median(linkCpu), bench::Median(rawCpu));
  std::vector<double> trips;
  for (int i = 0; i < 5000; ++i) {
    v1::Command time;
    time.mutable_set_time()->set_time_s(i);
    const auto began = Clock::now();
    client.Execute(std::move(time));
    trips.push_back(1e3 * std::chrono::duration<double>(Clock::now() - began).count());
  }
  std::sort(trips.begin(), trips.end());
  std::printf("lockstep round trip: median %.3f ms (goal < 1), 99 %% under %.3f ms\n",
              bench::Median(trips), trips[4950]);
}

} // namespace

int main() {
  char name[] = "/tmp/dspace-bench-XXXXXX";
  const std::string folder = mkdtemp(name);
  int ends[2];
  if (socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) {
    return 1;
  }
  const pid_t child = fork(); // before gRPC has any thread
  if (child == 0) {
    close(ends[0]);
    const int result = Serve(folder, ends[1]);
    std::fflush(nullptr);
    _exit(result);
  }
  close(ends[1]);
  char word = 0;
  const bool ready = read(ends[0], &word, 1) == 1;
  if (ready) {
    Drive(folder, child);
  }
  close(ends[0]);
  int status = 1;
  waitpid(child, &status, 0);
  std::filesystem::remove_all(folder);
  return ready && status == 0 ? 0 : 1;
}
