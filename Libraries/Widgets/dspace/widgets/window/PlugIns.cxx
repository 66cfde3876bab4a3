#include <dspace/widgets/window/PlugIns.h>

#include <QAction>
#include <QDockWidget>
#include <QEvent>
#include <QKeySequence>
#include <QLabel>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>
#include <QStatusBar>

#include <dspace/Error.h>
#include <dspace/widgets/desktop/MenuKeys.h>
#include <dspace/widgets/panel/PanelWidget.h>
#include <dspace/widgets/settings/Theme.h>

namespace dspace::widgets {
namespace {

[[noreturn]] void Refuse(const QString& object, const QString& message) {
  throw Error(Error::Kind::InvalidArgument, object.toStdString(), message.toStdString());
}

} // namespace

PlugIns::PlugIns(QMainWindow* window) : QObject(window), Window_(window) {
  window->installEventFilter(this);
}

PlugIns::~PlugIns() {
  for (auto& [number, dock] : this->Docks_) {
    delete dock.data();
  }
  for (auto& [number, readOut] : this->ReadOuts_) {
    delete readOut.label.data();
  }
}

PanelWidget* PlugIns::Panel(int panel) const {
  const auto found = this->Docks_.find(panel);
  return found == this->Docks_.end() || !found->second
             ? nullptr
             : qobject_cast<PanelWidget*>(found->second->widget());
}

void PlugIns::ArrangeBeside(QDockWidget* view) {
  QDockWidget* above = nullptr;
  for (auto& [number, dock] : this->Docks_) {
    if (!dock || dock->isFloating() ||
        this->Window_->dockWidgetArea(dock) != Qt::RightDockWidgetArea) {
      continue;
    }
    if (above) {
      this->Window_->splitDockWidget(above, dock, Qt::Vertical);
    } else {
      this->Window_->splitDockWidget(view, dock, Qt::Horizontal);
    }
    above = dock;
  }
  if (above) {
    const int width = this->Window_->width();
    this->Window_->resizeDocks({view, above}, {width / 2, width / 4}, Qt::Horizontal);
  }
}

int PlugIns::AddPanel(const QString& title, const QString& area) {
  const std::map<QString, Qt::DockWidgetArea> areas = {{"left", Qt::LeftDockWidgetArea},
                                                       {"right", Qt::RightDockWidgetArea},
                                                       {"top", Qt::TopDockWidgetArea},
                                                       {"bottom", Qt::BottomDockWidgetArea}};
  const auto found = areas.find(area);
  if (found == areas.end()) {
    Refuse("dock '" + title + "'",
           "its area is \"" + area + "\"; accepted: left, right, top, bottom");
  }
  const int number = ++this->LastPanel_;
  auto* dock = new QDockWidget(title, this->Window_);
  dock->setObjectName("plug-in " + title);
  auto* panel = new PanelWidget(dock);
  constexpr int Narrowest = 260; // [pixels] for names and controls beside each other
  panel->setMinimumWidth(Narrowest);
  connect(panel, &PanelWidget::changed, this, [this, number](int row, const QJsonValue& value) {
    emit this->changed(number, row, value);
  });
  dock->setWidget(panel);
  this->Docks_[number] = dock;
  if (this->Window_->restoreDockWidget(dock)) { // a layout has it
    return number;
  }
  this->Window_->addDockWidget(found->second, dock);
  for (auto* view : this->Window_->findChildren<QDockWidget*>()) {
    if (found->second == Qt::RightDockWidgetArea && view->objectName().startsWith("view ") &&
        !view->isFloating()) {
      this->ArrangeBeside(view);
      break;
    }
  }
  return number;
}

int PlugIns::AddAction(const QString& menu, const QString& text, const QString& key,
                       const QString& tip) {
  const QKeySequence sequence = FreeKey(this->Window_, text, key);
  QMenu* in = menu.isEmpty() ? nullptr : MenuNamed(this->Window_, menu);
  if (!menu.isEmpty() && !in) {
    in = this->Window_->menuBar()->addMenu(menu);
  }
  const int number = ++this->LastAction_;
  auto* action = new QAction(text, this->Window_);
  action->setShortcut(sequence);
  action->setToolTip(tip.isEmpty() ? WithoutMnemonics(text) : tip);
  connect(action, &QAction::triggered, this, [this, number] { emit this->triggered(number); });
  this->Window_->addAction(action);
  if (in) {
    in->setToolTipsVisible(true);
    in->addAction(action);
  }
  return number;
}

int PlugIns::AddReadOut(const QString& name, const QString& text, const QString& tip) {
  if (this->Window_->statusBar()->findChild<QLabel*>("read-out " + name)) {
    throw Error(Error::Kind::AlreadyExists, "read-out '" + name.toStdString() + "'",
                "there is one of this name already; accepted: another name, or close() first");
  }
  auto* label = new QLabel(this->Window_);
  label->setObjectName("read-out " + name);
  label->setTextFormat(Qt::PlainText);
  label->setToolTip(tip.isEmpty() ? name : tip);
  this->Window_->statusBar()->addPermanentWidget(label);
  this->ReadOuts_[++this->LastReadOut_] = {name, label, {}};
  this->Tell(this->LastReadOut_, text, {});
  return this->LastReadOut_;
}

void PlugIns::Tell(int readOut, const QString& text, const QString& state) {
  ReadOut& told = this->ReadOuts_.at(readOut);
  if (!state.isEmpty() && state != "amber" && state != "red") {
    Refuse("read-out '" + told.name + "'",
           "its state is \"" + state + "\"; accepted: \"\", amber, red");
  }
  told.state = state;
  told.label->setText(told.name + ' ' + text);
  this->Paint(told);
}

void PlugIns::Paint(const ReadOut& readOut) const {
  QPalette palette; // else of the theme
  if (!readOut.state.isEmpty()) {
    palette.setColor(QPalette::WindowText,
                     AccentOf(readOut.state == "red" ? Accent::Error : Accent::Warning,
                              this->Window_->palette()));
  }
  readOut.label->setPalette(palette);
}

bool PlugIns::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::PaletteChange) {
    for (const auto& [number, readOut] : this->ReadOuts_) {
      if (readOut.label) {
        this->Paint(readOut);
      }
    }
  }
  return QObject::eventFilter(watched, event);
}

