// A viewer's connection to a server: it receives snapshots and every accepted command.
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
  std::string name = "viewer"; // shown to people; up to 256 bytes
  double timeout_s = 30;       // for the first connection; > 0, to 1e6
  double keepalive_s = 20;     // a connection that is silent for this time is pinged; > 0, to 1e6
  std::size_t waitingBytes = 64 << 20; // of queued messages; the server queues further ones
};

// Reconnects automatically and without limit after a lost connection; the server then sends a new
// snapshot. Use it from one thread at a time.
class Watcher {
public:
  // Throws Error as RemoteClient does.
  explicit Watcher(const WatcherOptions& options);
  // Non-blocking form. The constructor throws errors of the options, WaitForConnect all others.
  // WaitForConnect waits up to this time; true when connected.
  struct NonBlocking {};
  Watcher(const WatcherOptions& options, NonBlocking);
  bool WaitForConnect(double seconds);
  ~Watcher();
  Watcher(const Watcher&) = delete;
  Watcher& operator=(const Watcher&) = delete;

  // Takes the next message. Waits up to wait_s for it. False if there is none.
  bool Take(v1::WatchReply& message, double wait_s);
  // Takes all queued messages: up to waitingBytes and one more.
  bool TakeAll(std::vector<v1::WatchReply>& messages, double wait_s);
  // Whether it is connected. `why` gets the reason if it is not.
  bool Connected(std::string* why = nullptr) const;
  // Why the server rejects the viewer after an earlier connection: a state that is too large to
  // send, too many viewers. Empty: it does not reject it, or does not respond. The viewer retries
  // every second.
  std::string Rejection() const;
  // Sends an event to the driver and waits up to timeout_s (default: that of the options, which is
  // also the maximum). False if there is no driver. Throws Error.
  bool SendEvent(const v1::ViewerEvent& event);
  bool SendEvent(const v1::ViewerEvent& event, double timeout_s);
  // Non-blocking form of SendEvent: call BeginSendEvent, then WaitForSendEvent with a timeout until
  // it returns true, then TakeSendEventResult, which returns and throws as SendEvent does.
  // CancelSendEvent cancels the wait; the event may still be delivered. BeginSendEvent cancels a
  // pending event.
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
