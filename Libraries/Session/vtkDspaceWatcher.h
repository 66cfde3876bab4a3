/**
 * @class vtkDspaceWatcher
 * @brief A read-only session that follows a server and draws by itself.
 *
 * Update applies the commands that the server has accepted; nothing changes between two calls. A
 * watcher may have its own viewports, vantages and cameras, named "viewer:...", which survive
 * snapshots (<dspace/link/watching/ViewerViews.h>). All other changes are rejected. If the
 * simulation or the server disconnects, the last state stays, and every viewport shows a notice.
 * Methods that can fail return a serialized Reply. No method throws a C++ exception. See
 * <dspace/link/watching/Watcher.h>.
 */
#ifndef vtkDspaceWatcher_h
#define vtkDspaceWatcher_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

class vtkDspaceSession;

class VTKDSPACESESSION_EXPORT vtkDspaceWatcher : public vtkObject {
public:
  static vtkDspaceWatcher* New();
  vtkTypeMacro(vtkDspaceWatcher, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Call before Connect, as for vtkDspaceRemoteSession.
  void SetCertificates(const std::string& certificate, const std::string& key,
                       const std::string& authority);
  void SetInsecure(bool insecure);
  void SetTimeout(double seconds);
  /// For the thread of a GUI: Update(0) never waits, and what a click or a key in an own viewport
  /// sends to the simulation is sent by later calls of Update. At most 100 of them wait.
  void SetInBackground(bool background);
  /// Draws in the render context of another session. Call it before Connect.
  void ShareRenderContext(vtkDspaceSession* other);
  std::string Connect(const std::string& address, const std::string& name);
  /// Non-blocking form of Connect: call BeginConnect, then WaitForConnect with a timeout until it
  /// returns 1 (connected) or -1 (failed: TakeReply returns the error).
  std::string BeginConnect(const std::string& address, const std::string& name);
  int WaitForConnect(double seconds);
  std::string TakeReply();

  /// Applies all received messages. Waits up to this time for the first one. Returns the number of
  /// messages. Skips times and poses that later messages supersede, unless a camera lags, the
  /// session is recorded, or frame events are followed.
  int Update(double wait);
  /// The number of the last applied command. It grows by 1 with each command.
  long long GetSequence();
  /// The state of the connections of the server and of the simulation that drives it.
  bool GetConnected();
  bool GetWriterConnected();
  std::string GetWriterName();
  /// Why the server rejects the viewer, or the first command since the last snapshot that failed
  /// here; empty: no error.
  std::string GetError();

  /// Executes a serialized Command: requests, and changes of the viewer's own views. A click on an
  /// object in an own viewport also sends a ViewerEvent.Picked to the simulation and waits up to 1
  /// s for its delivery.
  std::string Execute(const std::string& command);
  /// Makes the view `as`, whose name begins with "viewer:", like a viewport of the simulation: with
  /// its camera, look, tables and colour bars. NOT_FOUND: there is no such viewport.
  std::string CopyViewport(const std::string& viewport, const std::string& as);
  /// A serialized Reply with the frame events of followed scenes (FollowFrames) since the last
  /// call, in order. Snapshots cause no events. The queue holds at most 100,000 events; older ones
  /// are dropped. Its warnings name objects that this process cannot draw, each once.
  std::string TakeFrameEvents();
  /// Sends a serialized ViewerEvent to the simulation: call BeginSendEvent, then WaitForSendEvent
  /// with a timeout until it returns 1 (delivered) or -1 (failed: TakeReply returns the error,
  /// NOT_FOUND if there is no driver). CancelSendEvent cancels the wait. The connection's timeout
  /// applies.
  std::string BeginSendEvent(const std::string& event);
  int WaitForSendEvent(double seconds);
  void CancelSendEvent();
  /// Sends a serialized ViewerEvent to the simulation without waiting: now, and in later calls of
  /// Update. Returns a serialized Reply: NOT_FOUND if there is no driver, RESOURCE if 100 events
  /// wait already, UNSUPPORTED without SetInBackground(true).
  std::string QueueEvent(const std::string& event);
  /// The session that draws; a new one after each snapshot.
  vtkDspaceSession* GetSession();
  void Close();

protected:
  vtkDspaceWatcher();
  ~vtkDspaceWatcher() override;

private:
  vtkDspaceWatcher(const vtkDspaceWatcher&) = delete;
  void operator=(const vtkDspaceWatcher&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
