#include <dspace/widgets/window/MainWindow.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <stdexcept>

#include <QAction>
#include <QApplication>
#include <QCloseEvent>
#include <QDockWidget>
#include <QDropEvent>
#include <QFileDialog>
#include <QFileInfo>
#include <QInputDialog>
#include <QJsonArray>
#include <QJsonDocument>
#include <QMenuBar>
#include <QMimeData>
#include <QSaveFile>
#include <QStandardPaths>
#include <QStatusBar>
#include <QTimer>

#include "vtkDspacePlayer.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceSession.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"

#include <dspace/scene/ViewLook.h>
#include <dspace/widgets/console/ConsoleWidget.h>
#include <dspace/widgets/console/PythonInterpreter.h>
#include <dspace/widgets/desktop/AboutText.h>
#include <dspace/widgets/desktop/Layouts.h>
#include <dspace/widgets/desktop/MenuKeys.h>
#include <dspace/widgets/desktop/NoticeBar.h>
#include <dspace/widgets/desktop/RecentFiles.h>
#include <dspace/widgets/measure/MeasureWidget.h>
#include <dspace/widgets/operator/MessageWidget.h>
#include <dspace/widgets/overlay/MeasureMarks.h>
#include <dspace/widgets/overlay/PlugInOverlays.h>
#include <dspace/widgets/overlay/PointerReadout.h>
#include <dspace/widgets/scene/SceneTreeModel.h>
#include <dspace/widgets/scene/SceneTreeWidget.h>
#include <dspace/widgets/script/PythonText.h>
#include <dspace/widgets/terrain/TerrainWidget.h>
#include <dspace/widgets/timeline/TimelineWidget.h>
#include <dspace/widgets/viewport/QtContext.h>
#include <dspace/widgets/viewport/SessionInput.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/FileCommands.h>
#include <dspace/widgets/window/KeyTable.h>
#include <dspace/widgets/window/MovieTrack.h>
#include <dspace/widgets/window/PlugIns.h>
#include <dspace/widgets/window/Shell.h>
#include <dspace/widgets/window/ShownScenes.h>
#include <dspace/widgets/window/TaskStrip.h>
#include <dspace/widgets/window/TelemetryDocks.h>
#include <dspace/widgets/window/TreeActions.h>
#include <dspace/widgets/window/ViewBar.h>
#include <dspace/widgets/window/ViewKeys.h>
#include <dspace/widgets/window/ViewMenu.h>
#include <dspace/widgets/window/ViewPanes.h>
#include <dspace/widgets/window/ViewSelection.h>
#include <dspace/widgets/window/WindowPlugIn.h>

