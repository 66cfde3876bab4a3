#include <dspace/widgets/window/MovieTrack.h>

#include <algorithm>
#include <utility>
#include <vector>

#include <QAction>
#include <QFileDialog>
#include <QInputDialog>
#include <QJsonArray>
#include <QMenu>
#include <QToolButton>

#include "vtkObject.h"

#include <dspace/widgets/script/PythonText.h>
#include <dspace/widgets/timeline/KeyTrack.h>
#include <dspace/widgets/timeline/TimeTexts.h>
#include <dspace/widgets/timeline/TimelineWidget.h>
#include <dspace/widgets/window/ExportDialog.h>
#include <dspace/widgets/window/KeyDialog.h>
#include <dspace/widgets/window/ShownScenes.h>

namespace dspace::widgets {
namespace {

constexpr double FreezeByDefault = 2.0; // [s]
constexpr double LongestFreeze = 86400.0;
const char* const MovieFiles = "Movies (*.toml)";

// As Python's GetAddressAsString() writes it.
QString AddressOf(const vtkObject* object) {
  return QString::number(quintptr(object), 16);
}

QString TextOf(int number, const QJsonObject& key, double zero_s, double stands_s) {
  const auto elapsed = [](double seconds) { return QString::fromStdString(ElapsedText(seconds)); };
  QStringList lines;
  lines << QObject::tr("Key %1 at %2 (%3 s)")
               .arg(number)
               .arg(elapsed(key["run"].toDouble() - zero_s))
               .arg(key["run"].toDouble(), 0, 'f', 3);
  lines << QObject::tr("Movie: %1 s").arg(key["time"].toDouble(), 0, 'f', 3);
  if (stands_s > 0.0) {
    lines << QObject::tr("The run stands still for %1 s").arg(stands_s, 0, 'g', 4);
  }
  const QString lens = key["lens"].toString();
  if (lens == "fov_deg") {
    lines << QObject::tr("Field of view %1%2")
                 .arg(key["value"].toDouble(), 0, 'g', 4)
                 .arg(QChar(0xb0));
  } else if (lens == "height") {
    lines << QObject::tr("Orthographic, %1 m high").arg(key["value"].toDouble(), 0, 'g', 4);
  }
  lines << QObject::tr("In frame %1")
               .arg(key["frame"].toString().isEmpty() ? QStringLiteral("/")
                                                      : key["frame"].toString());
  if (key["rest"].toBool()) {
    lines << QObject::tr("The camera stops here");
  }
  if (key["cut"].toBool()) {
    lines << QObject::tr("A new shot begins");
  }
  return lines.join('\n');
}

} // namespace

MovieTrack::MovieTrack(QWidget* window, TimelineWidget* timeline, ShownScenes* scenes, Host host)
    : QObject(window), Window_(window), Timeline_(timeline), Scenes_(scenes),
      Host_(std::move(host)), Menu_(new QMenu(tr("&Movie"), window)) {
  KeyTrack* track = timeline->Keys();
  track->SetHint(
      tr("Camera keys: K or a double click here adds one where the camera of the view is"));
  connect(track, &KeyTrack::addAsked, this, [this](double run_s) { this->Add(run_s); });
  connect(track, &KeyTrack::editAsked, this, [this](int key) { this->Edit(key); });
  connect(track, &KeyTrack::moveAsked, this, [this](int key, double run_s) {
    this->Host_.run(QStringLiteral("app.movie.move_key(%1, %2)").arg(key).arg(PythonOf(run_s)));
  });
  connect(track, &KeyTrack::eraseAsked, this, [this](int key) {
    this->Host_.run(QStringLiteral("app.movie.delete_key(%1)").arg(key));
  });
  connect(track, &KeyTrack::menuWanted, this,
          [this](QMenu* menu, int key, double run_s) { this->FillKeyMenu(*menu, key, run_s); });
  connect(timeline, &TimelineWidget::timeChanged, this, [this] {
    const QJsonObject state = this->State();
    if (state["follows"].toBool() || state["path"].toBool()) {
      this->Host_.inform(QStringLiteral("app._moved()"));
    }
  });
  connect(scenes, &ShownScenes::activated, this, [this] { this->Show(); });
  connect(this->Menu_, &QMenu::aboutToShow, this, [this] { this->FillMenu(); });
  this->FillMenu(); // keys of actions work before it was opened
  auto* button = new QToolButton(timeline);
  button->setObjectName(QStringLiteral("movie"));
  button->setAutoRaise(true);
  button->setText(tr("Key"));
  button->setToolTip(tr("Adds a camera key where the camera of the view is now (K); the arrow has "
                        "more: preview, export"));
  button->setPopupMode(QToolButton::MenuButtonPopup);
  button->setMenu(this->Menu_);
  button->setFocusPolicy(Qt::TabFocus);
  connect(button, &QToolButton::clicked, this, [this] { this->AddKey(); });
  timeline->AddTool(button);
  this->Show();
}

MovieTrack::~MovieTrack() = default;

bool MovieTrack::Handles(const QJsonObject& request) {
  return request["do"].toString() == "keys";
}

void MovieTrack::Handle(const QJsonObject& request) {
  this->States_[request["of"].toString().section(QStringLiteral("0x"), 1).trimmed()] = request;
  this->Show();
}

QJsonObject MovieTrack::State() const {
  const auto found = this->States_.find(AddressOf(this->Scenes_->ActiveScene().first));
  return found == this->States_.end() ? QJsonObject() : found->second;
}

bool MovieTrack::HasKeys() const {
  return !this->Timeline_->Keys()->Keys().empty();
}

void MovieTrack::Show() {
  KeyTrack* track = this->Timeline_->Keys();
  const QJsonObject state = this->State();
  track->setVisible(!state.isEmpty());
  if (auto* button = this->Timeline_->findChild<QToolButton*>(QStringLiteral("movie"))) {
    button->setVisible(!state.isEmpty());
  }
  const QJsonArray told = state["keys"].toArray();
  TimeSource* clock = this->Scenes_->Clock();
  double begin = -1e300; // of the run
  double end = 1e300;
  double zero = 0.0;
  if (clock) {
    const TimeSource::State now = clock->GetState();
    if (now.range) {
      zero = begin = now.range->begin;
      end = now.range->end;
    }
  }
  const double beyond = 1e-3 * (end - begin);
  std::vector<TimelineKey> keys;
  for (qsizetype i = 0; i < told.size(); ++i) {
    const QJsonObject given = told[i].toObject();
    TimelineKey key;
    key.run_s = given["run"].toDouble();
    key.movie_s = given["time"].toDouble();
    key.low_s = std::max(given["low"].toDouble(begin - beyond), begin - beyond);
    key.high_s = std::min(given["high"].toDouble(end + beyond), end + beyond);
    key.cut = given["cut"].toBool();
    key.rest = given["rest"].toBool();
    double stands = 0.0;
    if (i + 1 < told.size()) {
      const QJsonObject next = told[i + 1].toObject();
      if (!next["cut"].toBool() && next["run"].toDouble() == key.run_s) {
        stands = next["time"].toDouble() - key.movie_s;
      }
    }
    key.text = TextOf(int(i), given, zero, stands);
    keys.push_back(std::move(key));
  }
  track->SetKeys(std::move(keys));
  track->SetNote(state["preview"].toBool()   ? tr("Preview (Esc ends it)")
                 : state["follows"].toBool() ? tr("A view follows the keys (Esc ends it)")
                                             : QString());
}

bool MovieTrack::AddKey() {
  TimeSource* clock = this->Scenes_->Clock();
  if (!clock || this->State().isEmpty()) {
    return false;
  }
  this->Add(clock->GetState().time_s);
  return true;
}

bool MovieTrack::Stop() {
  const QJsonObject state = this->State();
  return (state["preview"].toBool() || state["follows"].toBool()) &&
         this->Host_.run(QStringLiteral("app.movie.stop()"));
}

void MovieTrack::FillMenu() {
  QMenu& menu = *this->Menu_;
  menu.clear();
  const QJsonObject state = this->State();
  const bool some = !state.isEmpty();
  const bool keys = some && this->HasKeys();
  const int selected = this->Timeline_->Keys()->Selected();
  TimeSource* clock = this->Scenes_->Clock();
  const double now = clock ? clock->GetState().time_s : 0.0;
  const auto add = [&](const QString& text, const QString& tip, bool enabled, auto&& chosen) {
    QAction* action = menu.addAction(text);
    action->setToolTip(tip);
    action->setEnabled(enabled);
    connect(action, &QAction::triggered, this, std::forward<decltype(chosen)>(chosen));
    return action;
  };
  menu.setToolTipsVisible(true);
  add(tr("Add camera &key"), tr("Where the camera of the view is, at the time of the timeline (K)"),
      some, [this, now] { this->Add(now); });
  add(tr("&Edit key..."), tr("The selected key"), keys && selected >= 0,
      [this, selected] { this->Edit(selected); });
  menu.addSeparator();
  const QString view = this->Host_.view();
  const bool looks = state["preview"].toBool() || state["follows"].toBool();
  add(tr("&Preview"), tr("Plays the movie in the view, at its own speed"),
      keys && !view.isEmpty() && !looks,
      [this, view] { this->Host_.run(QStringLiteral("app.movie.preview(%1)").arg(view)); });
  add(tr("&Follow the keys"), tr("The view shows what the movie shows at the time of the timeline"),
      keys && !view.isEmpty() && !looks,
      [this, view] { this->Host_.run(QStringLiteral("app.movie.follow(%1)").arg(view)); });
  add(tr("&Stop"), tr("The view has its own camera again (Esc)"), looks, [this] { this->Stop(); });
  QAction* path =
      add(tr("Show the pat&h"), tr("Draws the path and the keys of the camera in views"), keys,
          [this, shown = state["path"].toBool()] {
            this->Host_.run(QStringLiteral("app.movie.show_path(%1)").arg(PythonOf(!shown)));
          });
  path->setCheckable(true);
  path->setChecked(state["path"].toBool());
  menu.addSeparator();
  add(tr("&Open movie file..."), tr("A file of the command dspace movie"), some,
      [this] { this->Load(); });
  add(tr("Save movie file &as..."), tr("Keys are kept in %1").arg(state["file"].toString()), keys,
      [this] { this->Save(); });
  add(tr("E&xport movie..."), tr("Makes a movie file in the background"), keys,
      [this] { this->Export(); });
}

void MovieTrack::FillKeyMenu(QMenu& menu, int key, double run_s) {
  const auto add = [&](const QString& text, auto&& chosen) {
    connect(menu.addAction(text), &QAction::triggered, this,
            std::forward<decltype(chosen)>(chosen));
  };
  if (key < 0) {
    add(tr("Add key here, from the view"), [this, run_s] { this->Add(run_s); });
    return;
  }
  add(tr("Edit key..."), [this, key] { this->Edit(key); });
  add(tr("Freeze the run here..."), [this, key] { this->Freeze(key); });
  add(tr("Delete key"),
      [this, key] { this->Host_.run(QStringLiteral("app.movie.delete_key(%1)").arg(key)); });
  if (this->Host_.view().isEmpty()) { // what follows takes its camera
    return;
  }
  menu.addSeparator();
  add(tr("Take the place of the view's camera"), [this, key] {
    this->Host_.run(QStringLiteral("app.movie.take_view(%1, %2)").arg(key).arg(this->Host_.view()));
  });
  add(tr("Freeze, and move the camera to the view..."), [this, key] { this->AddFrozen(key); });
}

void MovieTrack::Add(double run_s) {
  if (this->State().isEmpty()) {
    return;
  }
  const QString view = this->Host_.view();
  if (view.isEmpty()) {
    this->Host_.report(tr("There is no view whose camera a key could have"));
    return;
  }
  const auto& keys = this->Timeline_->Keys()->Keys();
  for (std::size_t i = 0; i < keys.size(); ++i) {
    if (keys[i].run_s == run_s) { // it has the view's place from now on
      this->Host_.run(QStringLiteral("app.movie.take_view(%1, %2)").arg(i).arg(view));
      return;
    }
  }
  this->Host_.run(QStringLiteral("app.movie.add_key(%1, %2)").arg(view, PythonOf(run_s)));
}

void MovieTrack::AddFrozen(int key) {
  const auto& keys = this->Timeline_->Keys()->Keys();
  if (key < 0 || std::size_t(key) >= keys.size()) {
    return;
  }
  auto* dialog = new QInputDialog(this->Window_);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setInputMode(QInputDialog::DoubleInput);
  dialog->setWindowTitle(tr("Freeze and move"));
  dialog->setLabelText(
      tr("Seconds of the movie for which the run stands still\nwhile the camera moves "
         "to where the view's camera is"));
  dialog->setDoubleRange(0.001, LongestFreeze);
  dialog->setDoubleDecimals(3);
  dialog->setDoubleValue(FreezeByDefault);
  connect(dialog, &QInputDialog::doubleValueSelected, this,
          [this, run_s = keys[std::size_t(key)].run_s](double seconds) {
            this->Host_.run(QStringLiteral("app.movie.add_key(%1, %2, freeze=%3)")
                                .arg(this->Host_.view(), PythonOf(run_s), PythonOf(seconds)));
          });
  dialog->open();
}

void MovieTrack::Freeze(int key) {
  auto* dialog = new QInputDialog(this->Window_);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setInputMode(QInputDialog::DoubleInput);
  dialog->setWindowTitle(tr("Freeze"));
  dialog->setLabelText(tr("Seconds of the movie for which the run stands still; 0: not"));
  dialog->setDoubleRange(0.0, LongestFreeze);
  dialog->setDoubleDecimals(3);
  dialog->setDoubleValue(FreezeByDefault);
  connect(dialog, &QInputDialog::doubleValueSelected, this, [this, key](double seconds) {
    this->Host_.run(QStringLiteral("app.movie.freeze(%1, %2)").arg(key).arg(PythonOf(seconds)));
  });
  dialog->open();
}

void MovieTrack::Edit(int key) {
  const QJsonArray told = this->State()["keys"].toArray();
  if (key < 0 || key >= told.size()) {
    return;
  }
  this->Timeline_->Keys()->Select(key);
  const QJsonObject given = told[key].toObject();
  const QJsonObject next = key + 1 < told.size() ? told[key + 1].toObject() : QJsonObject();
  auto* dialog = new KeyDialog(key, given, next, this->Window_);
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  connect(dialog, &QDialog::accepted, this, [this, dialog] {
    for (const QString& line : dialog->Lines()) {
      if (!this->Host_.run(line)) {
        return;
      }
    }
  });
  dialog->open();
}

void MovieTrack::Export() {
  const QJsonObject state = this->State();
  auto* dialog =
      new ExportDialog(state["size"].toArray(), state["rate"].toDouble(30.0),
                       state["samples"].toInt(2), state["duration"].toDouble(), this->Window_);
  // Not by WA_DeleteOnClose: hiding may run events, which would delete it too early.
  connect(dialog, &QDialog::finished, dialog, &QObject::deleteLater);
  connect(dialog, &QDialog::accepted, this, [this, dialog] { this->Host_.run(dialog->Line()); });
  dialog->open();
}

void MovieTrack::Load() {
  auto* dialog = new QFileDialog(this->Window_, tr("Open movie file"), QString(), tr(MovieFiles));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setFileMode(QFileDialog::ExistingFile);
  connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& path) {
    this->Host_.run(QStringLiteral("app.movie.load(%1)").arg(Quoted(path)));
  });
  dialog->open();
}

void MovieTrack::Save() {
  auto* dialog = new QFileDialog(this->Window_, tr("Save movie file"), QString(), tr(MovieFiles));
  dialog->setAttribute(Qt::WA_DeleteOnClose);
  dialog->setAcceptMode(QFileDialog::AcceptSave);
  dialog->setDefaultSuffix(QStringLiteral("toml"));
  connect(dialog, &QFileDialog::fileSelected, this, [this](const QString& path) {
    this->Host_.run(QStringLiteral("app.movie.save(%1)").arg(Quoted(path)));
  });
  dialog->open();
}

} // namespace dspace::widgets
