#include <dspace/widgets/timeline/TimelineWidget.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <map>
#include <utility>

#include <QFontDatabase>
#include <QHBoxLayout>
#include <QInputDialog>
#include <QKeyEvent>
#include <QLabel>
#include <QThreadPool>
#include <QTimer>
#include <QToolButton>
#include <QVBoxLayout>

#include <dspace/widgets/timeline/KeyTrack.h>
#include <dspace/widgets/timeline/RateMeter.h>
#include <dspace/widgets/timeline/ScrubBar.h>
#include <dspace/widgets/timeline/TimeTexts.h>
#include <dspace/widgets/timeline/TransportIcons.h>

namespace dspace::widgets {
namespace {

constexpr int Tick_ms = 33;
const QString NoText(QChar(0x2013)); // a dash

QString SpeedText(double speed) {
  const double size = std::abs(speed);
  const QString text = size >= 1.0 || size < 1e-6
                           ? QString::number(size, 'g', 6)
                           : QString("1/%1").arg(QString::number(1.0 / size, 'g', 6));
  return (speed < 0.0 ? QString(QChar(0x2212)) : QString()) + QChar(0xd7) + " " + text;
}

} // namespace

struct TimelineWidget::Internals {
  explicit Internals(TimelineWidget* owner) : widget(owner) {}

  TimelineWidget* widget;
  std::shared_ptr<TimeSource> source;
  TimeSource::State state;
  std::uint64_t eventsRevision = 0;
  bool eventsShown = false;
  std::optional<double> shownTime;
  RateMeter meter;
  QTimer ticks;
  QTimer failureEnd;
  QString lastFailure;

  std::vector<TimelineMark> marks;
  std::string marksFile;
  std::uint64_t marksEpoch = 0; // of the file: answers about an earlier one are dropped
  QThreadPool writer;

  ScrubBar* bar = nullptr;
  KeyTrack* keys = nullptr;
  QHBoxLayout* tools = nullptr;
  QLabel* utc = nullptr;
  QLabel* elapsed = nullptr;
  int wide = 0; // the width of buttons and clock, without tools
  int less = 0; // what it is less without UTC and seconds
  QLabel* j2000 = nullptr;
  QLabel* rate = nullptr;
  QLabel* speed = nullptr;
  QLabel* failure = nullptr;
  std::map<TransportIcon, QToolButton*> buttons;
  bool playShown = false; // the play button shows Pause

  QToolButton* Add(QHBoxLayout& row, TransportIcon icon, const QString& name, const QString& tip,
                   std::function<void()> clicked, bool checkable = false) {
    auto* button = new QToolButton;
    button->setAutoRaise(true);
    button->setIconSize({20, 20});
    button->setToolTip(tip);
    button->setAccessibleName(name);
    button->setObjectName(name);
    button->setCheckable(checkable);
    button->setFocusPolicy(Qt::TabFocus);
    QObject::connect(button, &QToolButton::clicked, this->widget,
                     [this, clicked = std::move(clicked)] { this->Ask(clicked); });
    row.addWidget(button);
    this->buttons[icon] = button;
    return button;
  }

  void SetIcons() {
    const QPalette& palette = this->widget->palette();
    for (const auto& [icon, button] : this->buttons) {
      button->setIcon(MakeTransportIcon(
          icon == TransportIcon::Play && this->playShown ? TransportIcon::Pause : icon, palette));
    }
  }

  // Runs what may throw.
  void Try(const std::function<void()>& f) {
    try {
      f();
    } catch (const std::exception& error) {
      this->Fail(QString::fromUtf8(error.what()));
    }
  }
  // Asks the source for something; what is measured begins anew.
  void Ask(const std::function<void()>& f) {
    if (this->source) {
      this->Try(f);
      this->meter.Reset();
      this->widget->Refresh();
    }
  }
  void Fail(const QString& message) {
    const bool anew = this->failure->isHidden() || message != this->lastFailure;
    this->lastFailure = message;
    this->failure->setText(message);
    this->failure->show();
    this->failureEnd.start(15000);
    if (anew) {
      emit this->widget->failed(message);
    }
  }

