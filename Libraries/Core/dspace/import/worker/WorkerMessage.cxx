#include <dspace/import/worker/WorkerMessage.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <limits>
#include <system_error>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <dspace/Utf8.h>

namespace dspace {
namespace {

constexpr std::size_t LargestMessage = std::size_t(1) << 16;
constexpr std::size_t HeaderSize = 5; // kind, size of what follows
constexpr std::size_t LongestText = std::size_t(1) << 14;

struct DescriptorSpace {
  alignas(cmsghdr) char bytes[CMSG_SPACE(sizeof(int))] = {};
};

bool WaitToRead(int socket, WorkerClock::time_point until) {
  pollfd ready = {socket, POLLIN, 0};
  for (;;) {
    int wait_ms = -1;
    if (until != WorkerClock::time_point::max()) {
      const auto left =
          std::chrono::duration_cast<std::chrono::milliseconds>(until - WorkerClock::now()).count();
      wait_ms =
          static_cast<int>(std::clamp<std::int64_t>(left, 0, std::numeric_limits<int>::max()));
    }
    const int count = ::poll(&ready, 1, wait_ms);
    if (count != -1 || errno != EINTR) {
      return count > 0;
    }
  }
}

// Exactly so many bytes, and a descriptor that comes with them.
bool Receive(int socket, std::size_t size, std::string& bytes, WorkerClock::time_point until,
             Descriptor& descriptor) {
  bytes.assign(size, '\0');
  for (std::size_t done = 0; done < size;) {
    if (!WaitToRead(socket, until)) {
      return false;
    }
    iovec part = {bytes.data() + done, size - done};
    DescriptorSpace space;
    msghdr header = {};
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    header.msg_control = space.bytes;
    header.msg_controllen = sizeof space.bytes;
    const ssize_t got = ::recvmsg(socket, &header, MSG_CMSG_CLOEXEC);
    if (got == 0 || (got < 0 && errno != EINTR)) {
      return false;
    }
    for (cmsghdr* control = got > 0 ? CMSG_FIRSTHDR(&header) : nullptr; control;
         control = CMSG_NXTHDR(&header, control)) {
      if (control->cmsg_level == SOL_SOCKET && control->cmsg_type == SCM_RIGHTS) {
        int number = -1;
        std::memcpy(&number, CMSG_DATA(control), sizeof number);
        descriptor = Descriptor(number);
      }
    }
    done += got > 0 ? static_cast<std::size_t>(got) : 0;
  }
  return true;
}

} // namespace

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
  if (this != &other) {
    this->Close();
    this->Number_ = other.Release();
  }
  return *this;
}

int Descriptor::Release() {
  const int number = this->Number_;
  this->Number_ = -1;
  return number;
}

void Descriptor::Close() {
  if (this->Number_ >= 0) {
    ::close(this->Release());
  }
}

std::string RequestText(const WorkerRequest& request) {
  ByteWriter text;
  text.Number(static_cast<std::uint8_t>(request.what));
  text.Text(request.path);
  text.Number<std::uint8_t>(request.strict);
  text.Number<std::uint8_t>(request.pointCloud);
  text.Number(request.maximumTriangles);
  text.Number(request.memory);
  text.Number(request.seconds);
  text.Number(request.imagePixels);
  text.Number(request.textureBytes);
  return text.Text();
}

WorkerRequest RequestOf(const std::string& payload) {
  ByteReader from(payload.data(), payload.size(), "import request");
  WorkerRequest request;
  request.what = from.Enumerator(WorkerRequest::What::Urdf);
  request.path = from.Text();
  request.strict = from.Flag();
  request.pointCloud = from.Flag();
  request.maximumTriangles = from.Number<std::uint64_t>();
  request.memory = from.Number<std::uint64_t>();
  request.seconds = from.Number<std::uint64_t>();
  request.imagePixels = from.Number<std::uint64_t>();
  request.textureBytes = from.Number<std::uint64_t>();
  from.End();
  return request;
}

std::string ErrorText(const Error& error) {
  const std::string object = Utf8Beginning(error.GetObjectName(), LongestText);
  std::string message = error.what();
  if (!object.empty() && message.compare(0, object.size() + 2, object + ": ") == 0) {
    message.erase(0, object.size() + 2);
  }
  ByteWriter text;
  text.Number(static_cast<std::uint8_t>(error.GetKind()));
  text.Text(object);
  text.Text(Utf8Beginning(message, LongestText));
  return text.Text();
}

Error ErrorOf(const std::string& payload, const std::string& object) {
  ByteReader from(payload.data(), payload.size(), object);
  const auto kind = from.Enumerator(Error::Kind::Internal);
  const std::string named = from.Text();
  const std::string message = from.Text();
  from.End();
  return Error(kind, named, message);
}

std::pair<Descriptor, Descriptor> WorkerSockets() {
  int both[2] = {-1, -1};
  if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, both) != 0) {
    throw Error(Error::Kind::Resource, "the process that reads models",
                "no socket can be made: " + std::generic_category().message(errno));
  }
  return {Descriptor(both[0]), Descriptor(both[1])};
}

bool SendWorkerMessage(int socket, WorkerMessage::Kind kind, const std::string& payload,
                       int descriptor) {
  if (payload.size() > LargestMessage) {
    return false;
  }
  const auto size = static_cast<std::uint32_t>(payload.size());
  std::string bytes(HeaderSize, '\0');
  bytes[0] = static_cast<char>(kind);
  std::memcpy(bytes.data() + 1, &size, sizeof size);
  bytes += payload;
  DescriptorSpace space;
  for (std::size_t done = 0; done < bytes.size();) {
    iovec part = {bytes.data() + done, bytes.size() - done};
    msghdr header = {};
    header.msg_iov = &part;
    header.msg_iovlen = 1;
    if (descriptor >= 0 && done == 0) { // it comes with the first byte
      header.msg_control = space.bytes;
      header.msg_controllen = sizeof space.bytes;
      cmsghdr* control = CMSG_FIRSTHDR(&header);
      control->cmsg_level = SOL_SOCKET;
      control->cmsg_type = SCM_RIGHTS;
      control->cmsg_len = CMSG_LEN(sizeof(int));
      std::memcpy(CMSG_DATA(control), &descriptor, sizeof descriptor);
    }
    const ssize_t sent = ::sendmsg(socket, &header, MSG_NOSIGNAL);
    if (sent < 0 && errno != EINTR) {
      return false;
    }
    done += sent > 0 ? static_cast<std::size_t>(sent) : 0;
  }
  return true;
}

bool ReceiveWorkerMessage(int socket, WorkerMessage& message, WorkerClock::time_point until) {
  message.descriptor.Close();
  std::string header;
  std::uint32_t size = 0;
  if (!Receive(socket, HeaderSize, header, until, message.descriptor)) {
    return false;
  }
  std::memcpy(&size, header.data() + 1, sizeof size);
  const auto kind = static_cast<std::uint8_t>(header[0]);
  if (size > LargestMessage || kind > static_cast<std::uint8_t>(WorkerMessage::Kind::Died)) {
    return false;
  }
  message.kind = static_cast<WorkerMessage::Kind>(kind);
  return Receive(socket, size, message.payload, until, message.descriptor);
}

} // namespace dspace
