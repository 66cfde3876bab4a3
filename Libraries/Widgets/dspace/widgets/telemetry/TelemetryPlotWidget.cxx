#include <dspace/widgets/telemetry/TelemetryPlotWidget.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <functional>
#include <limits>
#include <map>
#include <utility>
#include <vector>

#include <QApplication>
#include <QBuffer>
#include <QContextMenuEvent>
#include <QDragEnterEvent>
#include <QFileDialog>
#include <QHelpEvent>
#include <QInputDialog>
#include <QKeyEvent>
#include <QMenu>
#include <QMouseEvent>
#include <QPainter>
#include <QPixmap>
#include <QThreadPool>
#include <QTimer>
#include <QToolTip>
#include <QWheelEvent>

#include <dspace/AtomicFile.h>
#include <dspace/Checks.h>
#include <dspace/state/Telemetry.h>
#include <dspace/widgets/telemetry/ChannelMime.h>
#include <dspace/widgets/telemetry/PlotPicture.h>
#include <dspace/widgets/telemetry/PlotRanges.h>
#include <dspace/widgets/telemetry/SampleCsv.h>
#include <dspace/widgets/telemetry/SampleSeries.h>
#include <dspace/widgets/telemetry/SvgPaintDevice.h>

namespace dspace::widgets {
namespace {

constexpr int Tick_ms = 34;          // at most 30 times a second
constexpr int Message_ms = 8000;     // how long a failure is shown
constexpr double ZoomStep = 1.25;    // a notch of the wheel
constexpr double Grip = 5.0;         // to a line that is dragged
constexpr double TipDistance = 10.0; // to a sample

} // namespace

struct TelemetryPlotWidget::Internals {
  explicit Internals(TelemetryPlotWidget* owner) : widget(owner) {
    this->writer.setMaxThreadCount(1);
  }

  TelemetryPlotWidget* widget;
  PlotState state;
  PlotRanges ranges{this->state};
  std::size_t shownSamples = 0; // in all series, when ranges were last set

  TelemetrySource source;
  struct Channel { // of the source
    std::uint64_t id = 0;
    double time_s = std::numeric_limits<double>::quiet_NaN();
    double value = std::numeric_limits<double>::quiet_NaN();
  };
  std::map<QString, Channel> channels;
  const session::Telemetry* seen = nullptr; // only compared
  std::uint64_t revision = 0;

  QTimer ticks;
  QTimer click; // until it is no double click
  double clicked = 0.0;
  QString message;
  QTimer messageEnd;
  QThreadPool writer;
  std::atomic<bool> cancelled{false};

  // Of the ground: PlotPicture::PaintGround.
  std::unique_ptr<PlotPicture> picture;
  QPixmap ground;
  bool stale = true;

  enum class Drag { None, Pan, Rectangle, Current, CursorA, CursorB };
  Drag drag = Drag::None;
  QPointF pressed;
  QPointF last;
  bool moved = false;
  int dragAxis = -1;  // pan: of values alone
  bool dragX = false; // pan: along X alone
  int dropping = 0;   // 1: over the plot, 2: over X

  PlotPicture& Picture() {
    if (!this->picture) {
      this->picture = std::make_unique<PlotPicture>(this->state, QSizeF(this->widget->size()),
                                                    this->widget->font(), this->widget->palette(),
                                                    this->widget->devicePixelRatioF());
    }
    return *this->picture;
  }
  void Changed() { // anything of the ground
    this->stale = true;
    this->picture.reset();
    this->widget->update();
  }

  // --- Series ------------------------------------------------------------------------------------

  PlotSeries* Find(const QString& name) {
    const auto found = std::find_if(this->state.series.begin(), this->state.series.end(),
                                    [&](const PlotSeries& each) { return each.name == name; });
    return found == this->state.series.end() ? nullptr : &*found;
  }
  PlotValueAxis* FindAxis(const QString& unit) {
    for (PlotValueAxis& each : this->state.axes) {
      if (each.unit == unit) {
        return &each;
      }
    }
    return nullptr;
  }

  void Add(const QString& name, const QString& unit, std::shared_ptr<SampleSeries> samples,
           bool holds) {
    if (PlotSeries* there = this->Find(name)) {
      there->unit = unit;
      there->samples = std::move(samples);
      there->holds = holds;
      there->shown = true;
    } else {
      int color = 0;
      while (std::any_of(this->state.series.begin(), this->state.series.end(),
                         [&](const PlotSeries& each) { return each.color == color; })) {
        ++color;
      }
      this->state.series.push_back({name, unit, std::move(samples), holds, true, color});
    }
    this->SeriesChanged();
  }

  void SeriesChanged() {
    this->ranges.SeriesChanged();
    this->Changed();
    emit this->widget->seriesChanged();
  }

  // --- Ranges ------------------------------------------------------------------------------------

