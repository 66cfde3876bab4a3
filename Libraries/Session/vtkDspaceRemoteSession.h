/**
 * @class vtkDspaceRemoteSession
 * @brief A session in a server process: vtkDspaceSession's Execute over the simulation link.
 *
 * Methods that can fail return a serialized Reply with the error. No method throws a C++ exception.
 * See <dspace/link/client/RemoteClient.h>, which this wraps for Python.
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

  /// PEM files; all three empty: no encryption and no authentication. Call before Connect.
  void SetCertificates(const std::string& certificate, const std::string& key,
                       const std::string& authority);
  void SetInsecure(bool insecure);
  /// Timeout of every wait [s], above 0; default 30.
  void SetTimeout(double seconds);
  /// Replaces another driver. Default off.
  void SetTakeOver(bool takeOver);
  /// Does not send poses again that the server already has. Default on.
  void SetOnlyChanges(bool onlyChanges);
  /// Simulation seconds per wall second; 0 (the default): no pacing. May be changed while
  /// connected. Returns the error, or an empty string.
  std::string SetPace(double rate);

  /// Connects to "host:port" or "unix:PATH". `name` is shown to people.
  std::string Connect(const std::string& address, const std::string& name);
  /// Non-blocking form of Connect: call BeginConnect, then WaitForConnect with a timeout until it
  /// returns 1 (connected) or -1 (failed: TakeReply returns the error).
  std::string BeginConnect(const std::string& address, const std::string& name);
  int WaitForConnect(double seconds);
  /// Executes a serialized Command and returns the serialized Reply.
  std::string Execute(const std::string& command);
  /// Sends a command without waiting. The reply is empty, or an earlier command's error.
  std::string Send(const std::string& command);
  /// Waits until all sent commands are completed.
  std::string Flush();
  /// Non-blocking form of Execute, Send (`reply` false) and Flush: call Begin or BeginFlush, then
  /// Wait with a timeout until it returns true, then TakeReply. Abandon cancels the wait, see
  /// RemoteClient.h.
  void Begin(const std::string& command, bool reply);
  void BeginFlush();
  bool Wait(double seconds);
  std::string TakeReply();
  void Abandon();
  /// Takes the next ViewerEvent, serialized. Waits up to this time, or until the link fails
  /// permanently. Empty: there is none.
  std::string TakeEvent(double wait);
  /// A serialized Reply with the error of a permanently failed link; empty if it has not failed.
  std::string GetBroken();
  /// Number of unchanged poses that were not sent.
  long long GetPosesLeftOut();
  /// The version of the server's command set (COMMAND_SET_VERSION in service.proto); 0: unknown.
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
