// The messages between the session's process and those of an import: internal, not installed.
#ifndef DSPACE_IMPORT_WORKER_MESSAGE_H
#define DSPACE_IMPORT_WORKER_MESSAGE_H

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <string>
#include <utility>

#include <dspace/Error.h>
#include <dspace/import/worker/Bytes.h>

namespace dspace {

// A descriptor that is closed with its owner; -1: none.
class Descriptor {
public:
  explicit Descriptor(int number = -1) : Number_(number) {}
  ~Descriptor() { this->Close(); }
  Descriptor(Descriptor&& other) noexcept : Number_(other.Release()) {}
  Descriptor& operator=(Descriptor&& other) noexcept;
  Descriptor(const Descriptor&) = delete;
  Descriptor& operator=(const Descriptor&) = delete;

  int Get() const { return this->Number_; }
  int Release();
  void Close();

private:
  int Number_;
};

// One message of a stream of messages, over a Unix socket: a confined process may have no other
// kind.
struct WorkerMessage {
  enum class Kind : std::uint8_t {
    // Session to worker
    Document,  // a WorkerRequest; with the child's end of a socket
    WarmCodec, // load the library of images, for the documents to come
    Opened,    // with a descriptor of the file
    Denied,    // an Error
    // Child to session
    Open,   // a path
    Done,   // u8: whether the library of images was loaded, and texts: files whose text was of no
            // known encoding (FileText.h); with a file of the result
    Failed, // an Error
    // Worker to session, on the child's socket, when the child has ended
    Died // u8 WorkerDeath, i32 number
  };
  Kind kind = Kind::Died;
  std::string payload;
  Descriptor descriptor = Descriptor();
};

// How a child ended.
enum class WorkerDeath : std::uint8_t { Exit, Signal, Timeout };
constexpr int WorkerExitForMemory = 77; // its exit status where memory ran out

// What the child is to read.
struct WorkerRequest {
  enum class What : std::uint8_t { Model, Image, Urdf };
  What what = What::Model;
  std::string path;
  bool strict = false;
  bool pointCloud = false;
  std::uint64_t maximumTriangles = 0;
  std::uint64_t memory = 0;  // bytes
  std::uint64_t seconds = 0; // of the processor and of the clock
  std::uint64_t imagePixels = 0;
  std::uint64_t textureBytes = 0;
};
std::string RequestText(const WorkerRequest& request);
WorkerRequest RequestOf(const std::string& payload);

std::string ErrorText(const Error& error);
Error ErrorOf(const std::string& payload, const std::string& object);

// A pair of connected sockets. Throws Error(Resource).
std::pair<Descriptor, Descriptor> WorkerSockets();

// False where nobody reads any more. Not from two threads at a time.
bool SendWorkerMessage(int socket, WorkerMessage::Kind kind, const std::string& payload,
                       int descriptor = -1);
// False at the end, for what is no message, and where it is not there at `until`.
using WorkerClock = std::chrono::steady_clock;
bool ReceiveWorkerMessage(int socket, WorkerMessage& message,
                          WorkerClock::time_point until = WorkerClock::time_point::max());

} // namespace dspace

#endif
