/**
 * @class vtkDspaceRecorder
 * @brief Records the commands that a server accepts, for the simulation that drives it.
 *
 * A watcher of the server and its own session run in a thread, which records without further calls.
 * It does not draw, but it executes every command: it reads models and terrain by the server's
 * paths and has a graphics context for the viewports. A command that fails here is recorded
 * nevertheless and causes a warning (TakeWarnings).
 *
 * Call it from one thread. No method waits longer than its timeout. A child process (fork) may only
 * destroy it. No method throws a C++ exception.
 */
#ifndef vtkDspaceRecorder_h
#define vtkDspaceRecorder_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

class VTKDSPACESESSION_EXPORT vtkDspaceRecorder : public vtkObject {
public:
  static vtkDspaceRecorder* New();
  vtkTypeMacro(vtkDspaceRecorder, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Call before BeginConnect, as for vtkDspaceRemoteSession. The timeout [s] (above 0, to 1e6;
  /// default 30) is also the time after which the recording ends if the server does not respond.
  void SetCertificates(const std::string& certificate, const std::string& key,
                       const std::string& authority);
  void SetInsecure(bool insecure);
  void SetTimeout(double seconds);
  /// Call BeginConnect, then WaitForConnect with a timeout until it returns 1 (connected) or -1
  /// (failed: TakeReply returns a serialized Reply with the error).
  std::string BeginConnect(const std::string& address, const std::string& name);
  int WaitForConnect(double seconds);
  std::string TakeReply();

  /// Then call BeginRecord once, as vtkDspaceSession::Record, and WaitForRecord until it returns 1
  /// (the recording exists and starts with the server's state) or -1 (failed: GetRecordingFailure
  /// returns the reason).
  void BeginRecord(const std::string& path, double commitEvery, bool pack);
  int WaitForRecord(double seconds);
  /// Waits until the command of this number (Reply.sequence) is recorded. Returns 1: recorded, 0:
  /// timeout, -1: it will not be recorded.
  int WaitFor(long long sequence, double seconds);
  /// The number of the last command that is recorded or included in the first snapshot.
  long long GetSequence();
  /// Call BeginFlush, then WaitForFlush until it returns true: everything recorded is written, or
  /// writing has failed.
  void BeginFlush();
  bool WaitForFlush(double seconds);
  /// BeginStop ends the recording with the commands received so far. WaitForStop returns true when
  /// the file is closed.
  void BeginStop();
  bool WaitForStop(double seconds);

  /// As in vtkDspaceSession, at most 0.1 s old.
  unsigned long long GetRecordingCount(const std::string& name);
  /// Why the recording has failed: the disk, or a server that is unreachable or was restarted.
  std::string GetRecordingFailure();
  std::string GetRecordingMissing();
  /// Takes the next warning for the simulation; empty: none.
  std::string TakeWarnings();

protected:
  vtkDspaceRecorder();
  ~vtkDspaceRecorder() override;

private:
  vtkDspaceRecorder(const vtkDspaceRecorder&) = delete;
  void operator=(const vtkDspaceRecorder&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
