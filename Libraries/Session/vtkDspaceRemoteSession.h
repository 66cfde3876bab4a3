/**
 * @class vtkDspaceRemoteSession
 * @brief A session in a server process: vtkDspaceSession's Execute over the simulation link.
 *
 * Everything that can fail returns a serialized Reply, whose error says what did; no C++ exception
 * leaves a method. See <dspace/link/client/RemoteClient.h>, which this wraps for Python.
 */
#ifndef vtkDspaceRemoteSession_h
#define vtkDspaceRemoteSession_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

class VTKDSPACESESSION_EXPORT vtkDspaceRemoteSession : public vtkObject {
public:
  static vtkDspaceRemoteSession* New();
  vtkTypeMacro(vtkDspaceRemoteSession, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// PEM files; all three empty: neither encrypted nor authenticated. To be set before Connect.
  void SetCertificates(const std::string& certificate, const std::string& key,
                       const std::string& authority);
  void SetInsecure(bool insecure);
  /// Of every wait [s], above 0; default 30.
  void SetTimeout(double seconds);
  /// Drives even if somebody else does. Default off.
  void SetTakeOver(bool takeOver);
  /// Poses that the server has already are not sent again. Default on.
  void SetOnlyChanges(bool onlyChanges);
  /// Simulation seconds a wall second, 0 (the default) for none; also while connected. Returns what
  /// went wrong, or an empty string.
  std::string SetPace(double rate);

  /// To "host:port" or "unix:PATH", under a name for people.
  std::string Connect(const std::string& address, const std::string& name);
  /// The same in two parts, for whoever must do other things meanwhile: BeginConnect, then
  /// WaitForConnect, up to so many seconds each time, until it returns 1 (connected) or -1 (no:
  /// TakeReply says why).
  std::string BeginConnect(const std::string& address, const std::string& name);
  int WaitForConnect(double seconds);
  /// Carries out a serialized Command and returns the serialized Reply.
  std::string Execute(const std::string& command);
  /// The same without waiting: the reply is empty, or an earlier command's error.
  std::string Send(const std::string& command);
  /// Waits until everything sent is done.
  std::string Flush();
  /// These three in parts: Begin (without a reply: Send) or BeginFlush; Wait, up to so many seconds
  /// each time, until it is true; TakeReply. Abandon waits no longer, see RemoteClient.h.
  void Begin(const std::string& command, bool reply);
  void BeginFlush();
  bool Wait(double seconds);
  std::string TakeReply();
  void Abandon();
  /// The next ViewerEvent, serialized; waits up to so many seconds, but no longer than until the
  /// link is broken for good. Empty: there is none.
  std::string TakeEvent(double wait);
  /// A serialized Reply with the error of a link that is broken for good; empty while it is not.
  std::string GetBroken();
  /// Pose updates that were left out because nothing had changed.
  long long GetPosesLeftOut();
  /// How far the server's command set goes (COMMAND_SET_VERSION in service.proto); 0: not known.
  int GetServerCommandSet();
  void Close();

protected:
  vtkDspaceRemoteSession();
  ~vtkDspaceRemoteSession() override;

private:
  vtkDspaceRemoteSession(const vtkDspaceRemoteSession&) = delete;
  void operator=(const vtkDspaceRemoteSession&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