  void Zoom(const QPointF& place, double factor, bool alongX, int axis) {
    this->ranges.Zoom(this->Picture(), place, factor, alongX, axis);
    this->Changed();
  }
  void Pan(const QPointF& by, bool alongX, int axis) {
    this->ranges.Pan(this->Picture(), by, alongX, axis);
    this->Changed();
  }

  // --- The source --------------------------------------------------------------------------------

  // Samples of what has changed; true: there are some.
  bool Sample() {
    const session::Telemetry* telemetry = this->source ? this->source() : nullptr;
    if (!telemetry || (telemetry == this->seen && telemetry->Revision() == this->revision)) {
      return false;
    }
    this->seen = telemetry;
    this->revision = telemetry->Revision();
    bool any = false;
    for (auto& [name, known] : this->channels) {
      const session::Telemetry::Channel* channel = telemetry->Find(name.toStdString());
      PlotSeries* series = this->Find(name);
      if (!channel || !series || !channel->time_s ||
          channel->about.kind() == v1::CreateTelemetry::TEXT) {
        continue;
      }
      if (channel->about.id() == known.id && SameValue(*channel->time_s, known.time_s) &&
          SameValue(channel->value, known.value)) {
        continue;
      }
      SampleSeries& samples = *series->samples;
      if (!samples.IsEmpty() && *channel->time_s < samples.Time(samples.Size() - 1)) {
        samples.RemoveFrom(*channel->time_s);
      }
      samples.Append(*channel->time_s, channel->value);
      known = {channel->about.id(), *channel->time_s, channel->value};
      any = true;
    }
    return any;
  }
  // Also of samples that callers have appended.
  void Look() {
    bool any = false;
    this->Try([&] { any = this->Sample(); });
    std::size_t count = 0;
    for (const PlotSeries& each : this->state.series) {
      count += each.samples->Size();
    }
    if (any || count != this->shownSamples) {
      this->shownSamples = count;
      this->ranges.Follow();
      this->Changed();
    }
  }

  // --- Failures and files ------------------------------------------------------------------------

  void Tell(const QString& text) {
    this->message = text;
    this->messageEnd.start(Message_ms);
    this->widget->update();
    emit this->widget->failed(text);
  }
  template<class F> void Try(const F& f) {
    try {
      f();
    } catch (const std::exception& error) {
      this->Tell(QString::fromUtf8(error.what()));
    }
  }
  // Runs `write`, which throws or returns whether the file is there, in the writer's thread.
  void Write(const QString& path, std::function<bool(const std::string&)> write) {
    TelemetryPlotWidget* target = this->widget; // lives until the writer is done
    this->writer.start([this, target, path, write = std::move(write)] {
      QString failure;
      bool done = false;
      try {
        done = write(path.toStdString());
      } catch (const std::exception& error) {
        failure = QString::fromUtf8(error.what());
      }
      QMetaObject::invokeMethod(
          target,
          [this, path, failure, done] {
            if (!failure.isEmpty()) {
              this->Tell(failure);
            } else if (done) {
              emit this->widget->exported(path);
            }
          },
          Qt::QueuedConnection);
    });
  }
  void WriteBytes(const QString& path, const QByteArray& bytes) {
    this->Write(path, [bytes](const std::string& file) {
      AtomicFile::Save(file, bytes.constData(), std::size_t(bytes.size()));
      return true;
    });
  }
  void Ask(const QString& title, const QString& suffix,
           const std::function<void(const QString&)>& write) {
    QString path = QFileDialog::getSaveFileName(this->widget, title, "plot." + suffix,
                                                suffix.toUpper() + " (*." + suffix + ")");
    if (path.isEmpty()) {
      return;
    }
    write(path);
  }

  // --- The user's events -------------------------------------------------------------------------

  Drag LineAt(const QPointF& place) {
    if (this->state.series.empty() || this->state.XSeries() ||
        !this->Picture().Area().contains(place)) {
      return Drag::None;
    }
    const PlotMap map = this->Picture().MapOf(-1);
    const auto near = [&](const std::optional<double>& time_s) {
      return time_s && std::abs(map.At(*time_s, 0.0).x() - place.x()) <= Grip;
    };
    return near(this->state.cursors[0])   ? Drag::CursorA
           : near(this->state.cursors[1]) ? Drag::CursorB
           : near(this->state.current)    ? Drag::Current
                                          : Drag::None;
  }
  int AxisAt(const QPointF& place) {
    const auto& axes = this->Picture().Axes();
    for (std::size_t i = 0; i < axes.size(); ++i) {
      if (axes[i].area.contains(place)) {
        return int(i);
      }
    }
    return -1;
  }
  // The time at a place: in X-Y mode that of the nearest sample, if one is near.
  std::optional<double> TimeAt(const QPointF& place) {
    if (this->state.series.empty() || !this->Picture().Area().contains(place)) {
      return {};
    }
    if (!this->state.XSeries()) {
      return this->Picture().MapOf(-1).XAt(place.x());
    }
    const PlotPicture::Hit hit = this->Picture().Nearest(place, 3.0 * TipDistance);
    if (hit.series < 0) {
      return {};
    }
    return this->state.series[std::size_t(hit.series)].samples->Time(hit.sample);
  }
  void PutCursor(int cursor, const QPointF& place) {
    if (const std::optional<double> time_s = this->TimeAt(place)) {
      this->widget->SetCursor(cursor, time_s);
    }
  }

