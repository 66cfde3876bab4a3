// The server's side of the simulation link: gRPC's threads queue, one thread of the caller works.
#ifndef DSPACE_SESSION_SERVER_H
#define DSPACE_SESSION_SERVER_H

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <vector>

#include <dspace/link/LinkAddress.h>
#include <dspace/proto/commands.pb.h>

namespace dspace::session {

struct ServerOptions {
  std::string listen = "127.0.0.1:0"; // port 0: the system chooses; see LinkAddress::Parse
  LinkSecurity security;
  std::string name = "dspace";           // told to clients
  std::size_t maximumMessage = 64 << 20; // bytes of one message to the server, 1 KiB to 1 GiB
  // Viewers and the writer, whose place is kept free: 1 to 1000.
  unsigned maximumConnections = 32;
  double maximumRate = 100000;         // commands a second, > 0; a faster writer is slowed down
  std::size_t queuedCommands = 1024;   // that wait to be carried out, and
  std::size_t queuedBytes = 256 << 20; // their bytes; a writer that is ahead of both waits
  // Bytes that wait for one client that does not read. Beyond, a viewer begins anew with a
  // snapshot, and a writer is cut off (it may come back with its key).
  std::size_t unreadBytes = 256 << 20;
  // A writer whose connection broke, and whose process is not known to have died, keeps its place
  // for so long: others must take over explicitly. One that has ended its side has so long, and a
  // second, to take its last replies. 0 to 1e6.
  double reservation_s = 30;
  double keepalive_s = 20; // a connection that says nothing for so long is asked; > 0, to 1e6
};

// Serves one session to one writer and many viewers. What the session does, it does in the thread
// that calls Run; other threads only queue. Run, Publish and the functions of SessionWork are for
// one thread; Stop may be called from any.
class Server {
public:
  struct SessionWork {
    std::function<v1::Reply(v1::Command&)> execute;     // never throws for what is in a command
    std::function<std::vector<v1::Command>()> snapshot; // what makes the present state
  };

  // Listens from now on, and answers once Run is called. Throws Error: an address or certificates
  // that are refused, limits out of range, an address in use.
  explicit Server(const ServerOptions& options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const std::string& Address() const; // with the port that the system chose

  // Works for so many seconds, or until Stop; false after Stop.
  bool Run(const SessionWork& work, double seconds);
  // Passes an accepted command on to the viewers: from the interpreter's listener.
  void Publish(const v1::Command& command);
  // Ends Run and all connections.
  void Stop();

  struct Counts {
    std::uint64_t commands = 0;  // carried out
    std::uint64_t snapshots = 0; // made for viewers
    unsigned connections = 0;
    unsigned viewers = 0;
    std::size_t waitingBytes = 0; // of commands and of what nobody has read yet
  };
  Counts GetCounts() const;

private:
  struct Hub;
  class Service;
  std::unique_ptr<Hub> Hub_;
};

} // namespace dspace::session

#endif