namespace dspace::widgets {
namespace {

const char* const SceneName = "scene"; // of dspace.Session.scene() without a name

std::string TextOf(const QJsonObject& answer) {
  return QJsonDocument(answer).toJson(QJsonDocument::Compact).toStdString();
}

// Of saved scripts.
const QByteArray ScriptHead =
    "# A script of DspaceQt. Run it with: DspaceQt THIS_FILE\n"
    "if \"app\" not in globals():\n"
    "    raise SystemExit(\"this script needs the window of DspaceQt: DspaceQt FILE.py\")\n\n";

} // namespace

MainWindow::MainWindow(const QString& packages)
    : Session_(vtkSmartPointer<vtkDspaceSession>::New()) {
  vtkNew<vtkDspaceRenderContext> context;
  context->Initialize(MakeQtContext()); // before anything is drawn: widgets share its textures
  this->Session_->SetRenderContext(context);
  this->setWindowTitle(QStringLiteral("DspaceQt"));
  this->resize(1280, 800);
  this->setAcceptDrops(true);
  this->setDockNestingEnabled(true);
  this->setDockOptions(QMainWindow::AnimatedDocks | QMainWindow::AllowNestedDocks |
                       QMainWindow::AllowTabbedDocks);
  PythonHost host;
  host.show = [this](vtkObject* of, const std::string& name, const std::string& title) {
    this->ShowView(of, name, title);
  };
  host.close = [this](vtkObject* of, const std::string& name) { this->CloseView(of, name); };
  host.follow = [this](vtkObject* of, const std::string& title) {
    if (this->Scenes_) {
      this->Scenes_->Add(of, QString::fromStdString(title));
    }
  };
  host.forget = [this](vtkObject* of) { this->Forget(of); };
  host.clock = [this](vtkObject* of, const std::string& what, double a, double b) {
    if (this->Scenes_) {
      this->Scenes_->AskClock(of, what, a, b);
    }
  };
  this->Shell_ = new Shell(this, [this](const QString& line) { return this->Run(line); });
  connect(this->Shell_, &Shell::fileChosen, this,
          [this](const QString& path) { this->Open(path); });
  this->Libraries_ = new WindowPlugIn(this, this->Session_,
                                      [this](const QString& line) { return this->Run(line); });
  connect(this->Libraries_, &WindowPlugIn::failed, this,
          [this](const QString& message) { this->Shell_->Notices()->Fail(message); });
  this->PlugIns_ = new PlugIns(this);
  connect(this->PlugIns_, &PlugIns::triggered, this,
          [this](int action) { this->Interpreter_->Trigger(action); });
  connect(this->PlugIns_, &PlugIns::changed, this,
          [this](int panel, int row, const QJsonValue& value) {
            QByteArray json = QJsonDocument(QJsonArray{value}).toJson(QJsonDocument::Compact);
            this->Interpreter_->Change(panel, row, json.mid(1, json.size() - 2).toStdString());
          });
  host.extend = [this](const std::string& request) {
    const auto given = QJsonDocument::fromJson(QByteArray::fromStdString(request)).object();
    if (given["do"].toString() == "library") {
      this->Libraries_->Load(given["path"].toString());
      return std::string("{}");
    }
    if (MovieTrack::Handles(given) || ViewPanes::Handles(given)) { // also while the window ends
      if (this->Movies_ && MovieTrack::Handles(given)) {
        this->Movies_->Handle(given);
      } else if (this->Panes_ && ViewPanes::Handles(given)) {
        return TextOf(this->Panes_->Handle(given));
      }
      return std::string("{}");
    }
    if (PlugInOverlays::Handles(given)) {
      return this->Overlays_ ? TextOf(this->Overlays_->Handle(given)) : std::string("{}");
    }
    if (MeasureMarks::Handles(given)) {
      if (this->Marks_) {
        const auto [of, scene] = this->Scenes_->ActiveScene();
        this->Marks_->Handle(given, of, scene);
      }
      return std::string("{}");
    }
    if (IsTreeRequest(given)) {
      if (this->Scenes_) {
        this->Scenes_->Act(given);
      }
      return std::string("{}");
    }
    return TextOf(Shell::Takes(given) ? this->Shell_->Handle(given)
                                      : this->PlugIns_->Handle(given));
  };
  host.active = [this] { return this->Scenes_->ActiveScene(); };
  host.plot = [this](vtkObject* of, const std::string& scene, const std::string& title) {
    return this->Telemetry_->NewPlot(of, scene, title);
  };
  host.plotChannel = [this](long plot, const std::string& channel) {
    this->Telemetry_->AddChannel(plot, channel);
  };
  host.plotSeries = [this](long plot, const std::string& name, const std::string& unit,
                           const std::vector<double>& times, const std::vector<double>& values) {
    this->Telemetry_->AddSeries(plot, name, unit, times, values);
  };
  host.task = [this](long id, const std::string& text, double done, const std::string& cancel) {
    if (this->Tasks_) {
      this->Tasks_->Show(id, QString::fromStdString(text), done, QString::fromStdString(cancel));
    }
  };
  host.isOpen = [this] { return !this->Closing_; };
  host.message = [this](const std::string& text) { this->Report(QString::fromStdString(text)); };
  this->Tasks_ = new TaskStrip(this);
  this->setAnimated(false); // docks that move would resize the views' pictures again and again
  this->Pointer_ = new PointerReadout(this);
  this->statusBar()->addPermanentWidget(this->Pointer_);
  this->statusBar()->addPermanentWidget(this->Tasks_);
  this->Files_ = new FileCommands(this->Session_, this->Tasks_, this);
  host.readFiles = [this](const std::string& command) { this->Files_->Read(command); };
  host.execute = [this](const std::string& command) { return this->Files_->Execute(command); };
  connect(this->Tasks_, &TaskStrip::cancelled, this,
          [this](long id) { this->Interpreter_->Cancel(id); });
  this->Interpreter_ = std::make_unique<PythonInterpreter>(this->Session_, host, packages);
  connect(this->Interpreter_.get(), &PythonInterpreter::written, this,
          [this](const QString& text, bool error) {
            if (error) {
              this->Errors_ += text;
            }
          });
  this->Console_ = new ConsoleWidget(this->Interpreter_.get(), this);
  this->ConsoleDock_ = new QDockWidget(tr("Python"), this);
  this->ConsoleDock_->setObjectName(QStringLiteral("console"));
  this->ConsoleDock_->setWidget(this->Console_);
  this->addDockWidget(Qt::BottomDockWidgetArea, this->ConsoleDock_);
  auto* tree = new SceneTreeWidget(this);
  connect(tree, &SceneTreeWidget::failed, this,
          [this](const QString& message) { this->Report(message); });
  this->SceneDock_ = new QDockWidget(tr("Scene"), this);
  this->SceneDock_->setObjectName(QStringLiteral("scene"));
  this->SceneDock_->setWidget(ShownScenes::WithChoice(tree));
  this->addDockWidget(Qt::LeftDockWidgetArea, this->SceneDock_);
  auto* timeline = new TimelineWidget(this);
  this->Scenes_ = new ShownScenes(this->Session_, SceneName, tree, timeline, this);
  connect(this->Scenes_, &ShownScenes::failed, this,
          [this](const QString& message) { this->Report(message); });
  this->Scenes_->SetRunner([this](const QString& line) {
    if (this->Interpreter_->IsBusy()) {
      return false;
    }
    this->Run(line);
    return true;
  });
  connect(timeline, &TimelineWidget::failed, this,
          [this](const QString& message) { this->Report(message); });
  this->TimeDock_ = new QDockWidget(tr("Time"), this);
  this->TimeDock_->setObjectName(QStringLiteral("time"));
  this->TimeDock_->setWidget(timeline);
  this->addDockWidget(Qt::BottomDockWidgetArea, this->TimeDock_);
  this->splitDockWidget(this->TimeDock_, this->ConsoleDock_, Qt::Vertical);
  this->AddTelemetry(timeline);
  this->AddMessages();
  this->AddTerrain();
  this->AddMeasure();
  this->AddViewParts(tree, timeline);
  this->MakeMenus();
  this->statusBar()->showMessage(
      tr("Open or drop a model, a raster of heights, a robot, a recording or a Python script"));
}

MainWindow::~MainWindow() {
  for (auto& [key, view] : this->Views_) {
    delete view.dock.data();
  }
  this->Views_.clear();
  delete this->Libraries_;
  this->Libraries_ = nullptr;
  delete this->PlugIns_;
  this->PlugIns_ = nullptr;
  delete this->ViewKeys_;
  delete this->Selection_;
  delete this->Movies_;
  this->Movies_ = nullptr;
  delete this->Panes_;
  this->Panes_ = nullptr;
  delete this->MessageDock_;
  this->MessageDock_ = nullptr;
  delete this->Marks_;
  this->Marks_ = nullptr;
  delete this->Overlays_;
  this->Overlays_ = nullptr;
  delete this->MeasureDock_;
  this->MeasureDock_ = nullptr;
  delete this->TerrainDock_;
  this->TerrainDock_ = nullptr;
  delete this->Telemetry_;
  this->Telemetry_ = nullptr;
  delete this->Tasks_;
  this->Tasks_ = nullptr;
  delete this->Scenes_;
  this->Scenes_ = nullptr;
  delete this->TimeDock_;
  delete this->SceneDock_;
  delete this->ConsoleDock_;
  this->Interpreter_.reset(); // ends what Python has of the session
}

void MainWindow::AddTelemetry(TimelineWidget* timeline) {
  this->Telemetry_ = new TelemetryDocks(this, this->Scenes_, timeline);
  connect(this->Telemetry_, &TelemetryDocks::failed, this,
          [this](const QString& message) { this->Report(message); });
  connect(this->Telemetry_, &TelemetryDocks::plotWanted, this, [this](const QString& channel) {
    this->Run(QStringLiteral("app.plot(%1)").arg(Quoted(channel)));
  });
  connect(this->Telemetry_, &TelemetryDocks::seriesWanted, this,
          [this](long plot, const QString& channel) {
            this->Run(QStringLiteral("app.plots[%1].add(%2)").arg(plot).arg(Quoted(channel)));
          });
  this->addDockWidget(Qt::BottomDockWidgetArea, this->Telemetry_->TableDock());
}

void MainWindow::AddMessages() {
  auto* messages = new MessageWidget(this);
  messages->SetSource([scenes = this->Scenes_] {
    const auto [of, scene] = scenes->ActiveScene();
    MessageWidget::Shown shown;
    shown.log = scenes->MessagesOf(of, scene);
    shown.scene = std::hash<std::string>()(scene) ^ std::uint64_t(std::uintptr_t(of));
    shown.canAnswer = vtkDspacePlayer::SafeDownCast(of) == nullptr;
    return shown;
  });
  this->MessageDock_ = new QDockWidget(tr("Messages"), this);
  this->MessageDock_->setObjectName(QStringLiteral("messages"));
  this->MessageDock_->setWidget(messages);
  connect(messages, &MessageWidget::answered, this,
          [this, messages](const QString& question, const QString& answer) {
            if (!this->Run(
                    QStringLiteral("app.answer(%1, %2)").arg(Quoted(question), Quoted(answer)))) {
              messages->TakeAnswerAgain(question);
            }
          });
  connect(messages, &MessageWidget::asked, this, [this] {
    this->MessageDock_->show();
    this->MessageDock_->raise();
  });
  this->addDockWidget(Qt::BottomDockWidgetArea, this->MessageDock_);
  this->tabifyDockWidget(this->Telemetry_->TableDock(), this->MessageDock_);
  this->tabifyDockWidget(this->MessageDock_, this->ConsoleDock_);
}

void MainWindow::AddTerrain() {
  this->Terrain_ = new TerrainWidget(this);
  this->Terrain_->SetSource([scenes = this->Scenes_, own = this->Session_.Get()] {
    const auto [of, scene] = scenes->ActiveScene();
    const ShownSession session(of);
    TerrainWidget::Shown shown;
    shown.execute = [session](const std::string& command) { return session.Execute(command); };
    shown.scene = scene;
    shown.canChange = of == own;
    shown.busy = session.Player() && session.Player()->IsMoving();
    return shown;
  });
  this->TerrainDock_ = new QDockWidget(tr("Terrain"), this);
  this->TerrainDock_->setObjectName(QStringLiteral("terrain"));
  this->TerrainDock_->setWidget(this->Terrain_);
  connect(this->Terrain_, &TerrainWidget::changeWanted, this, [this](const QString& change) {
    const QString scene = QString::fromStdString(this->Scenes_->ActiveScene().second);
    const QString path = scene == QLatin1String(SceneName)
                             ? QStringLiteral("app.scene")
                             : QStringLiteral("app.session.scenes[%1]").arg(Quoted(scene));
    this->Run(path + '.' + change);
  });
  this->addDockWidget(Qt::LeftDockWidgetArea, this->TerrainDock_);
  this->tabifyDockWidget(this->SceneDock_, this->TerrainDock_);
  this->SceneDock_->raise();
}

void MainWindow::AddMeasure() {
  this->Measure_ = new MeasureWidget(this);
  this->MeasureDock_ = new QDockWidget(tr("Measure"), this);
  this->MeasureDock_->setObjectName(QStringLiteral("measure"));
  this->MeasureDock_->setWidget(this->Measure_);
  connect(this->Measure_, &MeasureWidget::measureWanted, this,
          [this](const QString& line) { this->Run(line); });
  connect(this->Measure_, &MeasureWidget::saveWanted, this, [this](const QString& path) {
    this->Run(QStringLiteral("app.measured.profile.save(%1)").arg(Quoted(path)));
  });
  this->Marks_ = new MeasureMarks(this->Measure_, this);
  this->Overlays_ = new PlugInOverlays(this);
  this->addDockWidget(Qt::LeftDockWidgetArea, this->MeasureDock_);
  this->tabifyDockWidget(this->TerrainDock_, this->MeasureDock_);
  this->SceneDock_->raise();
}

void MainWindow::MakeMenus() {
  QMenu* file = this->menuBar()->addMenu(tr("&File"));
  file->addAction(tr("&Open..."), QKeySequence::Open, this, [this] { this->ChooseFiles(); });
  this->Shell_->FillRecent(file->addMenu(tr("Open &recent")));
  file->addAction(tr("&Demo scene"), this, [this] { this->Run(QStringLiteral("app.demo()")); });
  file->addSeparator();
  file->addAction(tr("&Connect to a server..."), this, [this] {
    this->AskText(tr("Connect to a server"), tr("Address (HOST:PORT or unix:PATH)"), QString(),
                  [this](const QString& address) { this->Connect(address); });
  });
  file->addAction(tr("&Listen for a simulation..."), this, [this] {
    this->AskText(tr("Listen for a simulation"),
                  tr("Address (HOST:PORT or unix:PATH); port 0 is any that is free"),
                  QStringLiteral("127.0.0.1:0"),
                  [this](const QString& address) { this->Listen(address); });
  });
  file->addSeparator();
  file->addAction(tr("Save &picture..."), this, [this] { this->SavePicture(); });
  file->addAction(tr("Save as &script..."), this, [this] { this->SaveScript(); });
  file->addSeparator();
  file->addAction(tr("&Quit"), QKeySequence::Quit, this, [this] { this->close(); });
  QMenu* view = this->menuBar()->addMenu(tr("&View"));
  view->addAction(tr("&New view"), QKeySequence(Qt::CTRL | Qt::Key_N), this,
                  [this] { this->Run(QStringLiteral("app.new_view()")); });
  view->addAction(tr("New &plot"), QKeySequence(Qt::CTRL | Qt::Key_P), this,
                  [this] { this->Run(QStringLiteral("app.plot()")); });
  view->addAction(tr("&Tile views"), QKeySequence(Qt::CTRL | Qt::Key_T), this,
                  [this] { this->Run(QStringLiteral("app.tile_views()")); });
  const auto ofView = [this, view](const QString& text, const QKeySequence& key,
                                   const QString& line) {
    view->addAction(text, key, this, [this, line] {
      const QString used = this->CurrentView(true);
      if (!used.isEmpty()) {
        this->Run(line.arg(used));
      }
    });
  };
  view->addAction(tr("&Maximise view, and back"), QKeySequence(Qt::Key_F11), this, [this] {
    const QString used = this->CurrentView(true);
    if (this->Panes_->IsMaximized()) {
      this->Run(QStringLiteral("app.restore_views()"));
    } else if (!used.isEmpty()) {
      this->Run(QStringLiteral("app.maximize_view(%1)").arg(used));
    }
  });
  ofView(tr("Split &right"), {}, QStringLiteral("app.split_view(%1)"));
  ofView(tr("Split &below"), {}, QStringLiteral("app.split_view(%1, \"below\")"));
  ofView(tr("Open a m&ap in step"), {}, QStringLiteral("app.open_map(%1)"));
  ofView(tr("&Copy picture"), QKeySequence(Qt::CTRL | Qt::SHIFT | Qt::Key_C),
         QStringLiteral("app.copy_picture(%1)"));
  view->addSeparator();
  view->addAction(this->SceneDock_->toggleViewAction());
  view->addAction(this->TerrainDock_->toggleViewAction());
  view->addAction(this->MeasureDock_->toggleViewAction());
  view->addAction(this->TimeDock_->toggleViewAction());
  view->addAction(this->Telemetry_->TableDock()->toggleViewAction());
  view->addAction(this->MessageDock_->toggleViewAction());
  view->addAction(this->ConsoleDock_->toggleViewAction());
  this->menuBar()->addMenu(this->Movies_->Menu());
  this->Shell_->FillView(view);
  this->Shell_->FillHelp(this->menuBar()->addMenu(tr("&Help")), KeyTable(), [this] {
    return AboutText(this->Session_->GetRenderContext(), QCoreApplication::applicationVersion());
  });
  CompleteMnemonics(this->menuBar());
}

bool MainWindow::Run(const QString& python, const QString& about) {
  this->Errors_.clear();
  const bool done = this->Console_->Run(python);
  if (!done) {
    // The last line of a traceback says what is wrong.
    QString why = this->Errors_.trimmed().section('\n', -1).trimmed();
    if (!about.isEmpty() && !why.contains(about)) {
      why = about + QStringLiteral(": ") + why;
    }
    this->Shell_->Notices()->Fail(why.isEmpty() ? tr("Failed: %1").arg(python) : why,
                                  python + '\n' + this->Errors_);
    this->Report(tr("Failed: %1 (see the Python dock)").arg(python));
  }
  return done;
}

bool MainWindow::Connect(const QString& address) {
  return this->Run(QStringLiteral("app.connect(%1)").arg(Quoted(address)), address);
}

bool MainWindow::Listen(const QString& address, const QStringList& roots) {
  QStringList quoted;
  for (const QString& root : roots) {
    quoted << Quoted(QFileInfo(root).absoluteFilePath());
  }
  return this->Run(roots.isEmpty() ? QStringLiteral("app.listen(%1)").arg(Quoted(address))
                                   : QStringLiteral("app.listen(%1, roots=[%2])")
                                         .arg(Quoted(address), quoted.join(QStringLiteral(", "))));
}

bool MainWindow::RestoreLayout(const QString& name) {
  return this->Run(QStringLiteral("app.layouts.restore(%1)").arg(Quoted(name)));
}

QString MainWindow::PlugInFolder() {
  return QStandardPaths::writableLocation(QStandardPaths::AppDataLocation) +
         QStringLiteral("/plugins");
}

bool MainWindow::LoadPlugIns(const QStringList& names) {
  if (QFileInfo(PlugInFolder()).isDir()) {
    this->Run(QStringLiteral("app.plugins.load_folder(%1, app)").arg(Quoted(PlugInFolder())));
  }
  bool all = true;
  for (const QString& name : names) {
    all = this->Run(QStringLiteral("app.load_plugin(%1)").arg(Quoted(name))) && all;
  }
  return all;
}

bool MainWindow::Open(const QString& path) {
  const QString full = QFileInfo(path).absoluteFilePath();
  if (!this->Run(QStringLiteral("app.open(%1)").arg(Quoted(full)), QFileInfo(full).fileName())) {
    return false;
  }
  this->Shell_->Recent()->Add(full);
  this->Report(tr("Opened %1").arg(full));
  return true;
}

void MainWindow::AskText(const QString& title, const QString& label, const QString& text,
                         const std::function<void(const QString&)>& take) {
  auto* dialog = new QInputDialog(this);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setWindowTitle(title);
  dialog->setLabelText(label);
  dialog->setTextValue(text);
  dialog->resize(420, dialog->sizeHint().height());
  connect(dialog, &QInputDialog::textValueSelected, this, [take](const QString& given) {
    if (!given.trimmed().isEmpty()) {
      take(given.trimmed());
    }
  });
  dialog->open(); // nothing stops meanwhile
}

void MainWindow::ChooseFiles() {
  const QStringList paths = QFileDialog::getOpenFileNames(
      this, tr("Open"), QString(),
      tr("All that Dspace opens (*.glb *.gltf *.wrl *.wrl.gz *.iv *.obj *.stl *.ply *.urdf *.json "
         "*.tif *.tiff *.img *.lbl *.cub *.vrt *.asc *.dspace *.py);;All files (*)"));
  for (const QString& path : paths) {
    this->Open(path);
  }
}

void MainWindow::SaveScript() {
  QString path =
      QFileDialog::getSaveFileName(this, tr("Save as script"), QString(), tr("Python (*.py)"));
  if (path.isEmpty()) {
    return;
  }
  if (QFileInfo(path).suffix().isEmpty()) {
    path += QStringLiteral(".py");
  }
  QSaveFile file(path); // the old one stays until all is written
  const QByteArray script = ScriptHead + this->Console_->Script().toUtf8();
  if (!file.open(QIODevice::WriteOnly) || file.write(script) != script.size() || !file.commit()) {
    this->Report(tr("%1: %2").arg(path, file.errorString()));
    return;
  }
  this->Report(tr("Saved %1").arg(path));
}

void MainWindow::SavePicture() {
  if (this->Views_.empty()) {
    this->Report(tr("There is no view to save"));
    return;
  }
  const QString path =
      QFileDialog::getSaveFileName(this, tr("Save picture"), QString(), tr("PNG (*.png)"));
  if (!path.isEmpty()) {
    this->Run(QStringLiteral("%1.save(%2)").arg(this->CurrentView(true), Quoted(path)));
  }
}

void MainWindow::Report(const QString& text) {
  this->statusBar()->showMessage(text);
}

void MainWindow::ShowView(vtkObject* of, const std::string& viewport, const std::string& title) {
  const ShownSession session(of);
  vtkDspaceViewport* shown = session.Viewport(viewport);
  if (!shown) {
    throw std::runtime_error("there is no viewport '" + viewport + "'");
  }
  this->Scenes_->Add(of, QString::fromStdString(title).section(QStringLiteral(": "), 0, 0));
  this->Scenes_->Activate(of, session.SceneOf(viewport));
  View_t& view = this->Views_[{of, viewport}];
  if (view.dock) {
    view.dock->show();
    view.dock->raise();
    return;
  }
  auto* dock = new QDockWidget(QString::fromStdString(title), this);
  dock->setObjectName(QStringLiteral("view ") + QString::fromStdString(viewport));
  auto* widget = new ViewportWidget(shown, dock);
  ConnectToExecutor(
      *widget, [session](const std::string& command) { return session.Execute(command); }, viewport,
      [this, widget, session, viewport](const std::string& event, const std::string& reply) {
        if (!this->Marks_->Take(session.Of(), viewport, event, reply)) {
          this->Selection_->Take(event, reply);
        }
        OpenViewMenu(widget, session, event, reply,
                     [this](const QString& line) { return this->Run(line); });
        this->Interpreter_->Tell(viewport, event, reply);
      });
  widget->SetSource([session, viewport] { return session.Viewport(viewport); });
  this->Scenes_->Watch(widget, of, viewport);
  connect(widget, &ViewportWidget::failed, this,
          [this](const QString& message) { this->Report(message); });
  dock->setTitleBarWidget(new ViewBar(widget, session, viewport, QString::fromStdString(title),
                                      [this](const QString& line) { return this->Run(line); }));
  dock->setWidget(widget);
  view = {dock, widget};
  this->Panes_->Add(dock, widget, of, viewport);
  this->Selection_->Add(widget, of, viewport);
  this->ViewKeys_->Add(widget, viewport);
  this->Pointer_->Add(widget, of, viewport);
  this->Marks_->Add(widget, of, viewport);
  this->Overlays_->Add(widget, of, viewport);
  this->Libraries_->AddView(widget);
  const QWidget* focus = this->focusWidget();
  if (!focus || qobject_cast<const ViewportWidget*>(focus) ||
      (this->ConsoleDock_->isAncestorOf(focus) && !this->Console_->IsInUse())) {
    widget->setFocus(); // its keys work at once
  }
  if (this->Shell_->GetLayouts()->Place(dock)) { // a layout has it
    return;
  }
  this->addDockWidget(Qt::RightDockWidgetArea, dock);
  if (this->Views_.size() == 1) {
    this->PlugIns_->ArrangeBeside(dock);
  }
  this->Panes_->Tile();
  if (this->Views_.size() == 1) { // the views get the room: the prompt had all of it
    this->Arranging_ = true;
    QTimer::singleShot(0, this, [this, dock = QPointer<QDockWidget>(dock)] {
      this->Arranging_ = false;
      if (dock) {
        const int low = int(std::max(0.2, this->Telemetry_->HeightShare()) * this->height());
        this->resizeDocks({dock, this->ConsoleDock_}, {this->height() - low, low}, Qt::Vertical);
        this->resizeDocks({this->SceneDock_, dock}, {this->width() / 4, 3 * this->width() / 4},
                          Qt::Horizontal);
      }
    });
  }
}

void MainWindow::Forget(vtkObject* of) {
  if (this->Telemetry_) {
    this->Telemetry_->Forget(of);
  }
  for (auto it = this->Views_.begin(); it != this->Views_.end();) {
    if (it->first.first == of) {
      delete it->second.dock.data();
      it = this->Views_.erase(it);
    } else {
      ++it;
    }
  }
  if (this->Scenes_) {
    this->Scenes_->Forget(of);
  }
}

void MainWindow::CloseView(vtkObject* of, const std::string& viewport) {
  const auto found = this->Views_.find({of, viewport});
  if (found != this->Views_.end()) {
    delete found->second.dock.data();
    this->Views_.erase(found);
  }
}

ViewportWidget* MainWindow::View(const std::string& viewport) const {
  for (const auto& [key, view] : this->Views_) {
    if (key.second == viewport && view.widget) {
      return view.widget;
    }
  }
  return nullptr;
}

int MainWindow::ViewCount() const {
  return int(std::count_if(this->Views_.begin(), this->Views_.end(),
                           [](const auto& entry) { return !entry.second.dock.isNull(); }));
}

bool MainWindow::IsSettled() const {
  return !this->Arranging_ &&
         std::all_of(this->Views_.begin(), this->Views_.end(), [](const auto& entry) {
           ViewportWidget* widget = entry.second.widget;
           const QDockWidget* dock = entry.second.dock;
           if (dock && dock->isHidden() && !dock->testAttribute(Qt::WA_WState_ExplicitShowHide)) {
             return false; // Qt shows a new dock in the next turn of the event loop
           }
           return !widget || !widget->isVisible() || widget->IsUpToDate();
         });
}

void MainWindow::AddViewParts(SceneTreeWidget* tree, TimelineWidget* timeline) {
  connect(tree, &SceneTreeWidget::clicked, this, [this, tree](const SceneItem& item) {
    const auto scene = tree->Model()->GetScene();
    if (!this->Marks_ || !scene) {
      return;
    }
    Eigen::Vector3d origin = Eigen::Vector3d::Zero(); // of what the row stands for
    if (const auto object = scene->Objects().find(item.object); object != scene->Objects().end()) {
      origin = object->second.X_FO.translation();
    }
    const Eigen::Vector3d p = scene->Frames().WorldPose(item.frame).Apply(origin);
    const auto [of, name] = this->Scenes_->ActiveScene();
    this->Marks_->TakePoint(of, name, {p.x(), p.y(), p.z()});
  });
  const auto run = [this](const QString& line) { return this->Run(line); };
  this->Panes_ = new ViewPanes(this);
  connect(this->Panes_, &ViewPanes::drawn, this, [this](const QString& viewport) {
    this->Interpreter_->Run(QStringLiteral("app._drawn(%1)").arg(Quoted(viewport)));
  });
  connect(this->Panes_, &ViewPanes::currentChanged, this, [this] {
    QTimer::singleShot(0, this, [this] { // after what gave it the focus
      if (this->Interpreter_) {
        this->Interpreter_->Run(QStringLiteral("app._follow()"));
      }
    });
  });
  this->Selection_ = new ViewSelection(tree, this->Scenes_, this);
  this->Movies_ =
      new MovieTrack(this, timeline, this->Scenes_,
                     {run, [this](const QString& line) { this->Interpreter_->Run(line); },
                      [this] { return this->CurrentView(); },
                      [this](const QString& message) { this->Report(message); }});
  this->ViewKeys_ =
      new ViewKeys(timeline, this->Selection_, this->Movies_, this->Marks_, run, this);
}

QString MainWindow::CurrentView(bool any) const {
  const ViewPanes::Pane pane =
      this->Panes_->Current(any ? nullptr : this->Scenes_->ActiveScene().first);
  return pane.dock
             ? QStringLiteral("app.views[%1]").arg(Quoted(QString::fromStdString(pane.viewport)))
             : QString();
}

void MainWindow::closeEvent(QCloseEvent* event) {
  if (this->Interpreter_->IsBusy()) {
    PythonInterpreter::Interrupt();
  }
  this->Closing_ = true;
  this->Files_->CancelAll();
  this->Shell_->End();
  event->accept();
}

void MainWindow::dragEnterEvent(QDragEnterEvent* event) {
  if (event->mimeData()->hasUrls()) {
    event->acceptProposedAction();
  }
}

void MainWindow::dropEvent(QDropEvent* event) {
  for (const QUrl& url : event->mimeData()->urls()) {
    if (url.isLocalFile()) {
      this->Open(url.toLocalFile());
    }
  }
}

} // namespace dspace::widgets
