#include <dspace/link/server/ServerListener.h>

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <fcntl.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

#include <dspace/Error.h>

namespace dspace::session {
namespace {

constexpr int Backlog = 128;
constexpr int ToWait_ms = 50;             // where there is no descriptor
constexpr unsigned MostUnread_ms = 60000; // what was sent and the other side does not confirm

[[noreturn]] void Reject(const std::string& target, const std::string& why) {
  throw Error(Error::Kind::Io, "address '" + target + "'",
              "the system does not let a server listen there: " + why);
}

// The inode of an open connection; 0: it is not open.
ino_t InodeOf(int descriptor) {
  struct stat info = {};
  return fstat(descriptor, &info) == 0 && S_ISSOCK(info.st_mode) ? info.st_ino : 0;
}

int PortOf(int listener) {
  sockaddr_storage place = {};
  socklen_t size = sizeof(place);
  if (getsockname(listener, reinterpret_cast<sockaddr*>(&place), &size) != 0) {
    return 0;
  }
  return ntohs(place.ss_family == AF_INET6 ? reinterpret_cast<sockaddr_in6&>(place).sin6_port
                                           : reinterpret_cast<sockaddr_in&>(place).sin_port);
}

void SetPort(addrinfo& at, int port) {
  if (at.ai_family == AF_INET6) {
    reinterpret_cast<sockaddr_in6*>(at.ai_addr)->sin6_port = htons(std::uint16_t(port));
  } else {
    reinterpret_cast<sockaddr_in*>(at.ai_addr)->sin_port = htons(std::uint16_t(port));
  }
}

} // namespace

std::size_t RaiseDescriptorLimit() {
  rlimit limit = {};
  if (getrlimit(RLIMIT_NOFILE, &limit) != 0) {
    return 1024;
  }
  // More than a million descriptors cost memory and are not needed.
  const rlim_t wanted = std::min<rlim_t>(limit.rlim_max, 1 << 20);
  if (limit.rlim_cur < wanted) {
    const rlimit raised = {wanted, limit.rlim_max};
    if (setrlimit(RLIMIT_NOFILE, &raised) == 0) {
      return std::size_t(wanted);
    }
  }
  return std::size_t(limit.rlim_cur);
}

ServerListener::ServerListener(const LinkAddress& address, std::size_t maximum)
    : Maximum_(maximum) {
  try {
    if (pipe2(this->Wake_, O_CLOEXEC) != 0) {
      Reject(address.target, std::strerror(errno));
    }
    if (address.path.empty()) {
      this->ListenAtHost(address.target);
    } else {
      this->ListenAtPath(address.path);
    }
  } catch (...) {
    for (const int each : {this->Wake_[0], this->Wake_[1]}) {
      close(each);
    }
    for (const int each : this->Listeners_) {
      close(each);
    }
    throw;
  }
}

void ServerListener::Stop() {
  if (this->Wake_[1] >= 0) {
    close(std::exchange(this->Wake_[1], -1));
  }
  if (this->Thread_.joinable()) {
    this->Thread_.join();
  }
  for (const int each : this->Listeners_) {
    close(each);
  }
  this->Listeners_.clear();
  struct stat info = {};
  if (!this->Path_.empty() && lstat(this->Path_.c_str(), &info) == 0 &&
      info.st_ino == this->PathInode_) { // not another server's by now
    unlink(this->Path_.c_str());
  }
  this->Path_.clear();
}

void ServerListener::CloseConnections() {
  for (const auto& [connection, inode] : this->Open_) {
    if (InodeOf(connection) == inode) {
      shutdown(connection, SHUT_RDWR);
    }
  }
}

ServerListener::~ServerListener() {
  this->Stop();
  close(this->Wake_[0]);
}

void ServerListener::ListenAtPath(const std::string& path) {
  struct stat info = {};
  if (lstat(path.c_str(), &info) == 0 && S_ISSOCK(info.st_mode)) {
    unlink(path.c_str()); // of a server that has died
  }
  sockaddr_un place = {};
  place.sun_family = AF_UNIX;
  std::copy(path.begin(), path.end(), place.sun_path);
  const int listener = socket(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
  if (listener < 0) {
    Reject("unix:" + path, std::strerror(errno));
  }
  this->Listeners_.push_back(listener);
  // Accessible to the owner only from the start, minus the process's umask. (Setting the umask
  // temporarily would affect all threads.)
  if (fchmod(listener, 0700) != 0 ||
      bind(listener, reinterpret_cast<sockaddr*>(&place), sizeof(place)) != 0 ||
      listen(listener, Backlog) != 0) {
    Reject("unix:" + path, std::strerror(errno));
  }
  this->Path_ = path;
  this->PathInode_ = lstat(path.c_str(), &info) == 0 ? info.st_ino : 0;
}

void ServerListener::ListenAtHost(const std::string& target) {
  const std::size_t colon = target.rfind(':');
  std::string host = target.substr(0, colon);
  if (host.front() == '[') {
    host = host.substr(1, host.size() - 2);
  }
  addrinfo hints = {};
  hints.ai_socktype = SOCK_STREAM;
  hints.ai_flags = AI_PASSIVE | AI_NUMERICSERV;
  addrinfo* found = nullptr;
  const int unknown = getaddrinfo(host.c_str(), target.substr(colon + 1).c_str(), &hints, &found);
  if (unknown != 0) {
    Reject(target, gai_strerror(unknown));
  }
  const std::unique_ptr<addrinfo, void (*)(addrinfo*)> all(found, freeaddrinfo);
  std::string why;
  for (addrinfo* at = found; at; at = at->ai_next) {
    if (at->ai_family != AF_INET && at->ai_family != AF_INET6) {
      continue;
    }
    if (this->Port_ != 0) {
      SetPort(*at, this->Port_); // the same for all of them
    }
    const int listener =
        socket(at->ai_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, IPPROTO_TCP);
    const int on = 1;
    const int off = 0;
    if (listener >= 0) {
      setsockopt(listener, SOL_SOCKET, SO_REUSEADDR, &on, sizeof(on));
      if (at->ai_family == AF_INET6) {
        setsockopt(listener, IPPROTO_IPV6, IPV6_V6ONLY, host == "::" ? &off : &on, sizeof(on));
      }
      if (bind(listener, at->ai_addr, at->ai_addrlen) == 0 && listen(listener, Backlog) == 0) {
        this->Listeners_.push_back(listener);
        this->Port_ = PortOf(listener);
        continue;
      }
    }
    const int error = errno;
    close(listener);
    why = std::strerror(error);
    if (error == EADDRINUSE) {
      Reject(target, why); // do not share an address with another server
    }
  }
  if (this->Listeners_.empty()) {
    Reject(target, why);
  }
}

void ServerListener::Start(std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> to) {
  this->To_ = std::move(to);
  this->Thread_ = std::thread([this] { this->Accept(); });
}

void ServerListener::Accept() {
  std::vector<pollfd> waits = {{this->Wake_[0], POLLIN, 0}};
  for (const int each : this->Listeners_) {
    waits.push_back({each, POLLIN, 0});
  }
  while (true) {
    poll(waits.data(), waits.size(), -1);
    if (waits[0].revents != 0) {
      return;
    }
    for (std::size_t i = 1; i < waits.size(); ++i) {
      if (waits[i].revents == 0) {
        continue;
      }
      const int connection = accept4(waits[i].fd, nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK);
      if (connection >= 0) {
        this->Take(waits[i].fd, connection);
      } else if (errno != EAGAIN && errno != EINTR && errno != ECONNABORTED) {
        poll(waits.data(), 1, ToWait_ms);
      }
    }
  }
}

void ServerListener::Take(int listener, int connection) {
  // gRPC does not report closed connections; their descriptors may be unused or belong to other
  // sockets.
  this->Open_.erase(std::remove_if(this->Open_.begin(), this->Open_.end(),
                                   [connection](const std::pair<int, ino_t>& each) {
                                     return each.first == connection ||
                                            InodeOf(each.first) != each.second;
                                   }),
                    this->Open_.end());
  if (this->Open_.size() >= this->Maximum_) {
    close(connection);
    return;
  }
  this->Open_.emplace_back(connection, InodeOf(connection));
  const int on = 1;
  setsockopt(connection, IPPROTO_TCP, TCP_NODELAY, &on, sizeof(on)); // of no use to a Unix socket
  setsockopt(connection, IPPROTO_TCP, TCP_USER_TIMEOUT, &MostUnread_ms, sizeof(MostUnread_ms));
  grpc::experimental::ExternalConnectionAcceptor::NewConnectionParameters parameters;
  parameters.listener_fd = listener;
  parameters.fd = connection;
  this->To_->HandleNewConnection(&parameters);
}

} // namespace dspace::session
