// The server's side of the simulation link: gRPC's threads queue commands, one thread of the caller
// executes them.
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
  std::string name = "dspace";           // shown to clients
  std::size_t maximumMessage = 64 << 20; // bytes of one message to the server, 1 KiB to 1 GiB
  // Number of viewers and the writer, for whom one connection is reserved: 1 to 1000.
  unsigned maximumConnections = 32;
  double maximumRate = 100000;         // commands a second, > 0; a faster writer is slowed down
  std::size_t queuedCommands = 1024;   // limits of queued commands: number
  std::size_t queuedBytes = 256 << 20; // and bytes; a writer that reaches one of them waits
  // Bytes that are queued for one client. Beyond this limit a viewer gets a new snapshot, and a
  // writer is disconnected (it may resume with its key).
  std::size_t unreadBytes = 256 << 20;
  // A disconnected writer keeps its reservation for this time, unless its process has died; another
  // client needs `take_over` to drive earlier. A writer that has closed its side has this time plus
  // 1 s to receive its last replies. 0 to 1e6.
  double reservation_s = 30;
  // Whether `reset` is called before the first command of a writer that does not resume.
  bool freshOnConnect = false;
  double keepalive_s = 20; // a connection that is silent for this time is pinged; > 0, to 1e6
};

// Serves one session to one writer and many viewers. The session works in the thread that calls
// Run; other threads only queue. Call Run, Publish and the functions of SessionWork from one
// thread. Stop may be called from any thread.
class Server {
public:
  struct SessionWork {
    std::function<v1::Reply(v1::Command&)> execute; // never throws because of a command's content
    std::function<std::vector<v1::Command>()>
        snapshot;                     // the commands that create the present state
    std::function<void()> reset = {}; // removes the state; only with ServerOptions::freshOnConnect
  };

  // Starts to listen; clients are served while Run is called. Throws Error for a rejected address
  // or certificate, a limit out of range, and an address in use.
  explicit Server(const ServerOptions& options);
  ~Server();
  Server(const Server&) = delete;
  Server& operator=(const Server&) = delete;

  const std::string& Address() const; // with the port that the system chose

  // Executes commands for this time, or until Stop. Returns false after Stop.
  bool Run(const SessionWork& work, double seconds);
  // Sends an accepted command to the viewers. Call it from the interpreter's listener.
  void Publish(const v1::Command& command);
  // Ends Run and all connections.
  void Stop();

  struct Counts {
    std::uint64_t commands = 0;  // executed
    std::uint64_t snapshots = 0; // made for viewers
    unsigned connections = 0;
    unsigned viewers = 0;
    std::size_t waitingBytes = 0; // of queued commands and unread messages
  };
  Counts GetCounts() const;

private:
  struct Hub;
  class Service;
  std::unique_ptr<Hub> Hub_;
};

} // namespace dspace::session

#endif