  void SwitchPlaying() {
    this->Ask([this] { this->source->Play(!this->state.playing); });
  }
  // Moves the end of the loop that is at the beginning (or at the end) to the present time.
  void SetLoopEnd(bool begin) {
    this->Ask([&] {
      if (!this->state.range) {
        return;
      }
      TimeRange loop = this->state.loop.value_or(*this->state.range);
      (begin ? loop.begin : loop.end) = this->state.time_s;
      if (loop.Length() <= 0.0) {
        (begin ? loop.end : loop.begin) = begin ? this->state.range->end : this->state.range->begin;
      }
      this->source->SetLoop(loop);
    });
  }

  static void Set(QLabel* label, const QString& text) {
    if (label->text() != text) {
      label->setText(text);
    }
  }

  void Show() {
    const bool some = this->source != nullptr;
    const TimeSource::State& s = this->state;
    const bool seeks = some && s.canSeek;
    for (const auto icon : {TransportIcon::StepBack, TransportIcon::StepOn, TransportIcon::Slower,
                            TransportIcon::Faster, TransportIcon::Reverse, TransportIcon::Loop}) {
      this->buttons[icon]->setEnabled(seeks);
    }
    this->buttons[TransportIcon::Play]->setEnabled(some && s.canPlay);
    this->buttons[TransportIcon::Live]->setEnabled(seeks && s.grows);
    this->buttons[TransportIcon::Live]->setVisible(!some || s.grows);
    this->buttons[TransportIcon::Mark]->setEnabled(some && s.range);
    this->buttons[TransportIcon::Reverse]->setChecked(s.speed < 0.0);
    this->buttons[TransportIcon::Loop]->setChecked(s.loop.has_value());
    this->buttons[TransportIcon::Live]->setChecked(s.following);
    if (const bool pause = s.playing && s.canPlay; pause != this->playShown) {
      this->playShown = pause;
      QToolButton* button = this->buttons[TransportIcon::Play];
      button->setAccessibleName(pause ? "Pause" : "Play");
      button->setToolTip(pause ? "Pause (Space)" : "Play (Space)");
      button->setIcon(MakeTransportIcon(pause ? TransportIcon::Pause : TransportIcon::Play,
                                        this->widget->palette()));
    }
    this->speed->setEnabled(seeks);
    Set(this->speed, SpeedText(s.speed));
    const bool known = some && s.range;
    const QString utcText =
        known && s.j2000 ? QString::fromStdString(UtcText(s.time_s)) : QString();
    Set(this->utc, utcText.isEmpty() ? (some ? "no UTC" : "no clock") : utcText);
    Set(this->elapsed,
        known ? QString::fromStdString(ElapsedText(s.time_s - s.range->begin)) : NoText);
    Set(this->j2000, !known    ? NoText
                     : s.j2000 ? QString::number(s.time_s, 'f', 3) + " s past J2000"
                               : QString::number(s.time_s, 'f', 3) + " s");
    const std::optional<double> factor = this->meter.Rate();
    Set(this->rate,
        (factor ? QString::number(*factor, 'f', std::abs(*factor) < 99.5 ? 2 : 0) : NoText) + " " +
            QChar(0xd7) + " real time");
    this->bar->SetState(some ? s : TimeSource::State());
  }

  // --- Marks -------------------------------------------------------------------------------------

  // Runs `work` in the writer's thread; the marks that it returns are those of the file.
  void WithFile(std::function<std::vector<TimelineMark>()> work) {
    const std::uint64_t epoch = this->marksEpoch;
    TimelineWidget* const owner = this->widget;
    this->writer.start([owner, epoch, work = std::move(work)] {
      std::vector<TimelineMark> marks;
      QString why;
      try {
        marks = work();
      } catch (const std::exception& error) {
        why = QString::fromUtf8(error.what());
      }
      // Dropped where the widget has ended.
      QMetaObject::invokeMethod(
          owner,
          [owner, epoch, marks, why] {
            Internals& self = *owner->Impl_;
            if (epoch != self.marksEpoch) {
              return;
            }
            if (!why.isEmpty()) {
              self.Fail(why);
              return;
            }
            self.SetMarks(marks);
          },
          Qt::QueuedConnection);
    });
  }
  void SetMarks(std::vector<TimelineMark> all) {
    std::stable_sort(all.begin(), all.end(), [](const TimelineMark& a, const TimelineMark& b) {
      return a.time_s < b.time_s;
    });
    this->marks = std::move(all);
    this->bar->SetMarks(this->marks);
    emit this->widget->marksChanged();
  }