  QString TipAt(const QPointF& place) {
    if (this->state.series.empty()) {
      return {};
    }
    PlotPicture& shown = this->Picture();
    for (const auto& entry : shown.Legend()) {
      if (entry.area.contains(place)) {
        const PlotSeries& series = this->state.series[std::size_t(entry.series)];
        return series.Title() + "\n" + QString::number(series.samples->Size()) +
               " samples\nClick to " + (series.shown ? "hide" : "show");
      }
    }
    if (!shown.Area().contains(place)) {
      return {};
    }
    const PlotPicture::Hit hit = shown.Nearest(place, TipDistance);
    if (hit.series < 0) {
      return {};
    }
    const PlotSeries& series = this->state.series[std::size_t(hit.series)];
    const double time_s = series.samples->Time(hit.sample);
    QString text = series.name + "\n" + WithUnit(series.samples->Value(hit.sample), series.unit, 9);
    if (const PlotSeries* x = this->state.XSeries()) {
      text += "\n" + x->name + " " + WithUnit(x->samples->At(time_s, x->holds), x->unit, 9);
    }
    return text + "\nat " + WithUnit(time_s, "s", 15);
  }

  void Menu(const QPointF& place, const QPoint& global) {
    QMenu menu(this->widget);
    const bool any = !this->state.series.empty();
    const auto add = [&](QMenu& to, const QString& text, bool enabled,
                         const std::function<void()>& run) {
      QAction* action = to.addAction(text);
      action->setEnabled(enabled);
      QObject::connect(action, &QAction::triggered, this->widget, [this, run] { this->Try(run); });
      return action;
    };
    add(menu, "Show all", any, [this] { this->widget->ShowAll(); });
    add(menu, "Sliding window...", true, [this] {
      bool good = false;
      const double seconds = QInputDialog::getDouble(
          this->widget, "Sliding window", "Seconds that are shown while it follows; 0: all",
          this->ranges.Window(), 0.0, 1e9, 3, &good);
      if (good) {
        this->widget->SetWindow(seconds);
      }
    });
    menu.addSeparator();
    const bool here = this->TimeAt(place).has_value();
    add(menu, "Cursor A here", here, [this, place] { this->PutCursor(0, place); });
    add(menu, "Cursor B here", here, [this, place] { this->PutCursor(1, place); });
    add(menu, "Remove cursors", this->state.cursors[0] || this->state.cursors[1], [this] {
      this->widget->SetCursor(0, {});
      this->widget->SetCursor(1, {});
    });
    menu.addSeparator();
    QMenu& along = *menu.addMenu("Along X");
    QAction* time = add(along, "time", true, [this] { this->widget->SetXSeries(""); });
    time->setCheckable(true);
    time->setChecked(!this->state.XSeries());
    QMenu& remove = *menu.addMenu("Remove");
    for (const PlotSeries& each : this->state.series) {
      const QString name = each.name;
      QAction* action = add(along, name, true, [this, name] { this->widget->SetXSeries(name); });
      action->setCheckable(true);
      action->setChecked(&each == this->state.XSeries());
      add(remove, name, true, [this, name] { this->widget->RemoveSeries(name); });
    }
    remove.addSeparator();
    add(remove, "All", any, [this] { this->widget->RemoveAll(); });
    along.setEnabled(any);
    remove.setEnabled(any);
    menu.addSeparator();
    QMenu& save = *menu.addMenu("Export");
    save.setEnabled(any);
    add(save, "Table of all samples (CSV)...", any, [this] {
      this->Ask("Export samples", "csv",
                [this](const QString& path) { this->widget->ExportCsv(path); });
    });
    add(save, "Table of samples in view (CSV)...", any, [this] {
      this->Ask("Export samples in view", "csv",
                [this](const QString& path) { this->widget->ExportCsv(path, true); });
    });
    add(save, "Picture (PNG)...", any, [this] {
      this->Ask("Export picture", "png",
                [this](const QString& path) { this->widget->ExportPng(path, 2.0); });
    });
    add(save, "Picture (SVG)...", any, [this] {
      this->Ask("Export picture", "svg",
                [this](const QString& path) { this->widget->ExportSvg(path); });
    });
    menu.exec(global);
  }

