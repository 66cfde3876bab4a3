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
  std::string name = "simulation"; // shown to people; up to 256 bytes
  double timeout_s = 30;           // of the connection, a reply, the send window; > 0, to 1e6
  bool takeOver = false;           // replaces another driver
  bool onlyChanges = true;         // does not send poses again that the server already has
  // Simulation seconds per wall second: a command that sets a scene's time is sent when it is due,
  // relative to the first one (see Pacer). 0: no pacing.
  double pace = 0;
  double keepalive_s = 20; // a connection that is silent for this time is pinged; > 0, to 1e6
  // The send window: limits of unanswered commands. A sender that reaches either limit waits.
  std::size_t windowCommands = 1024;
  std::size_t windowBytes = 16 << 20;
};

// Use it from one thread at a time. It reconnects after a lost connection, up to the timeout. Each
// command is executed exactly once even if the connection was lost. If the server was restarted,
// its scenes are lost, and every call returns an error. Calls in a child process (fork) return an
// error too; a child may only destroy the client.
class RemoteClient {
public:
  // Connects. Throws Error: InvalidArgument (address, certificates, timeout), AlreadyExists (there
  // is another driver), Unsupported (another protocol), Io (no server, or the connection is
  // rejected), DeadlineExceeded.
  explicit RemoteClient(const RemoteClientOptions& options);
  // Non-blocking form. The constructor throws errors of the options, WaitForConnect all others.
  // WaitForConnect waits up to this time; true when connected.
  struct NonBlocking {};
  RemoteClient(const RemoteClientOptions& options, NonBlocking);
  bool WaitForConnect(double seconds);
  // Disconnects within 3 s, so that another client may drive at once. Commands that were sent
  // without waiting may be lost: call Flush first.
  ~RemoteClient();
  RemoteClient(const RemoteClient&) = delete;
  RemoteClient& operator=(const RemoteClient&) = delete;

  // Executes one command and waits for its reply. Never throws: errors of the link (Io,
  // DeadlineExceeded) are error replies. After a timeout it is unknown whether the command was
  // executed. Relative paths refer to this process's working folder. If an earlier command that was
  // sent without waiting has failed, its error is returned and this command is not executed.
  v1::Reply Execute(v1::Command command);
  // Sends a command without waiting for its reply. Returns an empty reply, or the error of the link
  // or of an earlier command.
  v1::Reply Send(v1::Command command);
  // Waits until all sent commands are completed. Returns the first error, the warnings and the
  // frame events of commands that were sent without waiting.
  v1::Reply Flush();

  // Non-blocking form of Execute, Send and Flush: call Begin or BeginFlush, then Wait with a
  // timeout until it returns true, then Take, which returns the reply. Abandon cancels the wait:
  // the command may still be executed, and its reply is dropped. Begin abandons a command that is
  // still pending.
  void Begin(v1::Command command, bool reply = true);
  void BeginFlush();
  bool Wait(double seconds);
  v1::Reply Take();
  void Abandon();

  // Sets the pace, as in the options. Throws Error(InvalidArgument) if it is not finite or below 0.
  void SetPace(double rate);

  // Calls `handle` for each event of a viewer since the last call, in order. Waits up to `wait_s`
  // for the first event, or until the link fails permanently. Returns the number of events. The
  // queue holds at most 10,000 events and 16 MiB; older events are dropped.
  std::size_t TakeEvents(const std::function<void(const v1::ViewerEvent&)>& hear,
                         double wait_s = 0);
  // The error of a permanently failed link; empty if it has not failed.
  v1::Reply Broken() const;

  struct Counts {
    std::uint64_t sent = 0;         // commands
    std::uint64_t bytes = 0;        // of them
    std::uint64_t posesLeftOut = 0; // unchanged poses that were not sent
    std::uint64_t reconnections = 0;
  };
  Counts GetCounts() const;

  struct ServerInfo {
    std::string name;               // for people
    unsigned commandSet = 0;        // its COMMAND_SET_VERSION (service.proto)
    std::size_t maximumMessage = 0; // of a command [bytes]
  };
  ServerInfo GetServer() const; // of the last connection

private:
  struct Link;
  std::unique_ptr<Link> Link_;
};

} // namespace dspace::session

#endif
