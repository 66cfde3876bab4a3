/**
 * @class vtkDspaceRecorder
 * @brief Records what a server accepts, for the simulation that drives it.
 *
 * A watcher of the server and a session of its own, both in a thread: nothing needs to be called
 * for what comes to be recorded. It draws nothing, but carries every command out, so that it reads
 * models and terrain by the paths that the server has, and has a graphics context for the
 * viewports. A command that cannot be carried out here is recorded all the same, and told
 * (TakeWarnings).
 *
 * All of this is for one thread. Nothing waits for longer than it is told to; a child of the
 * process (fork) may only destroy it. No C++ exception leaves a method.
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

  /// To be set before BeginConnect, as for vtkDspaceRemoteSession. The timeout [s] (above 0, to
  /// 1e6; default 30) is also how long a server may not answer before the recording ends.
  void SetCertificates(const std::string& certificate, const std::string& key,
                       const std::string& authority);
  void SetInsecure(bool insecure);
  void SetTimeout(double seconds);
  /// BeginConnect, then WaitForConnect, up to so many seconds each time, until it returns 1
  /// (connected) or -1 (no: TakeReply, a serialized Reply, says why).
  std::string BeginConnect(const std::string& address, const std::string& name);
  int WaitForConnect(double seconds);
  std::string TakeReply();

  /// Then BeginRecord, once, as vtkDspaceSession::Record, and WaitForRecord until it returns 1 (the
  /// recording is there, and begins with the state that the server had) or -1 (GetRecordingFailure
  /// says why not).
  void BeginRecord(const std::string& path, double commitEvery, bool pack);
  int WaitForRecord(double seconds);
  /// Until the command of this number (Reply.sequence) is recorded: 1; -1: it never will be.
  int WaitFor(long long sequence, double seconds);
  /// The number of the last command that is recorded, or in the state that the recording began
  /// with.
  long long GetSequence();
  /// BeginFlush, then WaitForFlush until it is true: all that is recorded is written, or failed.
  void BeginFlush();
  bool WaitForFlush(double seconds);
  /// BeginStop ends the recording with what has been taken in by then; WaitForStop is true once the
  /// file is closed.
  void BeginStop();
  bool WaitForStop(double seconds);

  /// As of vtkDspaceSession, a tenth of a second old at most.
  unsigned long long GetRecordingCount(const std::string& name);
  /// Why it has ended by itself: the disk, a server that is gone or was started anew.
  std::string GetRecordingFailure();
  std::string GetRecordingMissing();
  /// What the simulation should know, once: the next of what went wrong; empty: nothing more.
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
