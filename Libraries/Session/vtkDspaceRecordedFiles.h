/**
 * @class vtkDspaceRecordedFiles
 * @brief The files that a recording's commands need, checked or unpacked for playback.
 *
 * Wraps <dspace/recording/RecordedFiles.h> for Python. No method that Python calls throws a C++
 * exception. Paths are bytes in the system's encoding. The Begin methods work in a thread: Wait
 * until it returns true, then TakeReply, and call nothing else between. Cancel and Close end the
 * work.
 */
#ifndef vtkDspaceRecordedFiles_h
#define vtkDspaceRecordedFiles_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

#ifndef __VTK_WRAP__
#include <dspace/FilesRead.h>
#include <dspace/proto/commands.pb.h>
#endif

class VTKDSPACESESSION_EXPORT vtkDspaceRecordedFiles : public vtkObject {
public:
  static vtkDspaceRecordedFiles* New();
  vtkTypeMacro(vtkDspaceRecordedFiles, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Unpacks or checks the files of a recording. `check` false: does not check files that are not
  /// packed. `unpackLimit`: <dspace/recording/RecordingReader.h>, SetUnpackLimit.
  void BeginOpen(const std::string& recording, bool check, unsigned long long unpackLimit);
  /// Does the same for files that were recorded since.
  void BeginUpdate();
  /// Waits up to this time [s]. Returns whether the work has ended.
  bool Wait(double seconds);
  /// A serialized RecordingReply (recordings.proto), with the error if the work failed.
  std::string TakeReply();
  void Cancel();
  /// The folder of unpacked files; empty: nothing was packed.
  std::string GetFolder();
  /// The present path of a recorded path.
  std::string Locate(const std::string& path);
  /// Changes the paths of a serialized Command to those in the folder.
  std::string Map(const std::string& command);
#ifndef __VTK_WRAP__
  /// See RecordedFiles::Look; empty if nothing is open.
  dspace::FilesGuard::Check GetLook() const;
  /// See RecordedFiles::FillIn; throws Error. Nothing if nothing is open.
  void FillIn(dspace::v1::Command& command);
#endif
  /// Removes the unpacked files. Calling it twice is no error.
  void Close();

protected:
  vtkDspaceRecordedFiles();
  ~vtkDspaceRecordedFiles() override;

private:
  vtkDspaceRecordedFiles(const vtkDspaceRecordedFiles&) = delete;
  void operator=(const vtkDspaceRecordedFiles&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
