#include <dspace/widgets/scene/SceneTreeWidget.h>

#include <algorithm>
#include <exception>
#include <string>
#include <utility>
#include <vector>

#include <QClipboard>
#include <QElapsedTimer>
#include <QEvent>
#include <QGuiApplication>
#include <QLabel>
#include <QLineEdit>
#include <QMenu>
#include <QScrollBar>
#include <QShortcut>
#include <QSplitter>
#include <QTimer>
#include <QVBoxLayout>

#include <dspace/widgets/scene/ScenePropertyPanel.h>
#include <dspace/widgets/scene/SceneTreeModel.h>
#include <dspace/widgets/scene/SceneTreeView.h>
#include <dspace/widgets/settings/DisplayUnits.h>

namespace dspace::widgets {
namespace {

constexpr int Refresh_ms = 33;
constexpr int SlowestRefresh_ms = 1000;
constexpr int RefreshShare = 20; // at most one part of so many is spent with looking
constexpr int Typing_ms = 120;   // after the last letter
constexpr int MostOpened = 2000; // rows that a search opens

// What is found again in another scene with the same frames.
struct RowName {
  std::string path;
  std::string object; // empty: the frame
};

} // namespace

struct SceneTreeWidget::Internals {
  explicit Internals(SceneTreeWidget* owner) : widget(owner) {}

  SceneTreeWidget* widget;
  Source source;
  Handler handler;
  SceneTreeModel* model = nullptr;
  SceneTreeView* view = nullptr;
  ScenePropertyPanel* panel = nullptr;
  QLineEdit* search = nullptr;
  QLabel* empty = nullptr;
  QLabel* failure = nullptr;
  QTimer ticks;
  QTimer typing;
  QTimer failureEnd;
  SceneItem item; // selected
  RowName itemName;
  bool searched = false;       // a search is shown
  std::vector<FrameId> opened; // before the search
  bool restoring = false;
  std::uint64_t shownRevision = 0; // in the panel
  bool panelOutdated = true;

  RowName NameOf(const SceneItem& wanted) const {
    const Scene& scene = *this->model->GetScene();
    RowName name;
    if (scene.Frames().Contains(wanted.frame)) {
      name.path = scene.Frames().Path(wanted.frame);
      const auto object = scene.Objects().find(wanted.object);
      name.object = object == scene.Objects().end() ? std::string() : object->second.name;
    }
    return name;
  }
  SceneItem ItemOf(const RowName& name) const {
    const auto& scene = this->model->GetScene();
    if (!scene || name.path.empty()) {
      return {};
    }
    if (!name.object.empty()) {
      const ObjectId object = scene->FindObject(name.object);
      return object == 0 ? SceneItem{} : SceneItem{scene->Object(object).frame, object};
    }
    return {scene->Frames().Find(name.path), 0};
  }

  // The opened frames below an index, parents first.
  void CollectOpened(const QModelIndex& parent, std::vector<FrameId>& opened) const {
    for (int row = 0; row < this->model->rowCount(parent); ++row) {
      const QModelIndex index = this->model->index(row, 0, parent);
      if (this->view->isExpanded(index)) {
        opened.push_back(this->model->ItemOf(index).frame);
        this->CollectOpened(index, opened);
      }
    }
  }

  void SetScene(std::shared_ptr<Scene> scene) {
    const std::shared_ptr<Scene> before = this->model->GetScene();
    if (scene == before) {
      return;
    }
    std::vector<std::string> opened;
    if (before) {
      std::vector<FrameId> frames;
      this->CollectOpened({}, frames);
      for (const FrameId frame : frames) {
        if (before->Frames().Contains(frame)) {
          opened.push_back(before->Frames().Path(frame));
        }
      }
    }
    const int scrolled = this->view->verticalScrollBar()->value();
    const RowName name = this->itemName;
    this->restoring = true;
    this->model->SetScene(std::move(scene));
    this->view->expand(this->model->index(0, 0));
    const auto& now = this->model->GetScene();
    for (const std::string& path : opened) {
      const FrameId frame = now ? now->Frames().Find(path) : NoFrame;
      if (frame != NoFrame) {
        this->view->expand(this->model->IndexOf({frame, 0}));
      }
    }
    this->restoring = false;
    this->OpenMatches();
    this->MarkRow(this->ItemOf(name), false);
    if (before) {
      this->view->verticalScrollBar()->setValue(scrolled);
    }
    if (this->panel->Reference() != NoFrame) { // ids are those of one scene
      this->panel->SetReference(now.get(), RootFrame);
    }
    this->panelOutdated = true;
    this->ShowEmpty();
  }

