// Plug-ins of the window in C++: shared libraries that add docks, menu entries, keys, overlays and
// read-outs.
#ifndef DSPACE_WIDGETS_WINDOW_PLUG_IN_H
#define DSPACE_WIDGETS_WINDOW_PLUG_IN_H

#include <functional>
#include <string>
#include <vector>

#include <QObject>
#include <QPointer>
#include <QString>

class QAction;
class QDockWidget;
class QLabel;
class QMainWindow;
class QPainter;
class QWidget;
class vtkDspaceSession;

namespace dspace::widgets {

class ViewportWidget;

// A library and a window agree where this is equal: it changes with the classes of this header.
#define DSPACE_WINDOW_PLUG_IN_VERSION "Dspace window 1"

// What a plug-in may do with the window. A plug-in is a shared library with
//
//   static void Begin(dspace::widgets::WindowPlugIn& window) { window.AddDock(...); }
//   DSPACE_WINDOW_PLUG_IN(Begin)
//
// All of it runs in the window's thread. What a function of a plug-in throws is told by failed(),
// and the window goes on. Libraries stay loaded until the program ends.
class WindowPlugIn : public QObject {
  Q_OBJECT

public:
  // `run` runs a line of Python, which the prompt shows.
  WindowPlugIn(QMainWindow* window, vtkDspaceSession* session,
               std::function<bool(const QString&)> run);
  ~WindowPlugIn() override;

  // Loads a library and calls its function. Throws Error: NotFound without such a file, Unsupported
  // for a file that is no such library or is of another version, and what the function throws;
  // docks, entries and overlays that it had added then go away.
  void Load(const QString& path);

  // --- For plug-ins ----------------------------------------------------------------------------

  // A dock with a widget, which it owns from now on.
  QDockWidget* AddDock(const QString& title, QWidget* content,
                       Qt::DockWidgetArea area = Qt::RightDockWidgetArea);
  // An entry of a menu ("&Mission"), which is made if there is none. `key`: such as "F6"; empty:
  // none. Throws Error(InvalidArgument) for a key that is taken or is none.
  QAction* AddAction(const QString& menu, const QString& text, const QString& key,
                     std::function<void()> chosen);
  void OnKey(const QString& key, std::function<void()> pressed);
  // Is called with a painter over each view after each of its pictures; coordinates are the
  // widget's [pixels of the widget, from the top left].
  using Overlay = std::function<void(QPainter&, const ViewportWidget&)>;
  void AddOverlay(Overlay draw);
  // A value in the status bar: "name 12.3 unit". `read` is asked ten times a second.
  QLabel* AddReadOut(const QString& name, std::function<QString()> read);

  QMainWindow* Window() const { return this->Window_; }
  vtkDspaceSession* Session() const { return this->Session_; }
  bool Run(const QString& python) const { return this->Run_(python); }

  // For the window: a view is shown.
  void AddView(ViewportWidget* view);

signals:
  void failed(const QString& message);

private:
  void Guard(const std::function<void()>& f);
  QAction* MakeAction(const QString& text, const QString& key, std::function<void()> chosen);

  QMainWindow* Window_;
  vtkDspaceSession* Session_;
  std::function<bool(const QString&)> Run_;
  std::vector<Overlay> Overlays_;
  std::vector<QPointer<QObject>> Made_; // by plug-ins
};

} // namespace dspace::widgets

#define DSPACE_WINDOW_PLUG_IN(function)                                                            \
  extern "C" __attribute__((visibility("default"))) const char* DspaceWindowPlugInVersion() {      \
    return DSPACE_WINDOW_PLUG_IN_VERSION;                                                          \
  }                                                                                                \
  extern "C" __attribute__((visibility("default"))) void DspaceWindowPlugIn(                       \
      dspace::widgets::WindowPlugIn& window) {                                                     \
    function(window);                                                                              \
  }

#endif
