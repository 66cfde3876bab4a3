// Python in the process of an application.
#ifndef DSPACE_WIDGETS_PYTHON_INTERPRETER_H
#define DSPACE_WIDGETS_PYTHON_INTERPRETER_H

#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include <QObject>
#include <QStringList>

class vtkDspaceSession;
class vtkObject;

namespace dspace::widgets {

// What Python's `app` (dspace.application.App) asks of the program's windows. All of it is called
// in the thread of the interpreter; what it throws becomes an exception in Python.
// `of` is what a view is of (ShownSession.h).
struct PythonHost {
  std::function<void(vtkObject* of, const std::string& viewport, const std::string& title)> show;
  std::function<void(vtkObject* of, const std::string& viewport)> close;
  // Keeps a watcher up to date from now on.
  std::function<void(vtkObject* of, const std::string& title)> follow;
  // All that is shown of it closes.
  std::function<void(vtkObject* of)> forget;
  // Asks the clock of it: "play" (0: pause), "speed", "follow", "loop" (begin, end [s]), "unloop".
  std::function<void(vtkObject* of, const std::string& what, double a, double b)> clock;
  // The scene in the docks.
  std::function<std::pair<vtkObject*, std::string>()> active;
  // Plug-ins (PlugIns.h): JSON, answered by JSON.
  std::function<std::string(const std::string& request)> extend;
  // Plots (TelemetryDocks.h).
  std::function<long(vtkObject* of, const std::string& scene, const std::string& title)> plot;
  std::function<void(long plot, const std::string& channel)> plotChannel;
  std::function<void(long plot, const std::string& name, const std::string& unit,
                     const std::vector<double>& times, const std::vector<double>& values)>
      plotSeries;
  // A serialized Command of the session, executed (FileCommands.h): readFiles first, while other
  // threads of Python may run, then execute, which returns the serialized Reply.
  std::function<void(const std::string& command)> readFiles;
  std::function<std::string(const std::string& command)> execute;
  std::function<void(const std::string&)> message;
  // False once the windows are closing.
  std::function<bool()> isOpen;
  // Something that goes on, with how much of it is done (0 to 1; < 0: not known) and what cancels
  // it
  // ("Cancel"; "": nothing does); then App._cancelled(id) is called. Empty text: it has ended.
  std::function<void(long id, const std::string& text, double done, const std::string& cancel)>
      task;
};

// CPython with `dspace`, `session` (of the given vtkDspaceSession), `scene`, `view` (the view that
// had the focus last) and `app` in its name space. One a process, in one thread; other Python
// threads run between its calls.
class PythonInterpreter : public QObject {
  Q_OBJECT

public:
  // `packages`: the folder that holds the dspace package. Throws std::runtime_error with Python's
  // error if the package cannot be imported.
  PythonInterpreter(vtkDspaceSession* session, PythonHost host, const QString& packages,
                    QObject* parent = nullptr);
  ~PythonInterpreter() override;

  // A line, or the lines so far of a compound statement. True: more lines are needed. What it
  // prints and what it raises come by written().
  bool Push(const QString& source);
  // A whole script, or a file; false: it raised.
  bool Run(const QString& source, const QString& name = QStringLiteral("<menu>"));
  bool RunFile(const QString& path);
  // The names that may stand for the word at the end of the line.
  QStringList Complete(const QString& line);
  // Raises KeyboardInterrupt in what runs.
  static void Interrupt();
  // A call has taken a fifth of a second and goes on; the windows live meanwhile
  // (PythonAttendant.h).
  bool IsBusy() const;
  // Tells Python that the user cancels a task.
  void Cancel(long task);
  // A plug-in's action, and a row of its panel with the value as JSON.
  void Trigger(int action);
  void Change(int panel, int row, const std::string& value);
  // Tells Python what a viewport's session replied to an event (ConnectToSession).
  void Tell(const std::string& viewport, const std::string& event, const std::string& reply);

signals:
  void written(const QString& text, bool error);
  void busyChanged(bool busy);

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
