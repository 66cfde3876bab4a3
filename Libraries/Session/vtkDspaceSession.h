/**
 * @class vtkDspaceSession
 * @brief A session in process: the interpreter with viewports that draw.
 *
 * Commands and replies are the protobuf messages of <dspace/proto/commands.proto>. No C++
 * exception leaves a method that Python calls: errors travel in the reply.
 */
#ifndef vtkDspaceSession_h
#define vtkDspaceSession_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

#ifndef __VTK_WRAP__
#include <dspace/interpreter/Interpreter.h>
#include <dspace/ledger/Ledger.h>
#include <dspace/recording/RecordingWriter.h>
#endif

class vtkDataArray;
class vtkDspaceRecordedFiles;
class vtkDspaceRenderContext;
class vtkDspaceScene;
class vtkDspaceViewport;

class VTKDSPACESESSION_EXPORT vtkDspaceSession : public vtkObject {
public:
  static vtkDspaceSession* New();
  vtkTypeMacro(vtkDspaceSession, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Carries out a serialized Command and returns the serialized Reply. Afterwards GetCommand() is
  /// the command as recorded, with the ids that were chosen.
  std::string Execute(const std::string& command);
  std::string GetCommand();

  /// A plane of the last capture ("color", "depth", "label"): rows from the top, one tuple a pixel.
  /// Null when the capture did not ask for it. It is the caller's: the next capture makes a new
  /// one.
  vtkDataArray* GetPlane(const std::string& name);

  /// The objects behind the names; null when there are none of that name.
  vtkDspaceScene* GetScene(const std::string& name);
  vtkDspaceViewport* GetViewport(const std::string& name);

  /// Makes a viewport the render window's current one and sends UserEvent to the observers of this
  /// object, for VTK code of one's own. Returns what went wrong, or an empty string.
  std::string RunInViewport(const std::string& name);

  /// The context that draws, shared by sessions of one process. To be set before the first
  /// viewport is made; a session without one makes its own then.
  void SetRenderContext(vtkDspaceRenderContext* context);
  vtkDspaceRenderContext* GetRenderContext();

  /// Gives up what the session does in the background (overviews); to be called before the process
  /// ends, unless the session is destroyed before.
  void EndBackgroundWork();

  /// Records from the present state on into a new file, whose name ends as it likes. Every accepted
  /// command is written by a thread of its own, at most `commitEvery` seconds later (0.001 to 60);
  /// where that fails, one reply warns, the session goes on, and what was written stays. Both
  /// return what went wrong, or an empty string. One recording at a time. `pack`: the files that
  /// the commands need become part of it; GetRecordingMissing() has those that could not be read, a
  /// line each.
  std::string Record(const std::string& path, double commitEvery, bool pack = false);
  std::string StopRecording();
  /// What another session is recording goes on with this one, whose state is another: the recording
  /// says that commands are lost between them.
  void TakeRecording(vtkDspaceSession* other);
  /// Waits until all that was accepted is written.
  std::string FlushRecording();
  /// Of the present recording, or of the one before: "accepted", "written", "bytes", "snapshots".
  unsigned long long GetRecordingCount(const std::string& name);
  /// Empty when nothing is being recorded.
  std::string GetRecordingPath();
  std::string GetRecordingFailure();
  std::string GetRecordingMissing();

  /// As Execute, for commands out of a recording with these files, which must be open. Commands
  /// that change nothing are rejected, since none is ever recorded and some write files. Which
  /// files the command may lead to: <dspace/recording/Playback.h>.
  std::string Replay(const std::string& command, vtkDspaceRecordedFiles* files);
  /// For a program that only plays recordings: restricts the formats of rasters and shapes in the
  /// whole process for the rest of its life, see <dspace/raster/ConfinedDrivers.h>.
  void ConfineProcess();

#ifndef __VTK_WRAP__
  dspace::session::Interpreter& GetInterpreter();
  /// What makes the present state.
  const dspace::session::Ledger& GetLedger();
  /// All that is said of the present recording, or of the one before.
  const dspace::session::RecordingCounts& GetRecordingCounts();
  /// For who follows another session: a command that was accepted there, and that could not be
  /// carried out here for the reason given. It is recorded like others; without its effect there is
  /// no snapshot until its scene is removed. Returns why recording has ended, or an empty string.
  std::string AddFailed(const dspace::v1::Command& accepted, const std::string& why);
#endif

protected:
  vtkDspaceSession();
  ~vtkDspaceSession() override;

private:
  vtkDspaceSession(const vtkDspaceSession&) = delete;
  void operator=(const vtkDspaceSession&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
