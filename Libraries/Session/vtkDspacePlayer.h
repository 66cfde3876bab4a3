/**
 * @class vtkDspacePlayer
 * @brief A session that plays a recording, with views of its own.
 *
 * It owns the playback: a timeline, views and Python that use the same player see one recording at
 * one time. Viewports, vantages and cameras whose names begin with "viewer:" belong to whoever
 * looks at the recording and survive every movement (<dspace/link/watching/ViewerViews.h>); other
 * changes are lost when it moves back. Methods that can fail return a serialized Reply. No method
 * throws a C++ exception. Use it in the thread of its session.
 */
#ifndef vtkDspacePlayer_h
#define vtkDspacePlayer_h

#include <memory>
#include <string>

#include "vtkDspaceSessionModule.h"
#include "vtkObject.h"

#ifndef __VTK_WRAP__
#include <dspace/recording/Playback.h>
#include <dspace/recording/RecordingReader.h>
#endif

class vtkDspaceSession;

class VTKDSPACESESSION_EXPORT vtkDspacePlayer : public vtkObject {
public:
  static vtkDspacePlayer* New();
  vtkTypeMacro(vtkDspacePlayer, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Draws in the render context of another session. Call it before Open.
  void ShareRenderContext(vtkDspaceSession* other);
  /// Goes to the first step. `check`: files that are not packed must be unchanged.
  std::string Open(const std::string& path, bool check);
  /// The same without holding the thread: another one reads the recording, its files, and those of
  /// its commands. WaitForOpen waits up to this time [s], or executes commands for it: 0: not yet,
  /// 1: it is open, -1: it failed. TakeReply then returns the reply. Close cancels it.
  void BeginOpen(const std::string& path, bool check);
  int WaitForOpen(double seconds);
  std::string TakeReply();
  /// Its session; the same one from the beginning to the end.
  vtkDspaceSession* GetSession();
  /// Executes a serialized Command.
  std::string Execute(const std::string& command);
  /// Makes the view `as`, whose name begins with "viewer:", like a viewport of the recording: with
  /// its camera, look, tables and colour bars. NOT_FOUND: the present step has no such viewport.
  std::string CopyViewport(const std::string& viewport, const std::string& as);

  /// Moves to a step, from 0, and waits for it, also for the files that another thread reads.
  std::string Go(long long index);
  /// The same without holding the thread: BeginGo takes a note of the step, and each ContinueGo
  /// executes commands for about this time [s]: 0: not yet there, 1: it is there, or where a later
  /// movement went, -1: it failed. TakeReply then returns the reply.
  std::string BeginGo(long long index);
  int ContinueGo(double seconds);
  /// The present step, and its time [s].
  long long GetIndex();
  double GetTime();
  /// Whether a movement in slices is in progress (<dspace/recording/Playback.h>).
  bool IsMoving();
  /// Reads the steps that were recorded since.
  std::string Update();
  /// The folder of unpacked files; empty: nothing was packed.
  std::string GetFolder();
  /// Ends the playback and removes unpacked files. A second call is no error.
  void Close();

#ifndef __VTK_WRAP__
  /// Null: nothing is open.
  dspace::session::Playback* GetPlayback();
  dspace::session::RecordingReader* GetReader();
#endif

protected:
  vtkDspacePlayer();
  ~vtkDspacePlayer() override;

private:
  vtkDspacePlayer(const vtkDspacePlayer&) = delete;
  void operator=(const vtkDspacePlayer&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
