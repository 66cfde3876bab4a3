// Watches a server: what rebuilds its state, and then every accepted command.
#ifndef DSPACE_SESSION_WATCHER_H
#define DSPACE_SESSION_WATCHER_H

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <dspace/link/LinkAddress.h>
#include <dspace/proto/service.pb.h>

namespace dspace::session {

struct WatcherOptions {
  std::string address; // see LinkAddress::Parse
  LinkSecurity security;
  std::string name = "viewer"; // told to the server, for people; up to 256 bytes
  double timeout_s = 30;       // for the first connection; > 0, to 1e6
  double keepalive_s = 20;     // a connection that says nothing for so long is asked; > 0, to 1e6
  std::size_t waitingBytes = 64 << 20; // of messages not taken yet; beyond, the server keeps them
};

// Connects again by itself, for ever, whenever the connection is lost: the server then sends a new
// snapshot. For one thread at a time.
class Watcher {
public:
  // Throws Error as RemoteClient does.
  explicit Watcher(const WatcherOptions& options);
  // The same for whoever must do other things meanwhile: it throws what is wrong with the options,
  // and WaitForConnect the rest. WaitForConnect waits so many seconds; true once it is connected.
  struct NonBlocking {};
  Watcher(const WatcherOptions& options, NonBlocking);
  bool WaitForConnect(double seconds);
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  // The next message; waits up to wait_s for it. False when there is none yet.
  bool Take(v1::WatchReply& message, double wait_s);
  // The same of all that have come: up to waitingBytes of them and one.
  bool TakeAll(std::vector<v1::WatchReply>& messages, double wait_s);
  // Whether there is a connection, and a word on why not.
  bool Connected(std::string* why = nullptr) const;
  // Why the server refuses what it did not refuse before: a state that is too large to be sent, too
  // many viewers. Empty: it does not, or nobody answers. It is asked again each second.
  std::string Rejection() const;
  // Sends an event to whoever drives, waiting up to timeout_s (of the options, or a shorter one);
  // false when nobody does. Throws Error.
  bool SendEvent(const v1::ViewerEvent& event);
  bool SendEvent(const v1::ViewerEvent& event, double timeout_s);
  // The same in parts, for whoever must do other things meanwhile: BeginSendEvent, then
  // WaitForSendEvent, up to so many seconds each time, until it is true, then TakeSendEventResult,
  // which returns and throws what Tell does. CancelSendEvent waits no longer: the event may yet be
  // heard. BeginSendEvent drops one that has not been taken.
  void BeginSendEvent(const v1::ViewerEvent& event, double timeout_s);
  bool WaitForSendEvent(double seconds);
  bool TakeSendEventResult();
  void CancelSendEvent();

private:
  struct Link;
  std::unique_ptr<Link> Link_;
};

} // namespace dspace::session

#endif
