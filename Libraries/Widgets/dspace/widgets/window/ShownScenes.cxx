#include <dspace/widgets/window/ShownScenes.h>

#include <algorithm>
#include <chrono>
#include <exception>
#include <list>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include <QComboBox>
#include <QEvent>
#include <QSignalBlocker>
#include <QTimer>
#include <QVBoxLayout>

#include "vtkDspacePlayer.h"
#include "vtkDspaceSession.h"
#include "vtkDspaceWatcher.h"

#include <dspace/Error.h>
#include <dspace/interpreter/Interpreter.h>
#include <dspace/state/State.h>
#include <dspace/widgets/scene/SceneCommands.h>
#include <dspace/widgets/scene/SceneTreeModel.h>
#include <dspace/widgets/scene/SceneTreeWidget.h>
#include <dspace/widgets/timeline/PlaybackTimeSource.h>
#include <dspace/widgets/timeline/SceneTimeSource.h>
#include <dspace/widgets/timeline/TimelineMarks.h>
#include <dspace/widgets/timeline/TimelineWidget.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/TreeActions.h>

namespace dspace::widgets {
namespace {

constexpr int Tick_ms = 33;
constexpr int ListEvery = 15; // ticks

double Now() {
  return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

} // namespace

struct ShownScenes::Internals {
  struct Entry { // a session of any kind
    explicit Entry(vtkObject* of) : session(of) {}
    ShownSession session;
    QString title;
    std::shared_ptr<TimeSource> clock; // of a recording
    std::string marks;
    // By scene, with the session that they are of: a watcher makes its sessions anew.
    std::map<std::string, std::pair<vtkDspaceSession*, SceneActions>> actions;
    std::map<std::string, std::shared_ptr<TimeSource>> live; // of other sessions, by scene
    QString failure;
  };
  using Choice = std::pair<vtkObject*, std::string>;

  explicit Internals(ShownScenes* widget) : owner(widget) {}

  ShownScenes* owner;
  vtkDspaceSession* own = nullptr;
  std::string first;
  SceneTreeWidget* tree = nullptr;
  TimelineWidget* timeline = nullptr;
  QComboBox* list = nullptr;
  std::list<Entry> entries;
  std::vector<Choice> choices; // of the list
  Choice active;
  vtkDspaceSession* shown = nullptr; // in the tree
  std::map<QObject*, Choice> views;  // with the viewports' names
  QTimer ticks;
  int ticked = 0;
  Runner runner;

  Entry* Find(vtkObject* of) {
    for (Entry& entry : this->entries) {
      if (entry.session.Of() == of) {
        return &entry;
      }
    }
    return nullptr;
  }

  std::vector<std::string> ScenesOf(const Entry& entry) const {
    std::vector<std::string> names;
    for (const auto& [name, scene] : entry.session.Session()->GetInterpreter().GetState().scenes) {
      names.push_back(name);
    }
    if (entry.session.Of() == this->own && names.empty()) {
      names.push_back(this->first);
    }
    return names;
  }

  void Fill() {
    std::vector<Choice> now;
    QStringList texts;
    for (const Entry& entry : this->entries) {
      std::vector<std::string> names = this->ScenesOf(entry);
      vtkObject* of = entry.session.Of();
      // The scene in the docks stays, also while a seek makes it anew.
      if (of == this->active.first &&
          std::find(names.begin(), names.end(), this->active.second) == names.end()) {
        names.push_back(this->active.second);
      }
      for (const std::string& name : names) {
        now.emplace_back(of, name);
        const QString scene = QString::fromStdString(name);
        texts << (names.size() > 1 ? entry.title + ": " + scene : entry.title);
      }
    }
    const QSignalBlocker silent(this->list);
    QStringList old;
    for (int i = 0; i < this->list->count(); ++i) {
      old << this->list->itemText(i);
    }
    if (now != this->choices || texts != old) {
      this->choices = now;
      this->list->clear();
      this->list->addItems(texts);
      this->list->setVisible(texts.size() > 1);
    }
    const auto at = std::find(this->choices.begin(), this->choices.end(), this->active);
    this->list->setCurrentIndex(int(at - this->choices.begin()));
  }

  void ShowTree(Entry& entry) {
    vtkDspaceSession* session = entry.session.Session();
    auto& [of, actions] = entry.actions[this->active.second];
    if (of != session) {
      actions = ActionsOf(
          session, this->active.second, "main",
          [shown = entry.session](const std::string& command) { return shown.Execute(command); });
      of = session;
    }
    Connect(*this->tree, actions);
    this->tree->SetHandler([this, handler = actions.handler](const SceneRequest& request) {
      const auto scene = this->tree->Model()->GetScene();
      const QString line = scene ? LineOf(request, *scene) : QString();
      if (line.isEmpty() || !this->runner || !this->runner(line)) {
        handler(request);
      }
    });
    this->shown = session;
  }

