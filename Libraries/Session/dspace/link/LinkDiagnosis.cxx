#include <dspace/link/LinkDiagnosis.h>

#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <netdb.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <dspace/link/LinkAddress.h>

namespace dspace::session {
namespace {

constexpr int Patience = 1000; // [ms]

// 0 if it connects, else the system's error number.
int Connect(int family, const sockaddr* to, socklen_t size) {
  const int descriptor = socket(family, SOCK_STREAM | SOCK_NONBLOCK | SOCK_CLOEXEC, 0);
  if (descriptor < 0) {
    return errno;
  }
  int result = connect(descriptor, to, size) == 0 ? 0 : errno;
  if (result == EINPROGRESS) {
    pollfd ready{descriptor, POLLOUT, 0};
    socklen_t length = sizeof(result);
    if (poll(&ready, 1, Patience) <= 0) {
      result = ETIMEDOUT;
    } else if (getsockopt(descriptor, SOL_SOCKET, SO_ERROR, &result, &length) != 0) {
      result = errno;
    }
  }
  close(descriptor);
  return result;
}

int ConnectToPath(const std::string& path) {
  sockaddr_un to{};
  to.sun_family = AF_UNIX;
  std::strncpy(to.sun_path, path.c_str(), sizeof(to.sun_path) - 1);
  return Connect(AF_UNIX, reinterpret_cast<const sockaddr*>(&to), sizeof(to));
}

// Below zero: unknown.
int ConnectToPort(const std::string& target) {
  const std::size_t colon = target.rfind(':');
  std::string host = target.substr(0, colon);
  if (host == "localhost") {
    host = "127.0.0.1";
  } else if (host.front() == '[') {
    host = host.substr(1, host.size() - 2);
  }
  addrinfo hints{};
  hints.ai_flags = AI_NUMERICHOST | AI_NUMERICSERV; // a name may take long
  hints.ai_socktype = SOCK_STREAM;
  addrinfo* found = nullptr;
  if (getaddrinfo(host.c_str(), target.substr(colon + 1).c_str(), &hints, &found) != 0) {
    return -1;
  }
  const int result = Connect(found->ai_family, found->ai_addr, found->ai_addrlen);
  freeaddrinfo(found);
  return result;
}

} // namespace

std::string DiagnoseConnection(const std::string& address, bool encrypted) {
  const LinkAddress parsed = LinkAddress::Parse(address);
  const std::string accepted = "; accepted: the address of a `dspace serve`";
  struct stat state {};
  if (!parsed.path.empty() && stat(parsed.path.c_str(), &state) == 0 && !S_ISSOCK(state.st_mode)) {
    return "the file is not a socket" + accepted;
  }
  const int result =
      parsed.path.empty() ? ConnectToPort(parsed.target) : ConnectToPath(parsed.path);
  if (result == ENOENT) {
    return "the socket does not exist" + accepted;
  }
  if (result == ECONNREFUSED) {
    return "no process listens there" + accepted;
  }
  if (result == 0 || result == EAGAIN) { // EAGAIN: a Unix socket whose server hangs
    return std::string("a process listens there but does not accept this client: it hangs, is not "
                       "`dspace serve`, ") +
           (encrypted ? "does not use certificates, or uses those of another authority; accepted: "
                        "certificates of one authority"
                      : "or requires certificates; accepted: those of its authority");
  }
  return (result < 0 ? std::string("its host may be unknown or unreachable")
                     : std::string(std::strerror(result))) +
         accepted;
}

} // namespace dspace::session