  void MoveLine(const QPointF& place) {
    const PlotMap map = this->Picture().MapOf(-1);
    const double time_s = map.XAt(std::clamp(place.x(), map.area.left(), map.area.right()));
    if (this->drag == Drag::Current) {
      this->state.current = time_s;
      this->widget->update();
      emit this->widget->timeChosen(time_s);
    } else {
      this->widget->SetCursor(this->drag == Drag::CursorA ? 0 : 1, time_s);
    }
  }
};

TelemetryPlotWidget::TelemetryPlotWidget(QWidget* parent)
    : QWidget(parent), Impl_(std::make_unique<Internals>(this)) {
  Internals& self = *this->Impl_;
  this->setAttribute(Qt::WA_OpaquePaintEvent);
  this->setFocusPolicy(Qt::StrongFocus);
  this->setMouseTracking(true);
  this->setAcceptDrops(true);
  this->setAccessibleName("Plot");
  self.click.setSingleShot(true);
  connect(&self.click, &QTimer::timeout, this,
          [this] { emit this->timeChosen(this->Impl_->clicked); });
  self.messageEnd.setSingleShot(true);
  connect(&self.messageEnd, &QTimer::timeout, this, [this] {
    this->Impl_->message.clear();
    this->update();
  });
  connect(&self.ticks, &QTimer::timeout, this, [this] { this->Impl_->Look(); });
  self.ticks.start(Tick_ms);
}

TelemetryPlotWidget::~TelemetryPlotWidget() {
  this->Impl_->cancelled = true;
  this->Impl_->writer.waitForDone();
}

void TelemetryPlotWidget::SetSource(TelemetrySource source) {
  this->Impl_->source = std::move(source);
  this->Impl_->seen = nullptr;
}

void TelemetryPlotWidget::AddChannel(const QString& name) {
  Internals& self = *this->Impl_;
  const session::Telemetry* telemetry = self.source ? self.source() : nullptr;
  if (!telemetry) {
    throw Error(Error::Kind::NotFound, "telemetry '" + name.toStdString() + "'",
                "the plot has no source of telemetry");
  }
  const session::Telemetry::Channel& channel = telemetry->Get(name.toStdString());
  if (channel.about.kind() == v1::CreateTelemetry::TEXT) {
    Reject("telemetry '" + name.toStdString() + "'", "it is a text; accepted: numbers and choices");
  }
  if (self.channels.count(name) && self.Find(name)) {
    this->SetShown(name, true);
    return;
  }
  self.channels[name] = {};
  self.seen = nullptr;
  self.Add(name, QString::fromStdString(channel.about.unit()), std::make_shared<SampleSeries>(),
           true);
  self.Look();
}

void TelemetryPlotWidget::Refresh() {
  this->Impl_->Look();
}

void TelemetryPlotWidget::AddSeries(const QString& name, const QString& unit,
                                    std::shared_ptr<SampleSeries> samples, bool holds) {
  if (!samples) {
    Reject("series '" + name.toStdString() + "'", "it has no samples; accepted: a SampleSeries");
  }
  this->Impl_->channels.erase(name);
  this->Impl_->Add(name, unit, std::move(samples), holds);
}

void TelemetryPlotWidget::RemoveSeries(const QString& name) {
  Internals& self = *this->Impl_;
  self.channels.erase(name);
  auto& all = self.state.series;
  const auto end = std::remove_if(all.begin(), all.end(),
                                  [&](const PlotSeries& each) { return each.name == name; });
  if (end != all.end()) {
    all.erase(end, all.end());
    self.SeriesChanged();
  }
}

void TelemetryPlotWidget::RemoveAll() {
  Internals& self = *this->Impl_;
  self.channels.clear();
  self.state.series.clear();
  self.ranges.FollowAll();
  self.SeriesChanged();
}

QStringList TelemetryPlotWidget::Series() const {
  QStringList names;
  for (const PlotSeries& each : this->Impl_->state.series) {
    names += each.name;
  }
  return names;
}

std::shared_ptr<SampleSeries> TelemetryPlotWidget::Samples(const QString& name) const {
  const PlotSeries* series = this->Impl_->Find(name);
  return series ? series->samples : nullptr;
}

void TelemetryPlotWidget::SetShown(const QString& name, bool shown) {
  PlotSeries* series = this->Impl_->Find(name);
  if (series && series->shown != shown) {
    series->shown = shown;
    this->Impl_->SeriesChanged();
  }
}

bool TelemetryPlotWidget::IsShown(const QString& name) const {
  const PlotSeries* series = this->Impl_->Find(name);
  return series && series->shown;
}

void TelemetryPlotWidget::SetXSeries(const QString& name) {
  Internals& self = *this->Impl_;
  if (!name.isEmpty() && !self.Find(name)) {
    throw Error(Error::Kind::NotFound, "series '" + name.toStdString() + "'",
                "the plot has no such series");
  }
  if (name == self.state.xName) {
    return;
  }
  self.state.xName = name;
  self.ranges.FollowAll();
  self.SeriesChanged();
}

QString TelemetryPlotWidget::XSeries() const {
  return this->Impl_->state.xName;
}

void TelemetryPlotWidget::SetWindow(double seconds) {
  Require(std::isfinite(seconds) && seconds >= 0.0, "plot", "its window", seconds,
          "seconds, 0 for all");
  this->Impl_->ranges.SetWindow(seconds);
  this->ShowAll();
}

double TelemetryPlotWidget::Window() const {
  return this->Impl_->ranges.Window();
}

void TelemetryPlotWidget::ShowAll() {
  Internals& self = *this->Impl_;
  self.ranges.FollowAll();
  self.ranges.Follow();
  self.Changed();
}

bool TelemetryPlotWidget::IsFollowing() const {
  return this->Impl_->ranges.IsFollowing();
}

PlotRange TelemetryPlotWidget::XRange() const {
  return this->Impl_->state.XRange();
}

void TelemetryPlotWidget::SetXRange(const PlotRange& range) {
  this->Impl_->ranges.SetX(range);
  this->Impl_->Changed();
}

QStringList TelemetryPlotWidget::Units() const {
  QStringList units;
  for (const PlotValueAxis& each : this->Impl_->state.axes) {
    units += each.unit;
  }
  return units;
}

PlotRange TelemetryPlotWidget::ValueRange(const QString& unit) const {
  const PlotValueAxis* axis = this->Impl_->FindAxis(unit);
  return axis ? axis->range : PlotRange();
}

void TelemetryPlotWidget::SetValueRange(const QString& unit, const PlotRange& range) {
  if (PlotValueAxis* axis = this->Impl_->FindAxis(unit)) {
    this->Impl_->ranges.SetValues(*axis, range);
    this->Impl_->Changed();
  }
}

void TelemetryPlotWidget::SetCurrentTime(std::optional<double> time_s) {
  Internals& self = *this->Impl_;
  if (time_s) {
    RequireFinite("plot", "the current time", *time_s);
  }
  if (self.drag == Internals::Drag::Current || time_s == self.state.current) {
    return; // the user's hand is first
  }
  self.state.current = time_s;
  // Values that hold reach up to it.
  if (std::any_of(self.state.series.begin(), self.state.series.end(),
                  [](const PlotSeries& each) { return each.holds; })) {
    self.Changed();
  }
  this->update();
}

std::optional<double> TelemetryPlotWidget::CurrentTime() const {
  return this->Impl_->state.current;
}

void TelemetryPlotWidget::SetCursor(int cursor, std::optional<double> time_s) {
  Require(cursor == 0 || cursor == 1, "plot", "the number of a cursor", cursor, "0 and 1");
  if (time_s) {
    RequireFinite("plot", "the time of a cursor", *time_s);
  }
  auto& cursors = this->Impl_->state.cursors;
  const bool before = cursors[0] || cursors[1];
  cursors[std::size_t(cursor)] = time_s;
  if (before != (cursors[0] || cursors[1])) { // the read-outs come or go
    this->Impl_->Changed();
  }
  this->update();
}

std::optional<double> TelemetryPlotWidget::Cursor(int cursor) const {
  return cursor == 0 || cursor == 1 ? this->Impl_->state.cursors[std::size_t(cursor)]
                                    : std::optional<double>();
}

double TelemetryPlotWidget::ValueAt(const QString& name, double time_s) const {
  const PlotSeries* series = this->Impl_->Find(name);
  return series ? series->samples->At(time_s, series->holds)
                : std::numeric_limits<double>::quiet_NaN();
}

void TelemetryPlotWidget::ExportCsv(const QString& path, bool inView) {
  Internals& self = *this->Impl_;
  std::vector<CsvColumn> columns;
  for (const PlotSeries& each : self.state.series) {
    if (each.shown) {
      columns.push_back({each.Title().toStdString(), *each.samples});
    }
  }
  PlotRange times{-std::numeric_limits<double>::infinity(),
                  std::numeric_limits<double>::infinity()};
  if (inView) {
    times = self.state.XSeries() ? self.state.xTimes : self.state.time;
  }
  self.Write(path, [&cancelled = self.cancelled, columns = std::move(columns),
                    times](const std::string& file) {
    return WriteCsv(file, columns, times.low, times.high, [&] { return cancelled.load(); });
  });
}

void TelemetryPlotWidget::ExportPng(const QString& path, double scale) {
  Require(scale >= 0.1 && scale <= 8.0, "plot", "the scale of a picture", scale, "0.1 to 8");
  Internals& self = *this->Impl_;
  QImage image((QSizeF(this->size()) * scale).toSize().expandedTo({1, 1}), QImage::Format_RGB32);
  image.setDevicePixelRatio(scale);
  const PlotPicture picture(self.state, QSizeF(this->size()), this->font(), this->palette(), scale);
  QPainter painter(&image);
  picture.PaintGround(painter);
  picture.PaintMarks(painter);
  painter.end();
  image.setDevicePixelRatio(1.0);
  self.Write(path, [image](const std::string& file) {
    QByteArray bytes;
    QBuffer buffer(&bytes);
    buffer.open(QIODevice::WriteOnly);
    if (!image.save(&buffer, "PNG")) {
      throw Error(Error::Kind::Resource, "file '" + file + "'", "its picture cannot be encoded");
    }
    AtomicFile::Save(file, bytes.constData(), std::size_t(bytes.size()));
    return true;
  });
}

void TelemetryPlotWidget::ExportSvg(const QString& path) {
  Internals& self = *this->Impl_;
  SvgPaintDevice device(this->size(), this->Series().join(", "));
  // Two columns a unit: it may be shown larger.
  const PlotPicture picture(self.state, QSizeF(this->size()), this->font(), this->palette(), 2.0);
  QPainter painter(&device);
  picture.PaintGround(painter);
  picture.PaintMarks(painter);
  painter.end();
  self.WriteBytes(path, device.Document());
}

QRectF TelemetryPlotWidget::PlotArea() const {
  return this->Impl_->Picture().Area();
}

QRectF TelemetryPlotWidget::XAxisArea() const {
  return this->Impl_->Picture().XArea();
}

QRectF TelemetryPlotWidget::ValueAxisArea(const QString& unit) const {
  const auto& axes = this->Impl_->Picture().Axes();
  for (std::size_t i = 0; i < axes.size(); ++i) {
    if (this->Impl_->state.axes[i].unit == unit) {
      return axes[i].area;
    }
  }
  return {};
}

QRectF TelemetryPlotWidget::ReadoutArea() const {
  return this->Impl_->Picture().ReadoutArea();
}

QRectF TelemetryPlotWidget::LegendArea(const QString& name) const {
  for (const auto& entry : this->Impl_->Picture().Legend()) {
    if (this->Impl_->state.series[std::size_t(entry.series)].name == name) {
      return entry.area;
    }
  }
  return {};
}

std::optional<QPointF> TelemetryPlotWidget::PlaceOf(const QString& name, double time_s) const {
  const PlotSeries* series = this->Impl_->Find(name);
  return series ? this->Impl_->Picture().PlaceOf(*series, time_s) : std::optional<QPointF>();
}

QSize TelemetryPlotWidget::sizeHint() const {
  return {640, 360};
}

QSize TelemetryPlotWidget::minimumSizeHint() const {
  return {160, 120};
}

void TelemetryPlotWidget::paintEvent(QPaintEvent*) {
  Internals& self = *this->Impl_;
  const double ratio = this->devicePixelRatioF();
  const QSize pixels = (QSizeF(this->size()) * ratio).toSize().expandedTo({1, 1});
  if (self.stale || self.ground.size() != pixels) {
    if (self.ground.size() != pixels) { // another screen
      self.ground = QPixmap(pixels);
      self.picture.reset();
    }
    const PlotPicture& picture = self.Picture();
    self.ground.setDevicePixelRatio(ratio);
    QPainter painter(&self.ground);
    picture.PaintGround(painter);
    self.stale = false;
  }
  QPainter painter(this);
  painter.drawPixmap(0, 0, self.ground);
  self.Picture().PaintMarks(painter);
  painter.setFont(this->font());
  const QColor highlight = this->palette().color(QPalette::Highlight);
  const int line = this->fontMetrics().height();
  if (self.state.series.empty()) {
    painter.setPen(this->palette().color(QPalette::Disabled, QPalette::Text));
    painter.drawText(this->rect().adjusted(12, 12, -12, -12), Qt::AlignCenter | Qt::TextWordWrap,
                     "Drop channels here");
  }
  painter.setRenderHint(QPainter::Antialiasing, false);
  if (self.drag == Internals::Drag::Rectangle && self.moved) {
    const QRectF rectangle = QRectF(self.pressed, self.last).normalized() & self.Picture().Area();
    QColor fill = highlight;
    fill.setAlphaF(0.2F);
    painter.setPen(QPen(highlight, 1.0));
    painter.setBrush(fill);
    painter.drawRect(rectangle);
  }
  if (self.dropping != 0) {
    const QRectF target = self.state.series.empty() ? QRectF(this->rect())
                          : self.dropping == 2      ? self.Picture().XArea()
                                                    : self.Picture().Area();
    painter.setPen(QPen(highlight, 2.0));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(target.adjusted(1.0, 1.0, -1.0, -1.0));
  }
  if (!self.message.isEmpty()) {
    const QRect room = this->rect().adjusted(8, 8, -8, -8);
    QRect box = this->fontMetrics()
                    .boundingRect(room.adjusted(6, 4, -6, -4), Qt::AlignLeft | Qt::TextWordWrap,
                                  self.message)
                    .adjusted(-6, -4, 6, 4);
    box.moveTop(std::max(room.top(), room.bottom() - box.height() - line));
    painter.setPen(QPen(highlight, 1.0));
    painter.setBrush(this->palette().color(QPalette::ToolTipBase));
    painter.drawRect(box);
    painter.setPen(this->palette().color(QPalette::ToolTipText));
    painter.drawText(box.adjusted(6, 4, -6, -4), Qt::AlignLeft | Qt::TextWordWrap, self.message);
  }
  if (this->hasFocus()) {
    QColor focus = highlight;
    focus.setAlphaF(0.6F);
    painter.setPen(QPen(focus, 1.0));
    painter.setBrush(Qt::NoBrush);
    painter.drawRect(this->rect().adjusted(0, 0, -1, -1));
  }
}

void TelemetryPlotWidget::resizeEvent(QResizeEvent*) {
  this->Impl_->Changed();
}

void TelemetryPlotWidget::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange ||
      event->type() == QEvent::StyleChange) {
    this->Impl_->Changed();
  }
  QWidget::changeEvent(event);
}