  // Asks for the note of a mark, without stopping anything.
  void EditMark(TimelineMark mark, const QString& title) {
    auto* dialog = new QInputDialog(this->widget);
    dialog->setAttribute(Qt::WA_DeleteOnClose);
    dialog->setWindowTitle(title);
    dialog->setOption(QInputDialog::UsePlainTextEditForTextInput);
    dialog->setLabelText(
        QString("Note at %1")
            .arg(QString::fromStdString(
                ElapsedText(mark.time_s - (this->state.range ? this->state.range->begin : 0.0)))));
    dialog->setTextValue(QString::fromStdString(mark.note));
    QObject::connect(dialog, &QInputDialog::textValueSelected, this->widget,
                     [this, mark](const QString& text) {
                       TimelineMark changed = mark;
                       changed.note = text.toStdString();
                       this->widget->PutMark(changed);
                     });
    dialog->open();
  }
};

TimelineWidget::TimelineWidget(QWidget* parent)
    : QWidget(parent), Impl_(std::make_unique<Internals>(this)) {
  Internals& self = *this->Impl_;
  self.writer.setMaxThreadCount(1);
  self.writer.setExpiryTimeout(2000);
  this->setFocusPolicy(Qt::StrongFocus);
  auto* column = new QVBoxLayout(this);
  column->setSizeConstraint(QLayout::SetNoConstraint); // a narrow one shows less
  column->setContentsMargins(6, 4, 6, 4);
  column->setSpacing(2);
  auto* row = new QHBoxLayout;
  row->setSpacing(1);
  column->addLayout(row);
  const auto speed = [&self](double factor) {
    return [&self, factor] { self.source->SetSpeed(self.state.speed * factor); };
  };
  self.Add(*row, TransportIcon::StepBack, "Step back", "One step back (Left)",
           [&self] { self.source->Step(-1); });
  self.Add(*row, TransportIcon::Reverse, "Reverse", "Play backwards", speed(-1.0), true);
  self.Add(*row, TransportIcon::Play, "Play", "Play (Space)",
           [&self] { self.source->Play(!self.state.playing); });
  self.Add(*row, TransportIcon::StepOn, "Step", "One step on (Right)",
           [&self] { self.source->Step(1); });
  row->addSpacing(8);
  self.Add(*row, TransportIcon::Slower, "Slower", "Half the speed", speed(0.5));
  self.speed = new QLabel;
  self.speed->setAlignment(Qt::AlignCenter);
  self.speed->setMinimumWidth(QFontMetrics(this->font()).horizontalAdvance("- x 1/1024"));
  self.speed->setToolTip("The speed that playing asks for, in simulated seconds a second");
  self.speed->setObjectName("speed");
  row->addWidget(self.speed);
  self.Add(*row, TransportIcon::Faster, "Faster", "Twice the speed", speed(2.0));
  row->addSpacing(8);
  self.Add(
      *row, TransportIcon::Loop, "Loop",
      "Play a range again and again. Shift and drag on the bar selects it, [ and ] set its "
      "ends",
      [&self] {
        self.source->SetLoop(self.state.loop ? std::optional<TimeRange>() : self.state.range);
      },
      true);
  self.Add(*row, TransportIcon::Mark, "Mark", "Set a mark with a note at the present time (M)",
           [&self] {
             self.EditMark({NewMarkId(), self.state.time_s, ""}, "New mark");
           });
  self.Add(
      *row, TransportIcon::Live, "Live", "Stay at the live end",
      [&self] { self.source->Follow(!self.state.following); }, true);
  self.tools = new QHBoxLayout;
  row->addLayout(self.tools);
  row->addStretch(1);

  const QFont fixed = QFontDatabase::systemFont(QFontDatabase::FixedFont);
  const auto read = [&](const char* name, const QString& tip, const char* widest) {
    auto* label = new QLabel(NoText);
    label->setFont(fixed);
    label->setToolTip(tip);
    label->setObjectName(name);
    label->setAlignment(Qt::AlignRight | Qt::AlignVCenter);
    label->setMinimumWidth(QFontMetrics(fixed).horizontalAdvance(widest));
    return label;
  };
  self.utc = read("utc", "Simulation time in UTC; TT before 1972", "2026-01-01 00:00:00.000 UTC");
  self.elapsed = read("elapsed", "Simulation time since the beginning", "T+ 00:00:00.000");
  self.j2000 =
      read("j2000", "Simulation time: TDB seconds past J2000", "828360896.972 s past J2000");
  self.rate = read("rate", "The real-time factor: simulated seconds a second, over the last second",
                   "100.00 x real time");
  auto* clock = new QGridLayout;
  clock->setHorizontalSpacing(16);
  clock->setVerticalSpacing(0);
  clock->addWidget(self.utc, 0, 0);
  clock->addWidget(self.elapsed, 0, 1);
  clock->addWidget(self.j2000, 1, 0);
  clock->addWidget(self.rate, 1, 1);
  row->addLayout(clock);
  self.wide = row->minimumSize().width() + column->contentsMargins().left() +
              column->contentsMargins().right();
  self.less = self.utc->minimumWidth() + clock->horizontalSpacing();

  self.bar = new ScrubBar;
  column->addWidget(self.bar);
  self.keys = new KeyTrack(self.bar);
  self.keys->hide();
  column->addWidget(self.keys);
  connect(self.keys, &KeyTrack::goAsked, this, [this](double time_s) {
    Internals& impl = *this->Impl_;
    impl.Ask([&] { impl.source->Seek(time_s); });
  });
  self.failure = new QLabel;
  self.failure->setTextFormat(Qt::PlainText);
  self.failure->setWordWrap(true);
  self.failure->setContentsMargins(8, 4, 8, 4);
  self.failure->setAutoFillBackground(true);
  QPalette warning = self.failure->palette();
  warning.setColor(QPalette::Window, QColor(0x8c, 0x2b, 0x24));
  warning.setColor(QPalette::WindowText, Qt::white);
  self.failure->setPalette(warning);
  self.failure->hide();
  column->addWidget(self.failure);
  self.failureEnd.setSingleShot(true);
  connect(&self.failureEnd, &QTimer::timeout, self.failure, &QWidget::hide);

  connect(self.bar, &ScrubBar::scrubbed, this, [this](double time_s) {
    Internals& impl = *this->Impl_;
    impl.Ask([&] { impl.source->Seek(time_s); });
  });
  connect(self.bar, &ScrubBar::loopChosen, this, [this](double begin_s, double end_s) {
    Internals& impl = *this->Impl_;
    impl.Ask([&] { impl.source->SetLoop(TimeRange{begin_s, end_s}); });
  });
  connect(self.bar, &ScrubBar::markAsked, this, [this](double time_s) {
    this->Impl_->EditMark({NewMarkId(), time_s, ""}, "New mark");
  });
  connect(self.bar, &ScrubBar::markOpened, this, [this](const QString& id) {
    for (const TimelineMark& mark : this->Impl_->marks) {
      if (mark.id == id.toStdString()) {
        this->Impl_->EditMark(mark, "Mark");
        return;
      }
    }
  });
  connect(self.bar, &ScrubBar::markErased, this,
          [this](const QString& id) { this->EraseMark(id.toStdString()); });
  connect(&self.ticks, &QTimer::timeout, this, [this] { this->Refresh(); });
  self.ticks.start(Tick_ms);
  self.SetIcons();
  self.Show();
}

QSize TimelineWidget::minimumSizeHint() const {
  const Internals& self = *this->Impl_;
  return {self.wide + self.tools->minimumSize().width() - self.less,
          QWidget::minimumSizeHint().height()};
}

void TimelineWidget::resizeEvent(QResizeEvent* event) {
  QWidget::resizeEvent(event);
  const Internals& self = *this->Impl_;
  const bool wide = this->width() >= self.wide + self.tools->minimumSize().width();
  self.utc->setVisible(wide);
  self.j2000->setVisible(wide);
}

TimelineWidget::~TimelineWidget() {
  this->Impl_->ticks.stop();
  this->Impl_->writer.waitForDone();
}

void TimelineWidget::SetSource(std::shared_ptr<TimeSource> source) {
  Internals& self = *this->Impl_;
  self.source = std::move(source);
  self.state = {};
  self.eventsShown = false;
  self.shownTime.reset();
  self.meter.Reset();
  self.bar->SetEvents({}, {});
  self.bar->ShowAll();
  self.Show();
  this->Refresh();
}

const std::shared_ptr<TimeSource>& TimelineWidget::Source() const {
  return this->Impl_->source;
}

void TimelineWidget::SetMarksFile(const std::string& path) {
  Internals& self = *this->Impl_;
  self.marksFile = path;
  ++self.marksEpoch;
  self.SetMarks({});
  if (!path.empty()) {
    self.WithFile([path] { return LoadMarks(path); });
  }
}

const std::vector<TimelineMark>& TimelineWidget::Marks() const {
  return this->Impl_->marks;
}

void TimelineWidget::PutMark(const TimelineMark& mark) {
  Internals& self = *this->Impl_;
  if (!self.marksFile.empty()) { // shown when it is in the file
    self.WithFile([path = self.marksFile, mark] { return dspace::widgets::PutMark(path, mark); });
    return;
  }
  std::vector<TimelineMark> marks = self.marks;
  const auto same = std::find_if(marks.begin(), marks.end(),
                                 [&](const TimelineMark& old) { return old.id == mark.id; });
  if (same != marks.end()) {
    *same = mark;
  } else {
    marks.push_back(mark);
  }
  self.SetMarks(std::move(marks));
}

void TimelineWidget::EraseMark(const std::string& id) {
  Internals& self = *this->Impl_;
  if (!self.marksFile.empty()) {
    self.WithFile([path = self.marksFile, id] { return dspace::widgets::EraseMark(path, id); });
    return;
  }
  std::vector<TimelineMark> marks = self.marks;
  marks.erase(std::remove_if(marks.begin(), marks.end(),
                             [&](const TimelineMark& mark) { return mark.id == id; }),
              marks.end());
  self.SetMarks(std::move(marks));
}

std::optional<double> TimelineWidget::Rate() const {
  return this->Impl_->meter.Rate();
}

void TimelineWidget::Refresh(std::optional<double> wall_s) {
  Internals& self = *this->Impl_;
  if (!self.source) {
    return;
  }
  const double now =
      wall_s ? *wall_s
             : std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch())
                   .count();
  self.Try([&] { self.source->Advance(now); });
  self.state = self.source->GetState();
  if (self.shownTime && (self.state.time_s - *self.shownTime) * self.state.speed < 0.0) {
    self.meter.Reset(); // a loop begins again, or the simulation does
  }
  self.meter.Add(now, self.state.time_s);
  if (!self.eventsShown || self.source->EventsRevision() != self.eventsRevision) {
    self.eventsShown = true;
    self.eventsRevision = self.source->EventsRevision();
    self.bar->SetEvents(self.source->Events(), self.source->Gaps());
  }
  self.Show();
  if (self.shownTime != self.state.time_s) {
    self.shownTime = self.state.time_s;
    emit this->timeChanged(self.state.time_s);
  }
}

