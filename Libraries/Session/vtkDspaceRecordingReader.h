/**
 * @class vtkDspaceRecordingReader
 * @brief Reads a recording for Python without executing it.
 *
 * Wraps <dspace/recording/RecordingReader.h> and <dspace/recording/PlaybackSteps.h>. Each method
 * except Close and SetTimeout returns a serialized RecordingReply (recordings.proto) with the
 * result or the error. No method throws a C++ exception. Paths are bytes in the system's encoding.
 * Use it from one thread at a time. Call Open first, and nothing after Close.
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

  /// `number`: number of the first command (1 if there is none), of the last one (0 if there is
  /// none), and of the first snapshot.
  std::string First();
  std::string Last();
  std::string Begin();

  /// `row`: the next commands of first..last, about 1 MB, and `next`: the number to continue with.
  /// All commands are read and checked, and none may be missing. `kinds`: field numbers in Command,
  /// separated by commas, of the returned commands; empty: all.
  std::string ReadRows(unsigned long long first, unsigned long long last, const std::string& kinds);
  /// Does the same without checking commands of other kinds.
  std::string ReadOnly(unsigned long long first, unsigned long long last, const std::string& kinds);
  /// `row`: the last snapshot at or before a command.
  std::string ReadSnapshot(unsigned long long seq);
  /// `seq`: the numbers of all snapshots.
  std::string Snapshots();
  /// `seq`, `time_s`: number and time of every command that set the time. `oneScene` false: of all
  /// scenes.
  std::string Steps(bool oneScene, const std::string& scene);
  /// `seq`, `time_s`: the first command and the time of every step after the first snapshot.
  std::string StepBegins();
  /// `seq`, `time_s`: the last command and the time of each complete step, and `gap`.
  std::string PlaybackSteps(bool oneScene, const std::string& scene);
  /// The error of a recording whose steps are none.
  std::string NoSteps();
  /// `range`: ranges of commands without gaps.
  std::string Blocks();
  /// `range`: ranges of lost commands.
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
