/**
 * @class vtkDspaceWindows
 * @brief Windows that show viewports, for scripts that have no Qt application of their own.
 *
 * The windows belong to one QApplication, that of the program or one that the first window makes.
 * Call everything from the thread that made the first window. Methods return an error, or an empty
 * string; none throws.
 */
#ifndef vtkDspaceWindows_h
#define vtkDspaceWindows_h

#include <memory>
#include <string>

#include "vtkDspaceWidgetsModule.h"
#include "vtkObject.h"

class vtkDspaceSession;

class VTKDSPACEWIDGETS_EXPORT vtkDspaceWindows : public vtkObject {
public:
  static vtkDspaceWindows* New();
  vtkTypeMacro(vtkDspaceWindows, vtkObject);
  void PrintSelf(ostream& os, vtkIndent indent) override;

  /// Opens a window with a viewport of the session, or raises the one that shows it. Sizes are
  /// those of the widget, in Qt's pixels; 0: the viewport's own. Mouse and keyboard become
  /// ViewportEvent commands of the session.
  std::string Show(vtkDspaceSession* session, const std::string& viewport, const std::string& title,
                   int width, int height);
  /// Closes its window; nothing happens if there is none.
  void Close(vtkDspaceSession* session, const std::string& viewport);
  /// Closes all windows of a session, before the session ends.
  void CloseAll(vtkDspaceSession* session);
  bool IsShown(vtkDspaceSession* session, const std::string& viewport);
  /// Open windows.
  int GetCount();

  /// Processes what has happened, and waits up to `milliseconds` for something to happen if
  /// nothing has.
  std::string ProcessEvents(int milliseconds);

  /// What the session replied to the events of its viewports, oldest first: a serialized
  /// ViewportEvent, then its serialized Reply. Empty: there is none. Each call takes one.
  std::string TakeEvent();
  std::string TakeReply(); // of the event that was taken last

  /// The errors of drawing in any window since the last call, one per line.
  std::string TakeFailures();

protected:
  vtkDspaceWindows();
  ~vtkDspaceWindows() override;

private:
  vtkDspaceWindows(const vtkDspaceWindows&) = delete;
  void operator=(const vtkDspaceWindows&) = delete;
  struct Internals;
  std::unique_ptr<Internals> Impl;
};

#endif
