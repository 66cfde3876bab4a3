// Drives a server's session: the same commands and replies as an Interpreter's, over the link.
#ifndef DSPACE_SESSION_REMOTE_CLIENT_H
#define DSPACE_SESSION_REMOTE_CLIENT_H

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <string>

#include <dspace/link/LinkAddress.h>
#include <dspace/proto/commands.pb.h>
#include <dspace/proto/service.pb.h>

namespace dspace::session {

struct RemoteClientOptions {
  std::string address; // see LinkAddress::Parse
  LinkSecurity security;
  std::string name = "simulation"; // told to the server, for people; up to 256 bytes
  double timeout_s = 30;   // of every wait: for the connection, a reply, room to send; > 0, to 1e6
  bool takeOver = false;   // drives even if somebody else does
  bool onlyChanges = true; // poses that the server has already are not sent again
  // Simulation seconds a wall second: a command that sets a scene's time is sent once it is due,
  // counted from the first one (and anew from one that goes back). 0: as fast as it goes.
  double pace = 0;
  double keepalive_s = 20; // a connection that says nothing for so long is asked; > 0, to 1e6
  // What may be on its way without an answer; a sender that is ahead of either waits.
  std::size_t windowCommands = 1024;
  std::size_t windowBytes = 16 << 20;
};

// For one thread at a time. A connection that is lost is made again while somebody waits, up to the
// timeout; each command is carried out once, whatever happened to the connection. When the server
// itself was started anew the scene is gone, and everything answers with an error that says so. So
// it does in a child of the process that connected (fork), which may only destroy it.
class RemoteClient {
public:
  // Connects. Throws Error: InvalidArgument (address, certificates, timeout), AlreadyExists
  // (somebody drives), Unsupported (another protocol), Io (nobody there, not let in),
  // DeadlineExceeded.
  explicit RemoteClient(const RemoteClientOptions& options);
  // The same for whoever must do other things meanwhile: it throws what is wrong with the options,
  // and WaitForConnect the rest. WaitForConnect waits so many seconds; true once it is connected.
  struct NonBlocking {};
  RemoteClient(const RemoteClientOptions& options, NonBlocking);
  bool WaitForConnect(double seconds);
  // Says goodbye to the server, so that another one may drive at once, for up to 3 s. What was sent
  // without waiting may be lost: Flush before.
  ~RemoteClient();
  RemoteClient(const RemoteClient&) = delete;
  RemoteClient& operator=(const RemoteClient&) = delete;

  // Carries out one command and waits for its reply. Never throws: errors of the link (Io,
  // DeadlineExceeded) come as an error reply; after a deadline it is not known whether it was done.
  // Paths in the command that are relative are those of this process's working folder. An error
  // that a command before it left, which nobody waited for, comes in its stead; it is then not
  // carried out.
  v1::Reply Execute(v1::Command command);
  // The same without waiting. Empty, or the error of the link or of an earlier command.
  v1::Reply Send(v1::Command command);
  // Waits until all that was sent is done: with the first error, the warnings and the frame events
  // of what nobody waited for.
  v1::Reply Flush();

  // These three in parts, for whoever must do other things while they wait: Begin (or BeginFlush),
  // then Wait, up to so many seconds each time, until it is true, then Take, which is what Execute,
  // Send and Flush return. Abandon waits no longer: what was sent may yet be carried out, and its
  // reply is dropped; Begin does that with what has not been taken.
  void Begin(v1::Command command, bool reply = true);
  void BeginFlush();
  bool Wait(double seconds);
  v1::Reply Take();
  void Abandon();

  // Simulation seconds a wall second, as in the options. Throws Error(InvalidArgument) for what is
  // not finite or below 0.
  void SetPace(double rate);

  // What viewers said since the last call, in order: each is handed to `hear`. They are there after
  // any reply; `wait_s` waits for the first, but no longer than until the link is broken for good.
  // Returns how many. At most 10,000 of 16 MiB in all wait; older ones go.
  std::size_t TakeEvents(const std::function<void(const v1::ViewerEvent&)>& hear,
                         double wait_s = 0);
  // The error of a link that is broken for good; empty while it is not.
  v1::Reply Broken() const;

  struct Counts {
    std::uint64_t sent = 0;         // commands
    std::uint64_t bytes = 0;        // of them
    std::uint64_t posesLeftOut = 0; // that had not changed
    std::uint64_t reconnections = 0;
  };
  Counts GetCounts() const;

  struct ServerInfo {
    std::string name;               // for people
    unsigned commandSet = 0;        // its COMMAND_SET_VERSION (service.proto)
    std::size_t maximumMessage = 0; // bytes of a command
  };
  ServerInfo GetServer() const; // of the last time that it was connected

private:
  struct Link;
  std::unique_ptr<Link> Link_;
};

} // namespace dspace::session

#endif
