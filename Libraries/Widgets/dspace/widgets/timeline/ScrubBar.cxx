#include <dspace/widgets/timeline/ScrubBar.h>

#include <algorithm>
#include <cmath>
#include <optional>
#include <utility>

#include <QContextMenuEvent>
#include <QHelpEvent>
#include <QMenu>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>
#include <QPixmap>
#include <QToolTip>
#include <QWheelEvent>

#include <dspace/overlay/RoundNumbers.h>
#include <dspace/widgets/timeline/TimeTexts.h>

namespace dspace::widgets {
namespace {

constexpr int Side = 14; // pixels left and right of the bar
constexpr int MarkLane = 16;
constexpr int BarHeight = 14;
constexpr int TickHeight = 5;
constexpr double MarkReach = 6.0; // pixels from what is meant
constexpr int MostTexts = 6;      // of a tool tip

QColor ColorOf(TimelineEvent::Severity severity) {
  switch (severity) {
  case TimelineEvent::Severity::Caution:
    return {0xe0, 0xa8, 0x00};
  case TimelineEvent::Severity::Warning:
    return {0xe8, 0x6c, 0x0a};
  case TimelineEvent::Severity::Alarm:
    return {0xd9, 0x30, 0x2b};
  case TimelineEvent::Severity::Info:
    break;
  }
  return {0x3d, 0x8f, 0xd9};
}
const QColor MarkColor(0x8e, 0x5b, 0xd0);

QColor Between(const QColor& a, const QColor& b, double share) {
  return QColor::fromRgbF(float(a.redF() + share * (b.redF() - a.redF())),
                          float(a.greenF() + share * (b.greenF() - a.greenF())),
                          float(a.blueF() + share * (b.blueF() - a.blueF())));
}

} // namespace

struct ScrubBar::Internals {
  enum class Drag { None, Scrub, Pan, Loop };

  ScrubBar* widget = nullptr;
  TimeSource::State state;
  std::vector<TimelineEvent> events; // by time
  std::vector<TimeRange> gaps;
  std::vector<TimelineMark> marks;
  std::optional<TimeRange> zoom; // none: the whole range
  Drag drag = Drag::None;
  double dragFrom = 0.0; // time of the other end of the loop; x of panning
  QPixmap drawn;         // all but the present time
  bool outdated = true;
  int drawings = 0;

  TimeRange View() const {
    TimeRange view = this->zoom ? *this->zoom : this->state.range.value_or(TimeRange{0.0, 1.0});
    // A range of no length, and times that doubles hardly tell apart.
    const double least = std::max(1e-3, 1e-12 * std::max(std::abs(view.begin), std::abs(view.end)));
    if (view.Length() < least) {
      view.end = view.begin + least;
    }
    return view;
  }
  double Width() const { return std::max(1, this->widget->width() - 2 * Side); }
  double X(double time_s) const {
    const TimeRange view = this->View();
    return Side + (time_s - view.begin) / view.Length() * this->Width();
  }
  double Time(double x) const {
    const TimeRange view = this->View();
    return view.begin + (x - Side) / this->Width() * view.Length();
  }
  bool InView(double x) const { return x >= Side - 0.5 && x <= Side + this->Width() + 0.5; }
  double Zero() const { return this->state.range ? this->state.range->begin : 0.0; }
  QRectF Bar() const { return {double(Side), double(MarkLane), this->Width(), double(BarHeight)}; }

  void SetZoom(const TimeRange& wanted) {
    const TimeRange all = this->state.range.value_or(TimeRange{0.0, 1.0});
    TimeRange view = wanted;
    const double least = std::max(1e-3, 1e-9 * std::max(std::abs(all.begin), std::abs(all.end)));
    if (view.Length() < least) {
      const double middle = 0.5 * (view.begin + view.end);
      view = {middle - 0.5 * least, middle + 0.5 * least};
    }
    if (view.Length() >= all.Length()) {
      this->zoom.reset();
    } else {
      const double shift =
          std::max(all.begin - view.begin, 0.0) - std::max(view.end - all.end, 0.0);
      this->zoom = TimeRange{view.begin + shift, view.end + shift};
    }
    this->Outdate();
  }
  void Outdate() {
    this->outdated = true;
    this->widget->update();
    emit this->widget->viewChanged();
  }

