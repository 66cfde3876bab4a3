/**
 * @class vtkDspaceRecordingTask
 * @brief Long work on a recording for Python, in its own thread.
 *
 * Call one of the Begin methods once, then Wait until it returns true, then TakeReply, which
 * returns a serialized RecordingReply (recordings.proto) with the result or the error. Cancel and
 * the destructor stop the work, which then leaves no new file. No method throws a C++ exception.
 * Paths are bytes in the system's encoding.
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

  /// Reads all of a recording: `foreign`. <dspace/recording/RecordingCheck.h>
  /// `unpackLimit`: <dspace/recording/RecordingReader.h>, SetUnpackLimit.
  void BeginCheck(const std::string& path, unsigned long long unpackLimit);
  /// Copies the commands first..last to a new recording, which starts after the snapshot `number`:
  /// <dspace/recording/RecordingCut.h>.
  void BeginCut(const std::string& path, const std::string& out, unsigned long long first,
                unsigned long long last);
  /// Packs the files that a recording needs into it, or into a copy if `out` is not empty: `pack`.
  /// <dspace/recording/RecordingPack.h>
  void BeginPack(const std::string& path, const std::string& out);
  /// Recovers the intact rows of a damaged recording into a new one: `salvage`.
  /// <dspace/recording/RecordingSalvage.h>
  void BeginSalvage(const std::string& path, const std::string& out,
                    unsigned long long unpackLimit);

  /// Waits up to this time. Returns whether the work has ended.
  bool Wait(double seconds);
  std::string TakeReply();
  /// Cancels the work and waits for its end.
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