  void ShowEmpty() {
    const bool none = !this->model->GetScene();
    const bool nothing = !none && this->model->rowCount() == 0;
    this->empty->setText(none ? "No scene" : "No frame or object has this name");
    this->empty->setVisible(none || nothing);
    this->empty->setGeometry(this->view->viewport()->rect());
  }

  // Opens everything that a search left over, unless that is a lot.
  void OpenMatches() {
    if (this->search->text().trimmed().isEmpty()) {
      this->view->expand(this->model->index(0, 0));
      return;
    }
    if (this->model->Matches() <= MostOpened) {
      this->view->expandAll();
    } else {
      this->view->expand(this->model->index(0, 0));
    }
  }

  void Search() {
    const bool searching = !this->search->text().trimmed().isEmpty();
    if (searching && !this->searched) {
      this->opened.clear();
      this->CollectOpened({}, this->opened);
    }
    this->restoring = true;
    this->model->SetFilter(this->search->text());
    if (!searching && this->searched) {
      for (const FrameId frame : this->opened) {
        this->view->expand(this->model->IndexOf({frame, 0}));
      }
    }
    this->restoring = false;
    this->searched = searching;
    this->OpenMatches();
    this->MarkRow(this->item, !searching);
    this->ShowEmpty();
  }

  // Selects the row of an item, if it is there, and remembers the item.
  void MarkRow(const SceneItem& wanted, bool scroll) {
    const QModelIndex index = this->model->IndexOf(wanted);
    this->restoring = true;
    if (index.isValid()) {
      this->view->setCurrentIndex(index);
      if (scroll) {
        this->view->scrollTo(index);
      }
    } else {
      this->view->clearSelection();
      this->view->setCurrentIndex({});
    }
    this->restoring = false;
    this->Choose(wanted);
  }

  void Choose(const SceneItem& wanted) {
    const auto& scene = this->model->GetScene();
    const SceneItem before = this->item;
    const bool exists = scene && scene->Frames().Contains(wanted.frame) &&
                        (wanted.object == 0 || scene->Objects().count(wanted.object));
    this->item = exists ? wanted : SceneItem{};
    if (exists) {
      this->itemName = this->NameOf(wanted);
    }
    this->panelOutdated = true;
    if (this->item != before) {
      emit this->widget->selected(this->item);
    }
    this->ShowPanel();
  }

  void ShowPanel() {
    const auto& scene = this->model->GetScene();
    const std::uint64_t revision = scene ? scene->Revision() : 0;
    if (!this->panelOutdated && revision == this->shownRevision) {
      return;
    }
    this->panelOutdated = false;
    this->shownRevision = revision;
    this->panel->Show(scene.get(), this->item, this->model->KindOf(this->item));
  }

  void Fail(const QString& message) {
    this->failure->setText(message);
    this->failure->show();
    this->failureEnd.start(15000);
    emit this->widget->failed(message);
  }