  std::shared_ptr<TimeSource> ClockOf(Entry& entry, const std::string& scene) {
    if (entry.clock) {
      return entry.clock;
    }
    std::shared_ptr<TimeSource>& live = entry.live[scene];
    if (!live && entry.session.Watcher()) {
      // The session is another one after each snapshot.
      live = std::make_shared<SceneTimeSource>([session = entry.session, scene] {
        return session.Session()->GetInterpreter().FindScene(scene);
      });
    } else if (!live) {
      live = MakeTimeSource(entry.session.Session(), scene);
    }
    return live;
  }

  void Show(Entry& entry, const std::string& scene) {
    this->active = {entry.session.Of(), scene};
    this->ShowTree(entry);
    const std::shared_ptr<TimeSource> clock = this->ClockOf(entry, scene);
    if (this->timeline->Source() != clock) {
      this->timeline->SetSource(clock);
      this->timeline->SetMarksFile(entry.marks);
    }
    this->Fill();
    emit this->owner->activated();
  }

  void Tick() {
    for (Entry& entry : this->entries) {
      try {
        if (vtkDspaceWatcher* watcher = entry.session.Watcher()) {
          watcher->Update(0.0);
          if (this->active.first == entry.session.Of() && entry.session.Session() != this->shown) {
            this->ShowTree(entry);
          }
        } else if (entry.clock && entry.clock != this->timeline->Source()) {
          entry.clock->Advance(Now());
        }
        entry.failure.clear();
      } catch (const std::exception& error) {
        const QString message = QString::fromUtf8(error.what());
        if (message != std::exchange(entry.failure, message)) {
          emit this->owner->failed(message);
        }
      }
    }
    if (++this->ticked % ListEvery == 0) {
      this->Fill();
    }
  }
};

QWidget* ShownScenes::WithChoice(SceneTreeWidget* tree) {
  auto* both = new QWidget;
  auto* column = new QVBoxLayout(both);
  column->setContentsMargins(0, 0, 0, 0);
  column->setSpacing(0);
  auto* list = new QComboBox(both);
  list->setObjectName(QStringLiteral("scenes"));
  list->setToolTip(tr("The scene below and on the timeline"));
  list->setSizeAdjustPolicy(QComboBox::AdjustToMinimumContentsLengthWithIcon);
  list->hide();
  column->addWidget(list);
  column->addWidget(tree);
  return both;
}

ShownScenes::ShownScenes(vtkDspaceSession* own, const std::string& scene, SceneTreeWidget* tree,
                         TimelineWidget* timeline, QObject* parent)
    : QObject(parent), Impl_(std::make_unique<Internals>(this)) {
  Internals& self = *this->Impl_;
  self.own = own;
  self.first = scene;
  self.tree = tree;
  self.timeline = timeline;
  self.list = tree->parentWidget()->findChild<QComboBox*>(QStringLiteral("scenes"));
  connect(self.list, &QComboBox::activated, this, [this](int index) {
    Internals& impl = *this->Impl_;
    if (index >= 0 && std::size_t(index) < impl.choices.size()) {
      const Internals::Choice choice = impl.choices[std::size_t(index)];
      this->Activate(choice.first, choice.second);
    }
  });
  connect(&self.ticks, &QTimer::timeout, this, [this] { this->Impl_->Tick(); });
  self.ticks.start(Tick_ms);
  this->Add(own, tr("Live"));
  this->Activate(own, scene);
}

ShownScenes::~ShownScenes() {
  Internals& self = *this->Impl_;
  self.ticks.stop();
  self.timeline->SetSource(nullptr);
  self.tree->SetScene(nullptr);
  self.tree->SetHandler({});
  self.tree->SetKinds({});
}

void ShownScenes::Add(vtkObject* of, const QString& title) {
  Internals& self = *this->Impl_;
  if (self.Find(of)) {
    return;
  }
  Internals::Entry entry(of);
  entry.title = title;
  if (vtkDspacePlayer* player = entry.session.Player()) {
    if (!player->GetPlayback()) {
      throw Error(Error::Kind::Io, "player", "no recording is open; accepted: Open first");
    }
    const auto clock =
        std::make_shared<PlaybackTimeSource>(*player->GetPlayback(), *player->GetReader());
    clock->LookForGrowth();
    entry.clock = clock;
    entry.marks = MarksPath(player->GetReader()->Path());
  }
  self.entries.push_back(std::move(entry));
  self.Fill();
}

void ShownScenes::Forget(vtkObject* of) {
  Internals& self = *this->Impl_;
  for (auto it = self.views.begin(); it != self.views.end();) {
    it = it->second.first == of ? self.views.erase(it) : std::next(it);
  }
  if (self.active.first == of) {
    self.Show(*self.Find(self.own), self.first);
  }
  self.entries.remove_if([&](const Internals::Entry& entry) { return entry.session.Of() == of; });
  self.Fill();
}

void ShownScenes::Activate(vtkObject* of, const std::string& scene) {
  Internals& self = *this->Impl_;
  Internals::Entry* entry = self.Find(of);
  if (entry && !scene.empty() && self.active != Internals::Choice(of, scene)) {
    self.Show(*entry, scene);
  }
}

void ShownScenes::Watch(ViewportWidget* widget, vtkObject* of, const std::string& viewport) {
  this->Impl_->views[widget] = {of, viewport};
  widget->installEventFilter(this);
  connect(widget, &QObject::destroyed, this,
          [this](QObject* gone) { this->Impl_->views.erase(gone); });
}

bool ShownScenes::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::FocusIn || event->type() == QEvent::MouseButtonPress) {
    const auto found = this->Impl_->views.find(watched);
    if (found != this->Impl_->views.end()) {
      const auto [of, viewport] = found->second;
      this->Activate(of, ShownSession(of).SceneOf(viewport));
    }
  }
  return QObject::eventFilter(watched, event);
}

