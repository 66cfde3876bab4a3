/**
 * @class vtkDspaceRecordedFiles
 * @brief The files that a recording's commands need, where it is played: checked, or unpacked.
 *
 * Wraps <dspace/recording/RecordedFiles.h> for Python. What can fail returns a serialized Reply,
 * whose error says what did; no C++ exception leaves a method. Paths are bytes as the system has
 * them.
 */
#ifndef vtkDspaceRecordedFiles_h
#define vtkDspaceRecordedFiles_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

#ifndef __VTK_WRAP__
#include <dspace/FilesRead.h>
#endif

class VTKDSPACESESSION_EXPORT vtkDspaceRecordedFiles : public vtkObject {
public:
  static vtkDspaceRecordedFiles* New();
  vtkTypeMacro(vtkDspaceRecordedFiles, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Unpacks or checks the files of a recording; `check` false: looks at none that is not packed.
  std::string Open(const std::string& recording, bool check);
  /// The same for what has been noted since.
  std::string Update();
  /// Where they were unpacked; empty: nothing was packed.
  std::string GetFolder();
  /// Where a path of the recording's is.
  std::string Locate(const std::string& path);
  /// A serialized Command with its paths made those of the folder.
  std::string Map(const std::string& command);
#ifndef __VTK_WRAP__
  /// See RecordedFiles::Look; empty where nothing is open.
  dspace::FilesGuard::Look GetLook() const;
#endif
  /// Removes what was unpacked. Twice is no error.
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