  // Events from the first to the last one (not included) near a place.
  std::pair<std::size_t, std::size_t> EventsNear(double x) const {
    const auto before = [](const TimelineEvent& event, double time_s) {
      return event.time_s < time_s;
    };
    const auto first = std::lower_bound(this->events.begin(), this->events.end(),
                                        this->Time(x - MarkReach), before);
    const auto last =
        std::lower_bound(first, this->events.end(), this->Time(x + MarkReach), before);
    return {std::size_t(first - this->events.begin()), std::size_t(last - this->events.begin())};
  }
  const TimelineMark* MarkNear(double x) const {
    const TimelineMark* nearest = nullptr;
    double distance = MarkReach;
    for (const TimelineMark& mark : this->marks) {
      if (std::abs(this->X(mark.time_s) - x) <= distance) {
        distance = std::abs(this->X(mark.time_s) - x);
        nearest = &mark;
      }
    }
    return nearest;
  }
  // The time of the mark, else of the event, near a place in their lane.
  std::optional<double> PlaceNear(const QPointF& place) const {
    if (place.y() > MarkLane) {
      return {};
    }
    if (const TimelineMark* mark = this->MarkNear(place.x())) {
      return mark->time_s;
    }
    const auto [first, last] = this->EventsNear(place.x());
    std::optional<double> time_s;
    for (std::size_t i = first; i < last; ++i) {
      if (!time_s || std::abs(this->X(this->events[i].time_s) - place.x()) <
                         std::abs(this->X(*time_s) - place.x())) {
        time_s = this->events[i].time_s;
      }
    }
    return time_s;
  }
  // The end of the loop that a press at a place drags; returns the other end.
  std::optional<double> LoopEndNear(const QPointF& place) const {
    if (!this->state.loop || place.y() <= MarkLane) {
      return {};
    }
    const double toBegin = std::abs(this->X(this->state.loop->begin) - place.x());
    const double toEnd = std::abs(this->X(this->state.loop->end) - place.x());
    if (std::min(toBegin, toEnd) > MarkReach) {
      return {};
    }
    return toBegin < toEnd ? this->state.loop->end : this->state.loop->begin;
  }

  void DrawTicks(QPainter& painter, const QPalette& palette) const {
    const TimeRange view = this->View();
    const QFontMetrics metrics(painter.font());
    const double low = view.begin - this->Zero();
    const double high = view.end - this->Zero();
    // As many as the labels leave room for; labels of finer steps are longer.
    int count = std::max(2, int(this->Width() / 50.0));
    double step = 0.0;
    for (; count >= 1; count = count * 3 / 4) {
      step = TimeStep(low, high, std::max(count, 1));
      const int widest =
          std::max(metrics.horizontalAdvance(QString::fromStdString(TickText(high, step))),
                   metrics.horizontalAdvance(QString::fromStdString(TickText(low, step))));
      if (step / view.Length() * this->Width() > widest + 14 || count == 1) {
        break;
      }
    }
    const double top = MarkLane + BarHeight;
    painter.setPen(
        Between(palette.color(QPalette::WindowText), palette.color(QPalette::Window), 0.6));
    double fine = step / 5.0;
    if (fine / view.Length() * this->Width() > 5.0) {
      for (const double time : Multiples(fine, low, high)) {
        const double x = this->X(time + this->Zero());
        painter.drawLine(QPointF(x, top + 1), QPointF(x, top + 3));
      }
    }
    for (const double time : Multiples(step, low, high)) {
      const double x = this->X(time + this->Zero());
      painter.setPen(
          Between(palette.color(QPalette::WindowText), palette.color(QPalette::Window), 0.45));
      painter.drawLine(QPointF(x, top + 1), QPointF(x, top + TickHeight));
      const QString text = QString::fromStdString(TickText(time, step));
      const double width = metrics.horizontalAdvance(text);
      const double left =
          std::clamp(x - 0.5 * width, 0.0, std::max(0.0, this->widget->width() - width));
      painter.setPen(
          Between(palette.color(QPalette::WindowText), palette.color(QPalette::Window), 0.2));
      painter.drawText(QPointF(left, top + TickHeight + 1 + metrics.ascent()), text);
    }
  }

  void DrawEvents(QPainter& painter) const {
    // The gravest event of each pixel, so that thousands cost what a few do.
    std::vector<int> columns(std::size_t(this->Width()) + 1, -1);
    for (const TimelineEvent& event : this->events) {
      const double x = this->X(event.time_s);
      if (this->InView(x)) {
        int& column = columns[std::size_t(std::clamp(x - Side, 0.0, this->Width()))];
        column = std::max(column, int(event.severity));
      }
    }
    painter.setPen(Qt::NoPen);
    for (const int severity : {0, 1, 2, 3}) { // graver ones over the others
      painter.setBrush(ColorOf(TimelineEvent::Severity(severity)));
      for (std::size_t column = 0; column < columns.size(); ++column) {
        if (columns[column] == severity) {
          const double x = Side + double(column) + 0.5;
          painter.drawPolygon(QPolygonF({{x, MarkLane - 11.0},
                                         {x + 4.0, MarkLane - 6.5},
                                         {x, MarkLane - 2.0},
                                         {x - 4.0, MarkLane - 6.5}}));
        }
      }
    }
  }

