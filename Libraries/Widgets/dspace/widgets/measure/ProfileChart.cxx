#include <dspace/widgets/measure/ProfileChart.h>

#include <algorithm>
#include <cmath>

#include <QEvent>
#include <QMouseEvent>
#include <QPainter>
#include <QPainterPath>

#include <dspace/widgets/settings/DisplayUnits.h>
#include <dspace/widgets/telemetry/PlotAxis.h>
#include <dspace/widgets/telemetry/PlotCurve.h>

namespace dspace::widgets {
namespace {

constexpr int Margin = 6;     // [pixels]
constexpr int TickLength = 4; // [pixels]
constexpr int TickRoom = 70;  // [pixels] for a tick of the distance
const QColor Ground(0x8a, 0x6d, 0x4b);

} // namespace

struct ProfileChart::Plan {
  bool empty = true;
  PlotMap map; // of values in the units that are shown
  PlotTicks x;
  PlotTicks y;
};

ProfileChart::ProfileChart(QWidget* parent) : QWidget(parent) {
  this->setObjectName(QStringLiteral("profile"));
  this->setMinimumHeight(120);
  this->setMouseTracking(true);
  this->setAccessibleName(tr("Profile"));
  connect(&DisplayUnits::The(), &DisplayUnits::changed, this, qOverload<>(&QWidget::update));
}

void ProfileChart::SetProfile(std::vector<double> distances, std::vector<double> heights) {
  this->Distances_ = std::move(distances);
  this->Heights_ = std::move(heights);
  this->Heights_.resize(this->Distances_.size(), NAN);
  this->Point(-1);
  this->update();
}

ProfileChart::Plan ProfileChart::Planned() const {
  Plan plan;
  const double factor = DisplayUnits::The().Get().LengthFactor();
  SampleExtent heights;
  for (const double height : this->Heights_) {
    heights.Add(height * factor);
  }
  if (this->Distances_.size() < 2 || std::isnan(heights.min)) {
    return plan;
  }
  plan.empty = false;
  plan.map.x = Shown({this->Distances_.front() * factor, this->Distances_.back() * factor});
  plan.map.y = Around(heights, 0.05);
  const int line = this->fontMetrics().height();
  QRectF area(this->rect());
  area.adjust(Margin, line + 2 * Margin, -Margin, -(2 * line + TickLength + 2 * Margin));
  plan.y = MakeTicks(plan.map.y, std::max(2, int(area.height()) / (2 * line)));
  int widest = 0;
  for (const PlotTick& tick : plan.y.ticks) {
    widest =
        std::max(widest, this->fontMetrics().horizontalAdvance(QString::fromStdString(tick.text)));
  }
  area.setLeft(area.left() + widest + TickLength + Margin);
  plan.map.area = area;
  plan.x = MakeTicks(plan.map.x, std::max(2, int(area.width()) / TickRoom));
  return plan;
}

double ProfileChart::Exaggeration() const {
  const Plan plan = this->Planned();
  return plan.empty ? 0.0
                    : plan.map.area.height() / plan.map.y.Length() /
                          (plan.map.area.width() / plan.map.x.Length());
}

void ProfileChart::Point(int sample) {
  if (sample != this->Pointed_) {
    this->Pointed_ = sample;
    this->update();
    emit this->pointed(sample);
  }
}

void ProfileChart::mouseMoveEvent(QMouseEvent* event) {
  const Plan plan = this->Planned();
  if (plan.empty ||
      !plan.map.area.adjusted(-Margin, -Margin, Margin, Margin).contains(event->position())) {
    this->Point(-1);
    return;
  }
  const double at = plan.map.XAt(event->position().x()) / DisplayUnits::The().Get().LengthFactor();
  const auto after = std::lower_bound(this->Distances_.begin(), this->Distances_.end(), at);
  int sample = int(std::min(after, this->Distances_.end() - 1) - this->Distances_.begin());
  if (sample > 0 &&
      at - this->Distances_[std::size_t(sample - 1)] < this->Distances_[std::size_t(sample)] - at) {
    --sample;
  }
  this->Point(sample);
}

void ProfileChart::leaveEvent(QEvent* event) {
  this->Point(-1);
  QWidget::leaveEvent(event);
}

void ProfileChart::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const QColor text = this->palette().color(QPalette::WindowText);
  const Plan plan = this->Planned();
  painter.setPen(text);
  if (plan.empty) {
    painter.drawText(this->rect(), Qt::AlignCenter | Qt::TextWordWrap,
                     tr("The profile of a line on terrain appears here"));
    return;
  }
  const UnitChoice& units = DisplayUnits::The().Get();
  const double factor = units.LengthFactor();
  const QRectF& area = plan.map.area;
  const int line = this->fontMetrics().height();
  QColor grid = text;
  grid.setAlphaF(0.15F);
  for (const PlotTick& tick : plan.y.ticks) {
    const double y = plan.map.At(plan.map.x.low, tick.value).y();
    painter.setPen(grid);
    painter.drawLine(QPointF(area.left(), y), QPointF(area.right(), y));
    painter.setPen(text);
    painter.drawText(QRectF(0, y - 0.5 * line, area.left() - TickLength, line),
                     Qt::AlignRight | Qt::AlignVCenter, QString::fromStdString(tick.text));
  }
  for (const PlotTick& tick : plan.x.ticks) {
    const double x = plan.map.At(tick.value, plan.map.y.low).x();
    painter.setPen(grid);
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    painter.setPen(text);
    const QString label = QString::fromStdString(tick.text);
    const double width = this->fontMetrics().horizontalAdvance(label);
    const double left = std::clamp(x - 0.5 * width, 0.0, this->width() - width);
    painter.drawText(QRectF(left, area.bottom() + TickLength, width, line), Qt::AlignLeft, label);
  }
  const auto withOffset = [&](const QString& what, const PlotTicks& ticks) {
    return ticks.offsetText.empty()
               ? tr("%1 [%2]").arg(what, units.LengthUnit())
               : tr("%1 - %2 [%3]")
                     .arg(what, QString::fromStdString(ticks.offsetText), units.LengthUnit());
  };
  painter.drawText(QRectF(area.left(), area.bottom() + TickLength + line, area.width(), line),
                   Qt::AlignCenter, withOffset(tr("Distance"), plan.x));
  painter.drawText(QRectF(Margin, Margin, this->width() - 2 * Margin, line), Qt::AlignLeft,
                   withOffset(tr("Height"), plan.y) +
                       tr(", drawn %1 times").arg(this->Exaggeration(), 0, 'g', 3));
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setClipRect(area);
  for (std::size_t begin = 0; begin < this->Heights_.size();) { // runs of data
    if (!std::isfinite(this->Heights_[begin])) {
      ++begin;
      continue;
    }
    QPolygonF curve;
    std::size_t end = begin;
    for (; end < this->Heights_.size() && std::isfinite(this->Heights_[end]); ++end) {
      curve << plan.map.At(this->Distances_[end] * factor, this->Heights_[end] * factor);
    }
    QPolygonF filled = curve;
    filled << QPointF(curve.last().x(), area.bottom()) << QPointF(curve.first().x(), area.bottom());
    QColor fill = Ground;
    fill.setAlphaF(0.35F);
    painter.setPen(Qt::NoPen);
    painter.setBrush(fill);
    painter.drawPolygon(filled);
    painter.setPen(QPen(Ground, 1.6));
    painter.drawPolyline(curve);
    begin = end;
  }
  painter.setClipping(false);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(grid);
  painter.drawRect(area);
  if (this->Pointed_ >= 0) {
    const auto i = std::size_t(this->Pointed_);
    const double x = plan.map.At(this->Distances_[i] * factor, plan.map.y.low).x();
    painter.setPen(QPen(this->palette().color(QPalette::Highlight), 1.0));
    painter.drawLine(QPointF(x, area.top()), QPointF(x, area.bottom()));
    const int decimals = units.LengthDecimals(2);
    const QString height = std::isfinite(this->Heights_[i])
                               ? QString::number(this->Heights_[i] * factor, 'f', decimals)
                               : tr("no data");
    const QString label =
        tr("%1, %2").arg(QString::number(this->Distances_[i] * factor, 'f', decimals), height);
    const double width = this->fontMetrics().horizontalAdvance(label) + 2 * Margin;
    const QRectF box(
        std::clamp(x + Margin, area.left(), std::max(area.left(), area.right() - width)),
        area.top() + 2, width, line + 2);
    painter.fillRect(box, this->palette().color(QPalette::Base));
    painter.setPen(text);
    painter.drawText(box, Qt::AlignCenter, label);
  }
}

} // namespace dspace::widgets
