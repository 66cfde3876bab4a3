// The window of DspaceQt: viewports and the tree of the scene in docks, a Python prompt, menus.
#ifndef DSPACE_WIDGETS_MAIN_WINDOW_H
#define DSPACE_WIDGETS_MAIN_WINDOW_H

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <utility>

#include <QMainWindow>
#include <QPointer>
#include <QStringList>

#include "vtkSmartPointer.h"

class QDockWidget;
class QComboBox;
class vtkDspaceSession;
class vtkObject;

namespace dspace::widgets {

class ConsoleWidget;
class FileCommands;
class MeasureMarks;
class MeasureWidget;
class MovieTrack;
class ViewKeys;
class ViewPanes;
class ViewSelection;
class PythonInterpreter;
class SceneTreeWidget;
class ShownScenes;
class MessageWidget;
class PlugInOverlays;
class PlugIns;
class PointerReadout;
class Shell;
class TaskStrip;
class TelemetryDocks;
class TerrainWidget;
class TimelineWidget;
class ViewportWidget;
class WindowPlugIn;

// Each action is a line of Python that the prompt shows and runs, so that "Save as script" writes
// what was done. Files are opened from the menu, by drag and drop, or by Open().
class MainWindow : public QMainWindow {
  Q_OBJECT

public:
  // `packages`: the folder with the Python package dspace. Throws std::runtime_error if Python does
  // not start, dspace::Error(Resource) if OpenGL is too old.
  explicit MainWindow(const QString& packages);
  ~MainWindow() override;

  // A model, raster, robot, recording or Python script; false: it could not be opened, which is
  // shown.
  bool Open(const QString& path);
  // app.connect() and app.listen(). roots: folders whose files the simulation may name; none: the
  // working folder.
  bool Connect(const QString& address);
  bool Listen(const QString& address, const QStringList& roots = {});
  bool RestoreLayout(const QString& name);
  // Plug-ins by name, after those in the folder of the user's plug-ins (PlugInFolder()).
  // Returns whether all of `names` were loaded.
  bool LoadPlugIns(const QStringList& names);
  static QString PlugInFolder();
  // `about`: what the notice of a failure names if its message does not; "": nothing.
  bool Run(const QString& python, const QString& about = {});
  ConsoleWidget* Console() const { return this->Console_; }
  PythonInterpreter* Interpreter() const { return this->Interpreter_.get(); }
  // The widget of a viewport; null: it is not shown.
  ViewportWidget* View(const std::string& viewport) const;
  // The scenes that the docks may show.
  ShownScenes* Scenes() const { return this->Scenes_; }
  PlugIns* Extensions() const { return this->PlugIns_; }
  TelemetryDocks* Telemetry() const { return this->Telemetry_; }
  Shell* Desktop() const { return this->Shell_; }
  FileCommands* Files() const { return this->Files_; }
  int ViewCount() const;
  // Every visible viewport is up to date.
  bool IsSettled() const;
  ViewPanes* Panes() const { return this->Panes_; }
  ViewSelection* Selection() const { return this->Selection_; }
  MovieTrack* Movies() const { return this->Movies_; }
  TerrainWidget* Terrain() const { return this->Terrain_; }
  MeasureWidget* Measure() const { return this->Measure_; }

protected:
  void closeEvent(QCloseEvent* event) override;
  void dragEnterEvent(QDragEnterEvent* event) override;
  void dropEvent(QDropEvent* event) override;

private:
  using Key = std::pair<vtkObject*, std::string>;
  struct View_t {
    QPointer<QDockWidget> dock;
    QPointer<ViewportWidget> widget;
  };
  void AddMessages();
  void AddTelemetry(TimelineWidget* timeline);
  void AddTerrain();
  void AddMeasure();
  void MakeMenus();
  void ShowView(vtkObject* of, const std::string& viewport, const std::string& title);
  void CloseView(vtkObject* of, const std::string& viewport);
  void Forget(vtkObject* of);
  void AddViewParts(SceneTreeWidget* tree, TimelineWidget* timeline);
  // The view that is used, of the scene in the docks or (`any`) of any, as Python; "": there is
  // none.
  QString CurrentView(bool any = false) const;
  // Asks for a text that is not empty.
  void AskText(const QString& title, const QString& label, const QString& text,
               const std::function<void(const QString&)>& take);
  void ChooseFiles();
  void SaveScript();
  void SavePicture();
  void Report(const QString& text);

  vtkSmartPointer<vtkDspaceSession> Session_;
  std::unique_ptr<PythonInterpreter> Interpreter_;
  ConsoleWidget* Console_ = nullptr;
  ShownScenes* Scenes_ = nullptr;
  TaskStrip* Tasks_ = nullptr;
  PlugIns* PlugIns_ = nullptr;
  TelemetryDocks* Telemetry_ = nullptr;
  TerrainWidget* Terrain_ = nullptr;
  MeasureWidget* Measure_ = nullptr;
  MeasureMarks* Marks_ = nullptr;
  PlugInOverlays* Overlays_ = nullptr;
  MovieTrack* Movies_ = nullptr;
  ViewPanes* Panes_ = nullptr;
  ViewSelection* Selection_ = nullptr;
  ViewKeys* ViewKeys_ = nullptr;
  PointerReadout* Pointer_ = nullptr;
  bool Arranging_ = false; // the first view gets its room in the next turn of the event loop
  QDockWidget* MessageDock_ = nullptr;
  QDockWidget* SceneDock_ = nullptr;
  QDockWidget* TerrainDock_ = nullptr;
  QDockWidget* MeasureDock_ = nullptr;
  QDockWidget* TimeDock_ = nullptr;
  QDockWidget* ConsoleDock_ = nullptr;
  Shell* Shell_ = nullptr;
  FileCommands* Files_ = nullptr;
  bool Closing_ = false;
  WindowPlugIn* Libraries_ = nullptr; // plug-ins in C++
  QString Errors_;                    // of Python, of the latest Run()
  std::map<Key, View_t> Views_;
};

} // namespace dspace::widgets

#endif