ScrubBar* TimelineWidget::Bar() const {
  return this->Impl_->bar;
}

KeyTrack* TimelineWidget::Keys() const {
  return this->Impl_->keys;
}

void TimelineWidget::AddTool(QWidget* tool) {
  this->Impl_->tools->addWidget(tool);
}

void TimelineWidget::keyPressEvent(QKeyEvent* event) {
  Internals& self = *this->Impl_;
  if (self.source) { // a key or a mark is made at the time of now, not of the last refresh
    self.state = self.source->GetState();
  }
  const bool seeks = self.source && self.state.canSeek && self.state.range;
  switch (event->key()) {
  case Qt::Key_Space:
    if (self.source && self.state.canPlay) {
      self.SwitchPlaying();
    }
    return;
  case Qt::Key_Left:
  case Qt::Key_Right:
    if (seeks) {
      self.Ask([&] { self.source->Step(event->key() == Qt::Key_Left ? -1 : 1); });
    }
    return;
  case Qt::Key_Home:
  case Qt::Key_End:
    if (seeks) {
      self.Ask([&] {
        self.source->Seek(event->key() == Qt::Key_Home ? self.state.range->begin
                                                       : self.state.range->end);
      });
    }
    return;
  case Qt::Key_BracketLeft:
  case Qt::Key_BracketRight:
    if (seeks) {
      self.SetLoopEnd(event->key() == Qt::Key_BracketLeft);
    }
    return;
  case Qt::Key_M:
    if (self.source && self.state.range) {
      self.EditMark({NewMarkId(), self.state.time_s, ""}, "New mark");
    }
    return;
  case Qt::Key_K:
    if (self.source && self.state.range && !self.keys->isHidden()) {
      emit self.keys->addAsked(self.state.time_s);
    }
    return;
  default:
    QWidget::keyPressEvent(event);
  }
}

void TimelineWidget::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange && this->Impl_) {
    this->Impl_->SetIcons();
  }
  QWidget::changeEvent(event);
}

} // namespace dspace::widgets
