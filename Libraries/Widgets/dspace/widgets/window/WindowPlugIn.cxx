#include <dspace/widgets/window/WindowPlugIn.h>

#include <QAction>
#include <QDockWidget>
#include <QFileInfo>
#include <QKeySequence>
#include <QLabel>
#include <QLibrary>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QPainter>
#include <QStatusBar>
#include <QTimer>

#include <dspace/Error.h>
#include <dspace/widgets/desktop/MenuKeys.h>
#include <dspace/widgets/overlay/OverlayPane.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {
namespace {

constexpr int ReadOutEvery_ms = 100;

} // namespace

WindowPlugIn::WindowPlugIn(QMainWindow* window, vtkDspaceSession* session,
                           std::function<bool(const QString&)> run)
    : QObject(window), Window_(window), Session_(session), Run_(std::move(run)) {}

WindowPlugIn::~WindowPlugIn() {
  for (const auto& made : this->Made_) {
    delete made.data();
  }
}

void WindowPlugIn::Guard(const std::function<void()>& f) {
  try {
    f();
  } catch (const std::exception& error) {
    emit this->failed(tr("a plug-in failed: %1").arg(QString::fromUtf8(error.what())));
  } catch (...) {
    emit this->failed(tr("a plug-in failed with an exception of its own"));
  }
}

void WindowPlugIn::Load(const QString& path) {
  const QFileInfo info(path);
  const std::string label = "plug-in '" + path.toStdString() + "'";
  if (!info.isFile()) {
    throw Error(Error::Kind::NotFound, label, "there is no such file");
  }
  QLibrary library(info.absoluteFilePath());
  library.setLoadHints(QLibrary::ResolveAllSymbolsHint);
  if (!library.load()) {
    throw Error(Error::Kind::Unsupported, label, library.errorString().toStdString());
  }
  using Version = const char* (*)();
  using Begin = void (*)(WindowPlugIn&);
  const auto version = reinterpret_cast<Version>(library.resolve("DspaceWindowPlugInVersion"));
  const auto begin = reinterpret_cast<Begin>(library.resolve("DspaceWindowPlugIn"));
  if (!version || !begin) {
    library.unload();
    throw Error(Error::Kind::Unsupported, label,
                "it has no DSPACE_WINDOW_PLUG_IN; accepted: a library with that macro of "
                "WindowPlugIn.h");
  }
  if (std::string(version()) != DSPACE_WINDOW_PLUG_IN_VERSION) {
    const std::string given = version();
    library.unload();
    throw Error(Error::Kind::Unsupported, label,
                "it is for '" + given +
                    "'; accepted: '" DSPACE_WINDOW_PLUG_IN_VERSION "': build it anew");
  }
  const std::size_t before = this->Made_.size();
  const std::size_t overlays = this->Overlays_.size();
  const auto undo = [&] {
    for (std::size_t i = this->Made_.size(); i-- > before;) {
      delete this->Made_[i].data();
    }
    this->Made_.resize(before);
    this->Overlays_.resize(overlays); // of views that come later
  };
  try {
    begin(*this);
  } catch (const Error&) {
    undo();
    throw;
  } catch (const std::exception& error) {
    undo();
    throw Error(Error::Kind::Unsupported, label, std::string("it failed: ") + error.what());
  }
}

QDockWidget* WindowPlugIn::AddDock(const QString& title, QWidget* content,
                                   Qt::DockWidgetArea area) {
  auto* dock = new QDockWidget(title, this->Window_);
  dock->setObjectName("plug-in " + title);
  dock->setWidget(content);
  if (!this->Window_->restoreDockWidget(dock)) {
    this->Window_->addDockWidget(area, dock);
  }
  this->Made_.emplace_back(dock);
  return dock;
}

QAction* WindowPlugIn::MakeAction(const QString& text, const QString& key,
                                  std::function<void()> chosen) {
  const QKeySequence sequence = FreeKey(this->Window_, text, key);
  auto* action = new QAction(text, this->Window_);
  action->setShortcut(sequence);
  connect(action, &QAction::triggered, this,
          [this, chosen = std::move(chosen)] { this->Guard(chosen); });
  this->Window_->addAction(action);
  this->Made_.emplace_back(action);
  return action;
}

QAction* WindowPlugIn::AddAction(const QString& menu, const QString& text, const QString& key,
                                 std::function<void()> chosen) {
  QAction* action = this->MakeAction(text, key, std::move(chosen));
  QMenu* in = MenuNamed(this->Window_, menu);
  if (!in) {
    in = this->Window_->menuBar()->addMenu(menu);
    this->Made_.emplace_back(in);
  }
  in->addAction(action);
  return action;
}

void WindowPlugIn::OnKey(const QString& key, std::function<void()> pressed) {
  this->MakeAction(tr("key %1").arg(key), key, std::move(pressed));
}

void WindowPlugIn::AddOverlay(Overlay draw) {
  this->Overlays_.push_back(std::move(draw));
  const Overlay added = this->Overlays_.back();
  for (ViewportWidget* view : this->Window_->findChildren<ViewportWidget*>()) {
    this->Made_.emplace_back(new OverlayPane(view, [this, added, view](QPainter& painter) {
      this->Guard([&] { added(painter, *view); });
    }));
  }
}

void WindowPlugIn::AddView(ViewportWidget* view) {
  for (const Overlay& each : this->Overlays_) {
    new OverlayPane(view, [this, each, view](QPainter& painter) {
      this->Guard([&] { each(painter, *view); });
    });
  }
}

QLabel* WindowPlugIn::AddReadOut(const QString& name, std::function<QString()> read) {
  auto* label = new QLabel(this->Window_);
  label->setObjectName("read-out " + name);
  label->setToolTip(name);
  this->Window_->statusBar()->addPermanentWidget(label);
  auto* timer = new QTimer(label);
  connect(timer, &QTimer::timeout, this, [this, label, name, timer, read = std::move(read)] {
    bool good = false;
    this->Guard([&] {
      const QString text = name + " " + read();
      if (label->text() != text) {
        label->setText(text);
      }
      good = true;
    });
    if (!good) {
      timer->stop(); // says so once
    }
  });
  timer->start(ReadOutEvery_ms);
  this->Made_.emplace_back(label);
  return label;
}

} // namespace dspace::widgets
