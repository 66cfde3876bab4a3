/**
 * @class vtkDspaceRecordingTask
 * @brief Long work on a recording for Python, in a thread of its own.
 *
 * One of the methods that end in Later, once, then Wait until it returns true, then TakeReply: a
 * serialized RecordingReply (recordings.proto), whose error says what failed. Cancel, or the end of
 * this object, ends the work, which leaves no new file behind. No C++ exception leaves a method.
 * Paths are bytes as the system has them.
 */
#ifndef vtkDspaceRecordingTask_h
#define vtkDspaceRecordingTask_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

class VTKDSPACESESSION_EXPORT vtkDspaceRecordingTask : public vtkObject {
public:
  static vtkDspaceRecordingTask* New();
  vtkTypeMacro(vtkDspaceRecordingTask, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Reads all of a recording: <dspace/recording/RecordingCheck.h>.
  void BeginCheck(const std::string& path);
  /// The commands first..last as a new recording, which begins after the snapshot `number`:
  /// <dspace/recording/RecordingCut.h>.
  void BeginCut(const std::string& path, const std::string& out, unsigned long long first,
                unsigned long long last);
  /// Takes the files that a recording needs into it, or where `out` is not empty into a copy:
  /// `pack`. <dspace/recording/RecordingPack.h>
  void BeginPack(const std::string& path, const std::string& out);
  /// What survives of a damaged recording as a new one: `salvage`.
  /// <dspace/recording/RecordingSalvage.h>
  void BeginSalvage(const std::string& path, const std::string& out);

  /// Up to so many seconds; whether the work has ended.
  bool Wait(double seconds);
  std::string TakeReply();
  /// Ends the work, and waits for that.
  void Cancel();

protected:
  vtkDspaceRecordingTask();
  ~vtkDspaceRecordingTask() override;

private:
  vtkDspaceRecordingTask(const vtkDspaceRecordingTask&) = delete;
  void operator=(const vtkDspaceRecordingTask&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
