// Accepts the connections of a server. Inside the library only.
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

// Accepts connections and passes them to gRPC. gRPC's own listener stops permanently when the
// process runs out of file descriptors. This one accepts at most `maximum` connections, closes
// further ones at once, and waits while there are no descriptors.
class ServerListener {
public:
  // Starts to listen at all addresses of the host. Throws Error(Io).
  ServerListener(const LinkAddress& address, std::size_t maximum);
  ~ServerListener(); // after Stop()
  ServerListener(const ServerListener&) = delete;
  ServerListener& operator=(const ServerListener&) = delete;

  int Port() const { return this->Port_; } // 0 for a Unix socket
  void Start(std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> to);
  void Stop(); // accepts no more connections and frees the address; open ones stay
  // Closes all open connections, including those with unwritten data, for which gRPC's shutdown
  // would wait without limit. Call it after Stop().
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
  int Wake_[2] = {-1, -1};                  // a pipe; closing it ends the thread
  std::vector<std::pair<int, ino_t>> Open_; // open connections at the last check
  std::unique_ptr<grpc::experimental::ExternalConnectionAcceptor> To_;
  std::thread Thread_;
};

// Raises the limit of file descriptors as far as possible and returns it.
std::size_t RaiseDescriptorLimit();

} // namespace dspace::session

#endif
