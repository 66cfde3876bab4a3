#include <dspace/import/worker/WorkerMessage.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

#include <dspace/Utf8.h>

namespace dspace {
namespace {

constexpr std::size_t LargestMessage = std::size_t(1) << 16;
constexpr std::size_t LongestText = std::size_t(1) << 14;

struct DescriptorSpace {
  alignas(cmsghdr) char bytes[CMSG_SPACE(sizeof(int))] = {};
};

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

bool SendWorkerMessage(int socket, WorkerMessage::Kind kind, const std::string& payload,
                       int descriptor) {
  std::string bytes(1, static_cast<char>(kind));
  bytes += payload;
  iovec part = {bytes.data(), std::min(bytes.size(), LargestMessage)};
  msghdr header = {};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  DescriptorSpace space;
  if (descriptor >= 0) {
    header.msg_control = space.bytes;
    header.msg_controllen = sizeof space.bytes;
    cmsghdr* control = CMSG_FIRSTHDR(&header);
    control->cmsg_level = SOL_SOCKET;
    control->cmsg_type = SCM_RIGHTS;
    control->cmsg_len = CMSG_LEN(sizeof(int));
    std::memcpy(CMSG_DATA(control), &descriptor, sizeof descriptor);
  }
  ssize_t sent = -1;
  do {
    sent = ::sendmsg(socket, &header, MSG_NOSIGNAL);
  } while (sent < 0 && errno == EINTR);
  return sent == static_cast<ssize_t>(part.iov_len);
}

bool ReceiveWorkerMessage(int socket, WorkerMessage& message, int wait_ms) {
  pollfd ready = {socket, POLLIN, 0};
  int count = 0;
  do {
    count = ::poll(&ready, 1, wait_ms);
  } while (count < 0 && errno == EINTR);
  if (count <= 0) {
    return false;
  }
  std::string bytes(LargestMessage, '\0');
  iovec part = {bytes.data(), bytes.size()};
  DescriptorSpace space;
  msghdr header = {};
  header.msg_iov = &part;
  header.msg_iovlen = 1;
  header.msg_control = space.bytes;
  header.msg_controllen = sizeof space.bytes;
  ssize_t got = -1;
  do {
    got = ::recvmsg(socket, &header, MSG_CMSG_CLOEXEC);
  } while (got < 0 && errno == EINTR);
  message.descriptor.Close();
  for (cmsghdr* control = got > 0 ? CMSG_FIRSTHDR(&header) : nullptr; control;
       control = CMSG_NXTHDR(&header, control)) {
    if (control->cmsg_level == SOL_SOCKET && control->cmsg_type == SCM_RIGHTS) {
      int descriptor = -1;
      std::memcpy(&descriptor, CMSG_DATA(control), sizeof descriptor);
      message.descriptor = Descriptor(descriptor);
    }
  }
  if (got < 1 ||
      static_cast<std::uint8_t>(bytes[0]) > static_cast<std::uint8_t>(WorkerMessage::Kind::Died)) {
    return false;
  }
  message.kind = static_cast<WorkerMessage::Kind>(bytes[0]);
  message.payload = bytes.substr(1, static_cast<std::size_t>(got) - 1);
  return true;
}

} // namespace dspace
