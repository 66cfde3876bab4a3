/**
 * @class vtkDspaceRecordingReader
 * @brief Reads a recording for Python; nothing in it is executed.
 *
 * Wraps <dspace/recording/RecordingReader.h> and <dspace/recording/PlaybackSteps.h>. Each method
 * but Close and SetTimeout returns a serialized RecordingReply (recordings.proto), whose error says
 * what failed; no C++ exception leaves a method. Paths are bytes as the system has them. For one
 * thread at a time. Nothing else may be called before Open and after Close.
 */
#ifndef vtkDspaceRecordingReader_h
#define vtkDspaceRecordingReader_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

class VTKDSPACESESSION_EXPORT vtkDspaceRecordingReader : public vtkObject {
public:
  static vtkDspaceRecordingReader* New();
  vtkTypeMacro(vtkDspaceRecordingReader, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  std::string Open(const std::string& path);
  void Close();
  /// How long a read waits for a process that has locked the file [s]; default 10.
  void SetTimeout(double seconds);

  /// `number`: of the first command (1 without any), of the last one (0 without any), and of the
  /// snapshot that the recording begins with.
  std::string First();
  std::string Last();
  std::string Begin();

  /// `row`: the next commands of first..last, about a megabyte of them, and `next`: the number to
  /// go on with. All are read and checked, and none may be missing; `kinds`, field numbers in
  /// Command separated by commas, names those that are returned; empty: all.
  std::string ReadRows(unsigned long long first, unsigned long long last, const std::string& kinds);
  /// The same without a look at commands of other kinds.
  std::string ReadOnly(unsigned long long first, unsigned long long last, const std::string& kinds);
  /// `row`: the last snapshot at or before a command.
  std::string ReadSnapshot(unsigned long long seq);
  /// `seq`: the numbers of all snapshots.
  std::string Snapshots();
  /// `seq`, `time_s`: of every command that set the time. `oneScene` false: in any scene.
  std::string Steps(bool oneScene, const std::string& scene);
  /// `seq`, `time_s`: the first command and the time of every step after the first snapshot.
  std::string StepBegins();
  /// `seq`, `time_s`: the last command and the time of each step that can be shown, and `gap`.
  std::string PlaybackSteps(bool oneScene, const std::string& scene);
  /// `range`: of commands with none missing between.
  std::string Blocks();
  /// `range`: of lost commands.
  std::string Lost();
  std::string Summary();
  /// `asset`: the files that its commands need, by path.
  std::string Assets();

protected:
  vtkDspaceRecordingReader();
  ~vtkDspaceRecordingReader() override;

private:
  vtkDspaceRecordingReader(const vtkDspaceRecordingReader&) = delete;
  void operator=(const vtkDspaceRecordingReader&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