void ShownScenes::AskClock(vtkObject* of, const std::string& what, double a, double b) {
  Internals::Entry* entry = this->Impl_->Find(of);
  if (!entry || !entry->clock) {
    throw Error(Error::Kind::NotFound, "timeline",
                "the recording is not shown; accepted: one with a view");
  }
  TimeSource& clock = *entry->clock;
  if (what == "play") {
    clock.Play(a != 0.0);
  } else if (what == "seek") {
    clock.Seek(a);
  } else if (what == "speed") {
    clock.SetSpeed(a);
  } else if (what == "follow") {
    clock.Follow(a != 0.0);
  } else if (what == "loop") {
    clock.SetLoop(TimeRange{a, b});
  } else if (what == "unloop") {
    clock.SetLoop({});
  } else {
    throw Error(Error::Kind::InvalidArgument, "timeline",
                "there is no '" + what + "'; accepted: play, seek, speed, follow, loop, unloop");
  }
}

std::pair<vtkObject*, std::string> ShownScenes::ActiveScene() const {
  return this->Impl_->active;
}

const session::SceneState* ShownScenes::StateOf(vtkObject* of, const std::string& scene) const {
  Internals::Entry* entry = this->Impl_->Find(of);
  if (!entry) {
    return nullptr;
  }
  const auto& scenes = entry->session.Session()->GetInterpreter().GetState().scenes;
  const auto found = scenes.find(scene);
  return found == scenes.end() ? nullptr : &found->second;
}

const session::Telemetry* ShownScenes::TelemetryOf(vtkObject* of, const std::string& scene) const {
  const session::SceneState* state = this->StateOf(of, scene);
  return state ? &state->telemetry : nullptr;
}

const session::MessageLog* ShownScenes::MessagesOf(vtkObject* of, const std::string& scene) const {
  const session::SceneState* state = this->StateOf(of, scene);
  return state ? &state->messages : nullptr;
}

void ShownScenes::SetRunner(Runner runner) {
  this->Impl_->runner = std::move(runner);
}

void ShownScenes::Act(const QJsonObject& request) {
  Internals& self = *this->Impl_;
  SceneActions actions;
  if (Internals::Entry* entry = self.Find(self.active.first)) {
    actions = entry->actions[self.active.second].second;
  }
  const std::shared_ptr<Scene> scene = actions.source ? actions.source() : nullptr;
  if (!scene) {
    throw Error(Error::Kind::NotFound, "scene '" + self.active.second + "'",
                "it is not in the docks; accepted: a scene that is");
  }
  actions.handler(RequestOf(request, *scene));
  self.tree->Refresh();
}

QString ShownScenes::Active() const {
  return this->Impl_->list->currentText();
}

TimeSource* ShownScenes::Clock() const {
  return this->Impl_->timeline->Source().get();
}

} // namespace dspace::widgets