QJsonObject PlugIns::Handle(const QJsonObject& request) {
  const QString what = request["do"].toString();
  if (what == "read_out") {
    return {{"read_out", this->AddReadOut(request["name"].toString(), request["text"].toString(),
                                          request["tip"].toString())}};
  }
  if (what == "tell" || what == "untell") {
    const int number = request["read_out"].toInt();
    if (const auto found = this->ReadOuts_.find(number);
        found == this->ReadOuts_.end() || !found->second.label) {
      throw Error(Error::Kind::NotFound, "read-out " + std::to_string(number), "it is closed");
    }
    if (what == "tell") {
      this->Tell(number, request["text"].toString(), request["state"].toString());
    } else {
      delete this->ReadOuts_[number].label.data();
      this->ReadOuts_.erase(number);
    }
    return {};
  }
  if (what == "panel") {
    return {{"panel", this->AddPanel(request["title"].toString(), request["area"].toString())}};
  }
  if (what == "action" || what == "key") {
    const QString key = request["key"].toString();
    const QString text = what == "key" ? "key " + key : request["text"].toString();
    return {{"action",
             this->AddAction(request["menu"].toString(), text, key, request["tip"].toString())}};
  }
  const int number = request["panel"].toInt();
  PanelWidget* panel = this->Panel(number);
  if (!panel) {
    throw Error(Error::Kind::NotFound, "dock " + std::to_string(number), "it is closed");
  }
  if (what == "row") {
    return {{"row", panel->AddRow(request["row"].toObject())}};
  }
  if (what == "set") {
    panel->Set(request["row"].toInt(-1), request["changes"].toObject());
  } else if (what == "close") {
    delete this->Docks_[number].data();
  } else {
    Refuse("plug-in", "it asks for \"" + what +
                          "\"; accepted: panel, row, set, close, action, "
                          "key, read_out, tell, untell");
  }
  return {};
}

} // namespace dspace::widgets
