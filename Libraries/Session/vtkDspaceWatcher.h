/**
 * @class vtkDspaceWatcher
 * @brief A read-only session that follows a server's and draws for itself.
 *
 * Update applies what the server has accepted; between two calls nothing changes. Viewports,
 * vantages and cameras of the watcher's own, named "viewer:...", may be made, and outlast snapshots
 * (<dspace/link/watching/ViewerViews.h>); all other changes are refused. Where the simulation or
 * the server is gone the last picture stays, and every viewport says so. No C++ exception leaves a
 * method; what can fail returns a serialized Reply. See <dspace/link/watching/Watcher.h>.
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

  /// To be set before Connect, as for vtkDspaceRemoteSession.
  void SetCertificates(const std::string& certificate, const std::string& key,
                       const std::string& authority);
  void SetInsecure(bool insecure);
  void SetTimeout(double seconds);
  std::string Connect(const std::string& address, const std::string& name);
  /// The same in two parts, for whoever must do other things meanwhile: BeginConnect, then
  /// WaitForConnect, up to so many seconds each time, until it returns 1 (connected) or -1 (no:
  /// TakeReply says why).
  std::string BeginConnect(const std::string& address, const std::string& name);
  int WaitForConnect(double seconds);
  std::string TakeReply();

  /// Applies all that has come; waits up to so many seconds for something. Returns how many
  /// messages. Times and poses that later ones make needless are left out, unless a camera lags,
  /// the session is recorded or changes of frames are followed.
  int Update(double wait);
  /// The number of the last command that is in the state: it grows by one a command.
  long long GetSequence();
  /// Of the server, and of the simulation that drives it.
  bool GetConnected();
  bool GetWriterConnected();
  std::string GetWriterName();
  /// Why the server refuses to go on, or what could not be applied since the last snapshot; empty:
  /// nothing.
  std::string GetError();

  /// Carries out a serialized Command: requests, and commands on views of one's own. An event that
  /// clicks on something in a viewport of one's own also tells the simulation (ViewerEvent.Picked),
  /// which it waits for up to 1 s.
  std::string Execute(const std::string& command);
  /// A serialized Reply with what has happened to the frames of followed scenes (FollowFrames)
  /// since the last call, in order. A snapshot brings none. At most 100,000 wait; older ones go.
  std::string TakeFrameEvents();
  /// Sends a serialized ViewerEvent to the simulation: BeginSendEvent, then WaitForSendEvent, up to
  /// so many seconds each time, until it returns 1 (told) or -1 (no: TakeReply says why; its error
  /// is NOT_FOUND when nobody drives). CancelSendEvent waits no longer. The timeout is the
  /// connection's.
  std::string BeginSendEvent(const std::string& event);
  int WaitForSendEvent(double seconds);
  void CancelSendEvent();
  /// What draws; another one after each snapshot.
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
