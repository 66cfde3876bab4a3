/**
 * @class vtkDspaceSession
 * @brief A session in process: the interpreter with viewports that draw.
 *
 * Commands and replies are the protobuf messages of <dspace/proto/commands.proto>. Methods that
 * Python calls do not throw C++ exceptions: errors are in the reply.
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

namespace dspace::session {
struct DrawerPlugIn;
}
#endif

class vtkDataArray;
class vtkDspaceRecordedFiles;
class vtkDspaceRenderContext;
class vtkDspaceScene;
class vtkDspaceViewport;
class vtkShaderProperty;
class vtkProp3D;

class VTKDSPACESESSION_EXPORT vtkDspaceSession : public vtkObject {
public:
  static vtkDspaceSession* New();
  vtkTypeMacro(vtkDspaceSession, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Executes a serialized Command and returns the serialized Reply. GetCommand() then returns the
  /// command as recorded, with the chosen ids.
  std::string Execute(const std::string& command);
  std::string GetCommand();

  /// A plane of the last capture, by the name of its field in Capture (viewports.proto): rows from
  /// the top, one tuple per pixel. Null if the capture did not request it. The caller may keep it:
  /// the next capture creates a new one.
  vtkDataArray* GetPlane(const std::string& name);

  /// The objects of these names; null if there are none.
  vtkDspaceScene* GetScene(const std::string& name);
  vtkDspaceViewport* GetViewport(const std::string& name);

  /// Why a vtkShaderProperty has no counterpart as shader code of an object; empty if it has one.
  std::string CheckShader(vtkShaderProperty* property);
  /// Its replacements and uniforms as a serialized SetShader without an object; empty if
  /// CheckShader() returns an error.
  std::string SerializeShader(vtkShaderProperty* property);

  /// Makes a viewport the current one of the render window and invokes UserEvent on the observers
  /// of this object, for custom VTK code. Returns the error, or an empty string.
  std::string RunInViewport(const std::string& name);
  /// A serialized Reply with the warnings of VTK that no reply had yet, as after RunInViewport.
  std::string TakeWarnings();

  /// The render context, which sessions of one process may share. Set it before the first viewport
  /// is created; otherwise the session creates its own.
  void SetRenderContext(vtkDspaceRenderContext* context);
  vtkDspaceRenderContext* GetRenderContext();

  /// Gives the prop to the next CreateDrawn command whose drawer is "vtk:CLASS". Null: none.
  void OfferProp(vtkProp3D* prop);
  /// The names of the drawers that plug-ins added, one per line.
  std::string GetDrawerNames();
  /// Loads a shared library with `extern "C" void DspacePlugIn(vtkDspaceSession*)`, which calls
  /// AddDrawer(), and calls that function. The library stays loaded. Returns the error, or an empty
  /// string.
  std::string LoadPlugIn(const std::string& path);

  /// Cancels background work (overviews). Call it before the process ends, unless the session is
  /// destroyed before.
  void EndBackgroundWork();

  /// Starts to record into a new file with any extension. A thread writes every accepted command at
  /// most `commitEvery` seconds later (0.001 to 60). If writing fails, one reply has a warning, the
  /// session continues, and the written part stays. Returns the error, or an empty string. Only one
  /// recording at a time. `pack`: stores the files that the commands need; GetRecordingMissing()
  /// returns those that could not be read, one per line.
  std::string Record(const std::string& path, double commitEvery, bool pack = false);
  std::string StopRecording();
  /// Takes over the recording of another session. The states differ, so the recording reports lost
  /// commands between them.
  void TakeRecording(vtkDspaceSession* other);
  /// Waits until all accepted commands are written.
  std::string FlushRecording();
  /// A counter of the present or last recording: "accepted", "written", "bytes", "snapshots".
  unsigned long long GetRecordingCount(const std::string& name);
  /// Empty: there is no recording.
  std::string GetRecordingPath();
  std::string GetRecordingFailure();
  std::string GetRecordingMissing();
  /// Warnings of a recording that has just begun, one per line: the objects of all scenes that code
  /// of this process draws, whose drawing it leaves out.
  std::string GetRecordingLeftOut();

  /// Executes a command of a recording with these files, which must be open. Commands that change
  /// nothing are rejected, because recordings never contain them and some write files.
  /// <dspace/recording/Playback.h> states which files the command may read.
  std::string Replay(const std::string& command, vtkDspaceRecordedFiles* files);
  /// For a program that only plays recordings: restricts the formats of rasters and shapes in the
  /// whole process for the rest of its life, see <dspace/raster/ConfinedDrivers.h>.
  void ConfineProcess(bool withoutNamesOnly = false);

  /// Limits of this process, see <dspace/Budgets.h>. GetLimits() has a line "NAME VALUE" for each.
  /// SetLimit() returns the error, or an empty string.
  static std::string GetLimits();
  static std::string SetLimit(const std::string& name, unsigned long long value);
  /// Whether models of all formats are read in processes of their own, see
  /// <dspace/import/worker/ModelImport.h>.
  static void SetImportsApart(bool apart);

#ifndef __VTK_WRAP__
  dspace::session::Interpreter& GetInterpreter();
  /// Adds a user-defined drawer (<dspace/commands/viewports/DrawerPlugIn.h>), which the command
  /// CreateDrawn then names. Throws Error(InvalidArgument) for a name that is not accepted, and
  /// Error(AlreadyExists) for one that is in use.
  void AddDrawer(const dspace::session::DrawerPlugIn& plugIn);
  /// The ledger of the present state.
  const dspace::session::Ledger& GetLedger();
  /// The counters of the present or last recording.
  const dspace::session::RecordingCounts& GetRecordingCounts();
  /// For a session that follows another one: reports a command that was accepted there and has
  /// failed here for the reason `why`. It is recorded like others. There are no snapshots until its
  /// scene is removed. Returns why recording has ended, or an empty string.
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