void TelemetryPlotWidget::wheelEvent(QWheelEvent* event) {
  Internals& self = *this->Impl_;
  event->accept();
  // With Alt, and on some systems with Shift, the wheel turns along the other axis.
  const QPoint turn = event->angleDelta();
  const double notches = (turn.y() != 0 ? turn.y() : turn.x()) / 120.0;
  if (notches == 0.0 || self.state.series.empty()) {
    return;
  }
  const QPointF place = event->position();
  const double factor = std::pow(ZoomStep, -notches);
  const int axis = self.AxisAt(place);
  if (axis >= 0) {
    self.Zoom(place, factor, false, axis);
  } else if (self.Picture().XArea().contains(place)) {
    self.Zoom(place, factor, true, PlotRanges::NoAxis);
  } else if (self.Picture().Area().contains(place)) {
    const bool onlyX = event->modifiers().testFlag(Qt::ControlModifier);
    const bool onlyValues = event->modifiers().testFlag(Qt::ShiftModifier);
    self.Zoom(place, factor, !onlyValues || onlyX,
              onlyX ? PlotRanges::NoAxis : PlotRanges::AllAxes);
  }
}

void TelemetryPlotWidget::mousePressEvent(QMouseEvent* event) {
  Internals& self = *this->Impl_;
  if (self.drag != Internals::Drag::None || self.state.series.empty()) {
    return;
  }
  const QPointF place = event->position();
  self.pressed = self.last = place;
  self.moved = false;
  if (event->button() == Qt::RightButton) {
    self.drag = Internals::Drag::Rectangle;
  } else if (event->button() == Qt::LeftButton || event->button() == Qt::MiddleButton) {
    const Internals::Drag line =
        event->button() == Qt::LeftButton ? self.LineAt(place) : Internals::Drag::None;
    self.drag = line != Internals::Drag::None ? line : Internals::Drag::Pan;
    self.dragAxis = self.AxisAt(place);
    self.dragX = self.Picture().XArea().contains(place);
  }
}