  void DrawMarks(QPainter& painter) const {
    for (const TimelineMark& mark : this->marks) {
      const double x = this->X(mark.time_s);
      if (this->InView(x)) {
        painter.setPen(QPen(MarkColor, 1.4));
        painter.drawLine(QPointF(x, 1.0), QPointF(x, MarkLane + BarHeight));
        painter.setPen(Qt::NoPen);
        painter.setBrush(MarkColor);
        painter.drawPolygon(QPolygonF({{x, 1.0}, {x + 9.0, 4.5}, {x, 8.0}}));
      }
    }
  }

  void Draw() {
    const double ratio = this->widget->devicePixelRatioF();
    this->drawn = QPixmap(this->widget->size() * ratio);
    this->drawn.setDevicePixelRatio(ratio);
    const QPalette& palette = this->widget->palette();
    this->drawn.fill(palette.color(QPalette::Window));
    QPainter painter(&this->drawn);
    painter.setFont(this->widget->font());
    painter.setRenderHint(QPainter::Antialiasing);
    const QRectF bar = this->Bar();
    painter.setPen(Qt::NoPen);
    painter.setBrush(palette.color(QPalette::Base));
    painter.drawRoundedRect(bar, 3, 3);
    if (!this->state.range) {
      painter.setPen(palette.color(QPalette::PlaceholderText));
      painter.drawText(
          QRectF(bar.left(), bar.bottom(), bar.width(), this->widget->height() - bar.bottom()),
          Qt::AlignCenter, "No times yet");
      ++this->drawings;
      this->outdated = false;
      return;
    }
    painter.save();
    painter.setClipRect(bar);
    for (const TimeRange& gap : this->gaps) {
      painter.fillRect(
          QRectF(QPointF(this->X(gap.begin), bar.top()), QPointF(this->X(gap.end), bar.bottom())),
          QBrush(palette.color(QPalette::Disabled, QPalette::WindowText), Qt::BDiagPattern));
    }
    if (this->state.loop) {
      QColor color = palette.color(QPalette::Highlight);
      const QRectF loop(QPointF(this->X(this->state.loop->begin), bar.top()),
                        QPointF(this->X(this->state.loop->end), bar.bottom()));
      color.setAlphaF(0.35f);
      painter.fillRect(loop, color);
      color.setAlphaF(1.0f);
      painter.fillRect(QRectF(loop.left(), bar.top(), 2.5, bar.height()), color);
      painter.fillRect(QRectF(loop.right() - 2.5, bar.top(), 2.5, bar.height()), color);
    }
    painter.restore();
    painter.setPen(
        Between(palette.color(QPalette::WindowText), palette.color(QPalette::Window), 0.65));
    painter.setBrush(Qt::NoBrush);
    painter.drawRoundedRect(bar.adjusted(0.5, 0.5, -0.5, -0.5), 3, 3);
    this->DrawTicks(painter, palette);
    this->DrawEvents(painter);
    this->DrawMarks(painter);
    ++this->drawings;
    this->outdated = false;
  }
};

ScrubBar::ScrubBar(QWidget* parent) : QWidget(parent), Impl_(std::make_unique<Internals>()) {
  this->Impl_->widget = this;
  this->setMouseTracking(true);
  this->setAttribute(Qt::WA_OpaquePaintEvent);
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  this->setAccessibleName("Timeline");
}

ScrubBar::~ScrubBar() = default;

void ScrubBar::SetState(const TimeSource::State& state) {
  Internals& self = *this->Impl_;
  const TimeSource::State before = std::exchange(self.state, state);
  if (before.range != state.range || before.loop != state.loop) {
    if (self.zoom) {
      self.SetZoom(*self.zoom);
    }
    self.Outdate();
  }
  if (self.zoom && state.playing && self.drag == Internals::Drag::None &&
      !self.zoom->Contains(state.time_s)) { // the view follows what plays
    const double length = self.zoom->Length();
    self.SetZoom({state.time_s - 0.1 * length, state.time_s + 0.9 * length});
  }
  if (std::lround(4.0 * self.X(before.time_s)) != std::lround(4.0 * self.X(state.time_s))) {
    this->update();
  }
}

void ScrubBar::SetEvents(std::vector<TimelineEvent> events, std::vector<TimeRange> gaps) {
  this->Impl_->events = std::move(events);
  this->Impl_->gaps = std::move(gaps);
  this->Impl_->Outdate();
}

void ScrubBar::SetMarks(std::vector<TimelineMark> marks) {
  this->Impl_->marks = std::move(marks);
  this->Impl_->Outdate();
}

TimeRange ScrubBar::View() const {
  return this->Impl_->View();
}

void ScrubBar::ShowAll() {
  this->Impl_->zoom.reset();
  this->Impl_->Outdate();
}

double ScrubBar::TimeAt(double x) const {
  const double time_s = this->Impl_->Time(x);
  const auto& range = this->Impl_->state.range;
  return range ? std::clamp(time_s, range->begin, range->end) : time_s;
}

double ScrubBar::PlaceOf(double time_s) const {
  return this->Impl_->X(time_s);
}

QString ScrubBar::TextAt(const QPoint& place) const {
  const Internals& self = *this->Impl_;
  if (!self.state.range) {
    return {};
  }
  QStringList lines;
  int more = 0;
  const auto time = [&](double time_s) {
    return QString::fromStdString(ElapsedText(time_s - self.Zero()));
  };
  const auto add = [&](const QString& line) {
    if (lines.size() < MostTexts) {
      lines << line;
    } else {
      ++more;
    }
  };
  for (const TimelineMark& mark : self.marks) {
    if (std::abs(self.X(mark.time_s) - place.x()) <= MarkReach) {
      add(QString("%1  Mark: %2").arg(time(mark.time_s), QString::fromStdString(mark.note)));
    }
  }
  const auto [first, last] = self.EventsNear(place.x());
  for (std::size_t i = first; i < last; ++i) {
    const TimelineEvent& event = self.events[i];
    add(QString("%1  %2: %3")
            .arg(time(event.time_s), QString::fromStdString(event.kind),
                 QString::fromStdString(event.text)));
  }
  if (more > 0) {
    lines << QString("and %1 more").arg(more);
  }
  if (lines.isEmpty()) {
    const double at = this->TimeAt(place.x());
    lines << time(at);
    for (const TimeRange& gap : self.gaps) {
      if (gap.Contains(at)) {
        lines << "Lost: the recording has no commands here";
      }
    }
    if (self.state.j2000) {
      lines << QString::fromStdString(UtcText(at));
    }
  }
  return lines.join("\n");
}

int ScrubBar::Drawings() const {
  return this->Impl_->drawings;
}

QSize ScrubBar::sizeHint() const {
  return {480, MarkLane + BarHeight + TickHeight + 4 + QFontMetrics(this->font()).height()};
}

QSize ScrubBar::minimumSizeHint() const {
  return {120, this->sizeHint().height()};
}

void ScrubBar::paintEvent(QPaintEvent*) {
  Internals& self = *this->Impl_;
  if (self.outdated || self.drawn.devicePixelRatio() != this->devicePixelRatioF()) {
    self.Draw();
  }
  QPainter painter(this);
  painter.drawPixmap(0, 0, self.drawn);
  const double x = self.X(self.state.time_s);
  if (!self.state.range || !self.InView(x)) {
    return;
  }
  painter.setRenderHint(QPainter::Antialiasing);
  const QColor color = this->palette().color(QPalette::WindowText);
  painter.setPen(QPen(color, 1.6));
  painter.drawLine(QPointF(x, MarkLane - 2.0), QPointF(x, MarkLane + BarHeight + 1.0));
  painter.setPen(QPen(this->palette().color(QPalette::Window), 1.0));
  painter.setBrush(color);
  const double y = MarkLane + 0.5 * BarHeight;
  painter.drawEllipse(QPointF(x, y), 5.5, 5.5);
}

void ScrubBar::resizeEvent(QResizeEvent*) {
  this->Impl_->Outdate();
}

void ScrubBar::changeEvent(QEvent* event) {
  if (event->type() == QEvent::PaletteChange || event->type() == QEvent::FontChange) {
    this->Impl_->Outdate();
  }
  QWidget::changeEvent(event);
}

void ScrubBar::mousePressEvent(QMouseEvent* event) {
  Internals& self = *this->Impl_;
  const QPointF place = event->position();
  if (!self.state.range) {
    return;
  }
  if (event->button() == Qt::MiddleButton) {
    self.drag = Internals::Drag::Pan;
    self.dragFrom = place.x();
  } else if (event->button() == Qt::LeftButton && self.state.canSeek) {
    const std::optional<double> otherEnd = self.LoopEndNear(place);
    if (event->modifiers().testFlag(Qt::ShiftModifier) || otherEnd) {
      self.drag = Internals::Drag::Loop;
      self.dragFrom = otherEnd.value_or(this->TimeAt(place.x()));
      return;
    }
    self.drag = Internals::Drag::Scrub;
    const std::optional<double> exactly = self.PlaceNear(place);
    emit this->scrubbed(exactly ? *exactly : this->TimeAt(place.x()));
  }
}

void ScrubBar::mouseMoveEvent(QMouseEvent* event) {
  Internals& self = *this->Impl_;
  const QPointF place = event->position();
  switch (self.drag) {
  case Internals::Drag::Scrub:
    emit this->scrubbed(this->TimeAt(place.x()));
    break;
  case Internals::Drag::Pan: {
    const double moved = (self.dragFrom - place.x()) / self.Width() * self.View().Length();
    if (self.zoom) {
      self.SetZoom({self.zoom->begin + moved, self.zoom->end + moved});
    }
    self.dragFrom = place.x();
    break;
  }
  case Internals::Drag::Loop: {
    const double time_s = this->TimeAt(place.x());
    if (std::abs(self.X(time_s) - self.X(self.dragFrom)) >= 2.0) {
      emit this->loopChosen(std::min(time_s, self.dragFrom), std::max(time_s, self.dragFrom));
    }
    break;
  }
  case Internals::Drag::None:
    this->setCursor(self.LoopEndNear(place) ? Qt::SizeHorCursor
                    : self.PlaceNear(place) ? Qt::PointingHandCursor
                                            : Qt::ArrowCursor);
    break;
  }
}

void ScrubBar::mouseReleaseEvent(QMouseEvent*) {
  this->Impl_->drag = Internals::Drag::None;
}

void ScrubBar::mouseDoubleClickEvent(QMouseEvent* event) {
  if (event->button() == Qt::LeftButton && event->position().y() <= MarkLane) {
    if (const TimelineMark* mark = this->Impl_->MarkNear(event->position().x())) {
      emit this->markOpened(QString::fromStdString(mark->id));
    }
  }
}

void ScrubBar::wheelEvent(QWheelEvent* event) {
  Internals& self = *this->Impl_;
  if (!self.state.range) {
    return;
  }
  const TimeRange view = self.View();
  const QPoint turned = event->angleDelta();
  if (turned.x() != 0) {
    const double moved = -turned.x() / 1200.0 * view.Length();
    self.SetZoom({view.begin + moved, view.end + moved});
  }
  if (turned.y() != 0) {
    const double factor = std::pow(0.8, turned.y() / 120.0);
    const double fixed =
        self.Time(std::clamp(event->position().x(), double(Side), Side + self.Width()));
    self.SetZoom({fixed + (view.begin - fixed) * factor, fixed + (view.end - fixed) * factor});
  }
  event->accept();
}

void ScrubBar::contextMenuEvent(QContextMenuEvent* event) {
  Internals& self = *this->Impl_;
  if (!self.state.range) {
    return;
  }
  auto* menu = new QMenu(this);
  menu->setAttribute(Qt::WA_DeleteOnClose);
  const bool byKey = event->reason() == QContextMenuEvent::Keyboard;
  const double time_s = byKey ? self.state.time_s : this->TimeAt(event->pos().x());
  const QPoint place = byKey ? QPoint(int(self.X(time_s)), MarkLane) : event->pos();
  if (const TimelineMark* mark = self.MarkNear(place.x())) {
    const QString id = QString::fromStdString(mark->id);
    connect(menu->addAction("Edit note ..."), &QAction::triggered, this,
            [this, id] { emit this->markOpened(id); });
    connect(menu->addAction("Delete mark"), &QAction::triggered, this,
            [this, id] { emit this->markErased(id); });
    menu->addSeparator();
  }
  connect(menu->addAction("Add mark ..."), &QAction::triggered, this,
          [this, time_s] { emit this->markAsked(time_s); });
  QAction* all = menu->addAction("Show all times");
  all->setEnabled(self.zoom.has_value());
  connect(all, &QAction::triggered, this, [this] { this->ShowAll(); });
  menu->popup(this->mapToGlobal(place));
}

bool ScrubBar::event(QEvent* event) {
  if (event->type() == QEvent::ToolTip) {
    const auto* help = static_cast<QHelpEvent*>(event);
    const QString text = this->TextAt(help->pos());
    if (text.isEmpty()) {
      QToolTip::hideText();
    } else {
      QToolTip::showText(help->globalPos(), text.toHtmlEscaped().replace("\n", "<br>"), this);
    }
    return true;
  }
  return QWidget::event(event);
}

} // namespace dspace::widgets
