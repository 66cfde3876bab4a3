#include <dspace/widgets/window/PlugIns.h>

#include <QAction>
#include <QDockWidget>
#include <QKeySequence>
#include <QMainWindow>
#include <QMenu>
#include <QMenuBar>

#include <dspace/Error.h>
#include <dspace/widgets/desktop/MenuKeys.h>
#include <dspace/widgets/panel/PanelWidget.h>

namespace dspace::widgets {
namespace {

[[noreturn]] void Refuse(const QString& object, const QString& message) {
  throw Error(Error::Kind::InvalidArgument, object.toStdString(), message.toStdString());
}

} // namespace

PlugIns::PlugIns(QMainWindow* window) : QObject(window), Window_(window) {}

PlugIns::~PlugIns() {
  for (auto& [number, dock] : this->Docks_) {
    delete dock.data();
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
  const QKeySequence sequence(key);
  // Qt takes the first letter of a word that is no key.
  const QString read = sequence.toString(QKeySequence::PortableText);
  const auto last = [](const QString& keys) { return keys.section('+', -1).trimmed().toLower(); };
  if (!key.isEmpty() && (sequence.count() != 1 || last(read) != last(key))) {
    Refuse("action '" + text + "'",
           "its key is \"" + key + "\"; accepted: one such as F6 or Ctrl+Shift+D");
  }
  for (const QAction* other : this->Window_->findChildren<QAction*>()) {
    if (!sequence.isEmpty() && other->shortcut() == sequence) {
      Refuse("action '" + text + "'", "its key " + key + " is that of '" +
                                          WithoutMnemonics(other->text()) +
                                          "'; accepted: a free one");
    }
  }
  QMenu* in = nullptr;
  if (!menu.isEmpty()) {
    for (QAction* each : this->Window_->menuBar()->actions()) {
      in = each->menu() && WithoutMnemonics(each->text()) == WithoutMnemonics(menu) ? each->menu()
                                                                                    : in;
    }
    in = in ? in : this->Window_->menuBar()->addMenu(menu);
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

QJsonObject PlugIns::Handle(const QJsonObject& request) {
  const QString what = request["do"].toString();
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
    Refuse("plug-in",
           "it asks for \"" + what + "\"; accepted: panel, row, set, close, action, key");
  }
  return {};
}

} // namespace dspace::widgets