void TelemetryPlotWidget::mouseMoveEvent(QMouseEvent* event) {
  Internals& self = *this->Impl_;
  const QPointF place = event->position();
  if (self.drag == Internals::Drag::None) {
    const bool line = self.LineAt(place) != Internals::Drag::None;
    this->setCursor(line ? Qt::SizeHorCursor : Qt::ArrowCursor);
    return;
  }
  if (!self.moved &&
      (place - self.pressed).manhattanLength() < QApplication::startDragDistance() / 2.0) {
    return;
  }
  self.moved = true;
  switch (self.drag) {
  case Internals::Drag::Pan:
    if (self.dragAxis >= 0) {
      self.Pan(place - self.last, false, self.dragAxis);
    } else {
      self.Pan(place - self.last, true,
               self.dragX || self.state.axes.empty() ? PlotRanges::NoAxis : PlotRanges::AllAxes);
    }
    this->setCursor(Qt::ClosedHandCursor);
    break;
  case Internals::Drag::Rectangle:
    this->update();
    break;
  default:
    self.MoveLine(place);
    break;
  }
  self.last = place;
}

void TelemetryPlotWidget::mouseReleaseEvent(QMouseEvent* event) {
  Internals& self = *this->Impl_;
  const Internals::Drag drag = self.drag;
  const bool right = drag == Internals::Drag::Rectangle;
  if (drag == Internals::Drag::None || right != (event->button() == Qt::RightButton)) {
    return;
  }
  const QPointF place = event->position();
  self.drag = Internals::Drag::None;
  this->setCursor(Qt::ArrowCursor);
  if (right) {
    if (self.moved) {
      if (self.ranges.ZoomTo(self.Picture(), QRectF(self.pressed, place).normalized())) {
        self.Changed();
      }
      this->update(); // without the rectangle
    } else {
      self.Menu(place, event->globalPosition().toPoint());
    }
    return;
  }
  if (self.moved || event->button() != Qt::LeftButton) {
    return;
  }
  for (const auto& entry : self.Picture().Legend()) {
    if (entry.area.contains(place)) {
      const QString name = self.state.series[std::size_t(entry.series)].name;
      this->SetShown(name, !this->IsShown(name));
      return;
    }
  }
  if (const std::optional<double> time_s = self.TimeAt(place)) {
    self.clicked = *time_s;
    self.click.start(QApplication::doubleClickInterval());
  }
}

