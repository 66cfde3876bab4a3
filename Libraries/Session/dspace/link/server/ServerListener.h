// Where a server's connections come in. Inside the library only.
#ifndef DSPACE_SESSION_SERVER_LISTENER_H
#define DSPACE_SESSION_SERVER_LISTENER_H

#include <cstddef>
#include <memory>
#include <string>
#include <thread>
#include <utility>
#include <vector>

#include <grpcpp/server_builder.h>
#include <sys/types.h>

#include <dspace/link/LinkAddress.h>

namespace dspace::session {

// Accepts connections and hands them to gRPC, whose own listener gives up for good once the process
// has no file descriptor left. Here a flood takes no more than `maximum` of them; what comes beyond
// is closed at once, and when descriptors are short all the same it waits until there are some.
class ServerListener {
public:
  // Listens from now on: at all addresses of a host's name. Throws Error(Io).
  ServerListener(const LinkAddress& address, std::size_t maximum);
  ~ServerListener(); // after Stop()
  ServerListener(const ServerListener&) = delete;
  ServerListener& operator=(const ServerListener&) = delete;

  int Port() const { return this->Port_; } // 0 for a Unix socket
  void Start(std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> to);
  void Stop(); // accepts no more, its place is free; those that are open stay so
  // Ends all that are open, also where something waits to be written: gRPC's own shutdown waits for
  // that, however long the other side does not read. After Stop().
  void CloseConnections();

private:
  void ListenAtPath(const std::string& path);
  void ListenAtHost(const std::string& target);
  void Accept();
  void Take(int listener, int connection);

  std::size_t Maximum_;
  std::vector<int> Listeners_;
  std::string Path_;
  ino_t PathInode_ = 0;
  int Port_ = 0;
  int Wake_[2] = {-1, -1};                  // a pipe: closed to end the thread
  std::vector<std::pair<int, ino_t>> Open_; // connections that were open when last looked at
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> To_;
  std::thread Thread_;
};

// As many file descriptors as this process may have: returns how many.
std::size_t RaiseDescriptorLimit();

} // namespace dspace::session

#endif