  void ShowMenu(const QPoint& place) {
    const QModelIndex index = this->view->indexAt(place);
    const SceneItem at = this->model->ItemOf(index);
    if (at.frame == NoFrame) {
      return;
    }
    auto* menu = new QMenu(this->view);
    menu->setAttribute(Qt::WA_DeleteOnClose);
    const auto add = [&](const QString& text, SceneAction action, bool enabled = true) {
      QAction* entry = menu->addAction(text);
      entry->setEnabled(enabled);
      entry->setData(int(action));
      QObject::connect(entry, &QAction::triggered, this->widget,
                       [this, action, at] { this->widget->Request(action, at); });
    };
    const auto eye = this->model->EyeOf(at);
    const bool root = at.frame == RootFrame;
    add("Focus", SceneAction::Focus, eye != SceneTreeModel::Eye::None);
    add("Chase", SceneAction::Chase, !root);
    menu->addSeparator();
    if (eye == SceneTreeModel::Eye::Visible) {
      add("Hide", SceneAction::Hide);
    } else {
      add("Show", SceneAction::Show, eye != SceneTreeModel::Eye::None);
      if (eye == SceneTreeModel::Eye::Mixed) {
        add("Hide", SceneAction::Hide);
      }
    }
    add("Trail", SceneAction::Trail, !root);
    add("Axes", SceneAction::Axes);
    menu->addSeparator();
    add(at.object != 0 ? "Copy name" : "Copy path", SceneAction::CopyPath);
    QAction* reference = menu->addAction("Show poses relative to this frame");
    QObject::connect(reference, &QAction::triggered, this->widget,
                     [this, at] { this->widget->SetReference(at.frame); });
    menu->popup(this->view->viewport()->mapToGlobal(place));
  }
};

SceneTreeWidget::SceneTreeWidget(QWidget* parent)
    : QWidget(parent), Impl_(std::make_unique<Internals>(this)) {
  Internals& self = *this->Impl_;
  self.model = new SceneTreeModel(this);
  self.view = new SceneTreeView(self.model);
  self.panel = new ScenePropertyPanel;
  self.search = new QLineEdit;
  self.search->setPlaceholderText("Search frames and objects");
  self.search->setClearButtonEnabled(true);
  self.search->setAccessibleName("Search frames and objects");
  self.search->setToolTip("Shows only frames and objects whose names contain this text (Ctrl+F)");
  self.failure = new QLabel;
  self.failure->setWordWrap(true);
  self.failure->setTextFormat(Qt::PlainText);
  self.failure->setContentsMargins(8, 4, 8, 4);
  self.failure->setAutoFillBackground(true);
  QPalette warning = self.failure->palette();
  warning.setColor(QPalette::Window, QColor(0x8c, 0x2b, 0x24));
  warning.setColor(QPalette::WindowText, Qt::white);
  self.failure->setPalette(warning);
  self.failure->hide();
  auto* splitter = new QSplitter(Qt::Vertical);
  splitter->addWidget(self.view);
  splitter->addWidget(self.panel);
  splitter->setStretchFactor(0, 3);
  splitter->setStretchFactor(1, 2);
  splitter->setChildrenCollapsible(true);
  auto* column = new QVBoxLayout(this);
  column->setContentsMargins(4, 4, 4, 4);
  column->setSpacing(4);
  column->addWidget(self.search);
  column->addWidget(splitter, 1);
  column->addWidget(self.failure);
  self.empty = new QLabel(self.view->viewport());
  self.empty->setAlignment(Qt::AlignCenter);
  self.empty->setWordWrap(true);
  self.empty->setForegroundRole(QPalette::PlaceholderText);
  self.view->viewport()->installEventFilter(this);

  self.ticks.setSingleShot(true);
  self.typing.setSingleShot(true);
  self.failureEnd.setSingleShot(true);
  connect(&self.ticks, &QTimer::timeout, this, [this] {
    QElapsedTimer clock;
    clock.start();
    this->Refresh();
    this->Impl_->ticks.start(
        int(std::clamp<qint64>(RefreshShare * clock.elapsed(), Refresh_ms, SlowestRefresh_ms)));
  });
  connect(&self.typing, &QTimer::timeout, this, [this] { this->Impl_->Search(); });
  connect(&self.failureEnd, &QTimer::timeout, self.failure, &QWidget::hide);
  connect(self.search, &QLineEdit::textChanged, this,
          [this] { this->Impl_->typing.start(Typing_ms); });
  connect(self.search, &QLineEdit::returnPressed, this, [this] {
    this->Impl_->typing.stop();
    this->Impl_->Search();
    this->Impl_->view->setFocus();
  });
  connect(self.view->selectionModel(), &QItemSelectionModel::currentRowChanged, this,
          [this](const QModelIndex& now) {
            if (!this->Impl_->restoring) {
              this->Impl_->Choose(this->Impl_->model->ItemOf(now));
            }
          });
  connect(self.view, &SceneTreeView::eyeClicked, this, [this](const QModelIndex& index) {
    const SceneItem at = this->Impl_->model->ItemOf(index);
    const auto eye = this->Impl_->model->EyeOf(at);
    if (eye != SceneTreeModel::Eye::None) {
      this->Request(eye == SceneTreeModel::Eye::Visible ? SceneAction::Hide : SceneAction::Show,
                    at);
    }
  });
  connect(self.view, &QTreeView::clicked, this, [this](const QModelIndex& index) {
    const SceneItem at = this->Impl_->model->ItemOf(index);
    if (at.frame != NoFrame && index.column() != SceneTreeModel::VisibleColumn) {
      emit this->clicked(at);
    }
  });
  connect(self.view, &QTreeView::doubleClicked, this, [this](const QModelIndex& index) {
    const SceneItem at = this->Impl_->model->ItemOf(index);
    if (at.object != 0) { // a double click on a frame opens or closes it
      this->Request(SceneAction::Focus, at);
    }
  });
  connect(self.view, &QWidget::customContextMenuRequested, this,
          [this](const QPoint& place) { this->Impl_->ShowMenu(place); });
  connect(self.panel, &ScenePropertyPanel::referenceChosen, this, [this](const QString& path) {
    const auto& scene = this->Impl_->model->GetScene();
    const std::string text = path.trimmed().toStdString();
    const FrameId frame = text == "parent" ? NoFrame
                          : scene          ? scene->Frames().Find(text.empty() ? "/" : text)
                                           : RootFrame;
    if (frame == NoFrame && text != "parent") {
      this->Impl_->Fail(QString("there is no frame '%1'; accepted: a path such as rover/mast, / "
                                "for the root, or parent")
                            .arg(path));
      this->SetReference(this->Impl_->panel->Reference());
      return;
    }
    this->SetReference(frame);
  });
  auto* find = new QShortcut(QKeySequence::Find, this);
  find->setContext(Qt::WidgetWithChildrenShortcut);
  connect(find, &QShortcut::activated, this, [this] {
    this->Impl_->search->setFocus();
    this->Impl_->search->selectAll();
  });
  connect(&DisplayUnits::The(), &DisplayUnits::changed, this, [this] {
    this->Impl_->panelOutdated = true;
    this->Refresh();
  });
  self.ShowEmpty();
}

SceneTreeWidget::~SceneTreeWidget() {
  Internals& self = *this->Impl_;
  self.restoring = true; // views select other rows, and emit signals, while they end
  delete self.view;
  delete self.panel;
  delete self.search;
}

void SceneTreeWidget::SetScene(std::shared_ptr<Scene> scene) {
  this->Impl_->source = nullptr;
  this->Impl_->SetScene(std::move(scene));
}

void SceneTreeWidget::SetSource(Source source) {
  this->Impl_->source = std::move(source);
  this->Refresh();
}

void SceneTreeWidget::SetHandler(Handler handler) {
  this->Impl_->handler = std::move(handler);
}

void SceneTreeWidget::SetKinds(std::function<QString(ObjectId)> kinds) {
  this->Impl_->model->SetKinds(std::move(kinds));
  this->Impl_->view->viewport()->update();
}

void SceneTreeWidget::Select(const SceneItem& item) {
  this->Refresh();
  this->Impl_->MarkRow(item, true);
}

SceneItem SceneTreeWidget::Selected() const {
  return this->Impl_->item;
}

void SceneTreeWidget::SetReference(FrameId frame) {
  Internals& self = *this->Impl_;
  self.panel->SetReference(self.model->GetScene().get(), frame);
  self.panelOutdated = true;
  self.ShowPanel();
}

FrameId SceneTreeWidget::Reference() const {
  return this->Impl_->panel->Reference();
}

void SceneTreeWidget::Request(SceneAction action, const SceneItem& item) {
  Internals& self = *this->Impl_;
  const auto& scene = self.model->GetScene();
  if (!scene || !scene->Frames().Contains(item.frame) ||
      (item.object != 0 && !scene->Objects().count(item.object))) {
    return; // it went while a menu was open
  }
  if (action == SceneAction::CopyPath) {
    QGuiApplication::clipboard()->setText(QString::fromStdString(
        item.object != 0 ? scene->Object(item.object).name : scene->Frames().Path(item.frame)));
  }
  emit this->contextAction(action, item);
  if (self.handler && action != SceneAction::CopyPath) {
    try {
      self.handler({action, item});
      self.failure->hide();
    } catch (const std::exception& error) {
      self.Fail(QString::fromUtf8(error.what()));
    }
  }
  this->Refresh();
}

void SceneTreeWidget::Refresh() {
  Internals& self = *this->Impl_;
  if (self.source) {
    self.SetScene(self.source());
  }
  self.restoring = true; // the view selects another row for one that goes
  const bool changed = self.model->Refresh();
  self.restoring = false;
  if (changed) {
    self.ShowEmpty();
    // Rows that moved to another frame are made anew, without the selection.
    const QModelIndex current = self.view->currentIndex();
    if (self.item.frame != NoFrame &&
        (!current.isValid() || self.model->ItemOf(current) != self.item)) {
      SceneItem item = self.item;
      const auto& objects = self.model->GetScene()->Objects();
      const auto object = objects.find(item.object);
      if (object != objects.end()) {
        item.frame = object->second.frame;
      }
      self.MarkRow(item, false);
    }
    self.panelOutdated = true;
  }
  self.ShowPanel();
}

SceneTreeModel* SceneTreeWidget::Model() const {
  return this->Impl_->model;
}

SceneTreeView* SceneTreeWidget::View() const {
  return this->Impl_->view;
}

QSize SceneTreeWidget::sizeHint() const {
  return {360, 640};
}

void SceneTreeWidget::showEvent(QShowEvent*) {
  this->Refresh();
  this->Impl_->ShowEmpty();
  this->Impl_->ticks.start(Refresh_ms);
}

void SceneTreeWidget::hideEvent(QHideEvent*) {
  this->Impl_->ticks.stop();
}

bool SceneTreeWidget::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::Resize) { // of the view
    this->Impl_->empty->setGeometry(this->Impl_->view->viewport()->rect());
  }
  return QWidget::eventFilter(watched, event);
}

} // namespace dspace::widgets