void TelemetryPlotWidget::mouseDoubleClickEvent(QMouseEvent* event) {
  Internals& self = *this->Impl_;
  if (event->button() != Qt::LeftButton) {
    this->mousePressEvent(event);
    return;
  }
  self.click.stop();
  for (const auto& entry : self.Picture().Legend()) {
    if (entry.area.contains(event->position())) { // two clicks
      const QString name = self.state.series[std::size_t(entry.series)].name;
      this->SetShown(name, !this->IsShown(name));
      return;
    }
  }
  this->ShowAll();
}

void TelemetryPlotWidget::keyPressEvent(QKeyEvent* event) {
  Internals& self = *this->Impl_;
  if (self.state.series.empty()) {
    QWidget::keyPressEvent(event);
    return;
  }
  const QRectF area = self.Picture().Area();
  QPointF place = this->mapFromGlobal(QPointF(QCursor::pos()));
  if (!area.contains(place)) {
    place = area.center();
  }
  const double step = 0.1;
  switch (event->key()) {
  case Qt::Key_A:
    self.PutCursor(0, place);
    break;
  case Qt::Key_B:
    self.PutCursor(1, place);
    break;
  case Qt::Key_Escape:
    if (self.drag != Internals::Drag::None) {
      self.drag = Internals::Drag::None;
      this->setCursor(Qt::ArrowCursor);
      this->update();
    } else {
      this->SetCursor(0, {});
      this->SetCursor(1, {});
    }
    break;
  case Qt::Key_Home:
    this->ShowAll();
    break;
  case Qt::Key_Plus:
  case Qt::Key_Equal:
    self.Zoom(place, 1.0 / ZoomStep, true, PlotRanges::AllAxes);
    break;
  case Qt::Key_Minus:
    self.Zoom(place, ZoomStep, true, PlotRanges::AllAxes);
    break;
  case Qt::Key_Left:
    self.Pan({step * area.width(), 0.0}, true, PlotRanges::NoAxis);
    break;
  case Qt::Key_Right:
    self.Pan({-step * area.width(), 0.0}, true, PlotRanges::NoAxis);
    break;
  case Qt::Key_Up:
    self.Pan({0.0, step * area.height()}, false, PlotRanges::AllAxes);
    break;
  case Qt::Key_Down:
    self.Pan({0.0, -step * area.height()}, false, PlotRanges::AllAxes);
    break;
  default:
    QWidget::keyPressEvent(event);
    break;
  }
}

void TelemetryPlotWidget::dragEnterEvent(QDragEnterEvent* event) {
  if (!ChannelsOf(event->mimeData()).isEmpty()) {
    event->setDropAction(Qt::CopyAction);
    event->accept();
    this->Impl_->dropping = 1;
    this->update();
  }
}

void TelemetryPlotWidget::dragMoveEvent(QDragMoveEvent* event) {
  Internals& self = *this->Impl_;
  const bool onX = !self.state.series.empty() && self.Picture().XArea().contains(event->position());
  self.dropping = onX ? 2 : 1;
  event->setDropAction(Qt::CopyAction);
  event->accept();
  this->update();
}

void TelemetryPlotWidget::dragLeaveEvent(QDragLeaveEvent*) {
  this->Impl_->dropping = 0;
  this->update();
}

void TelemetryPlotWidget::dropEvent(QDropEvent* event) {
  Internals& self = *this->Impl_;
  const QStringList names = ChannelsOf(event->mimeData());
  const bool onX = !self.state.series.empty() && self.Picture().XArea().contains(event->position());
  self.dropping = 0;
  this->update();
  if (names.isEmpty()) {
    return;
  }
  event->setDropAction(Qt::CopyAction);
  event->accept();
  for (const QString& name : names) {
    const session::Telemetry* telemetry = self.source ? self.source() : nullptr;
    if (!telemetry || !telemetry->Find(name.toStdString())) {
      emit this->channelDropped(name);
    } else {
      self.Try([&] { this->AddChannel(name); });
    }
  }
  if (onX && self.Find(names.front())) {
    self.Try([&] { this->SetXSeries(names.front()); });
  }
}

bool TelemetryPlotWidget::event(QEvent* event) {
  if (event->type() == QEvent::ToolTip) {
    const auto& help = static_cast<const QHelpEvent&>(*event);
    const QString text = this->Impl_->TipAt(QPointF(help.pos()));
    if (text.isEmpty()) {
      QToolTip::hideText();
    } else {
      QToolTip::showText(help.globalPos(), text, this);
    }
    return true;
  }
  return QWidget::event(event);
}

} // namespace dspace::widgets
