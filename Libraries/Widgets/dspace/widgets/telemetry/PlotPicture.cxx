#include <dspace/widgets/telemetry/PlotPicture.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <QFontInfo>
#include <QFontMetricsF>

namespace dspace::widgets {
namespace {

constexpr double Margin = 8.0;
constexpr double Tick = 5.0;
constexpr double LineWidth = 1.5;
constexpr double DenseTravel = 6.0; // of a curve's lines, in widths of the area
constexpr int MostLegendLines = 3;
constexpr double LowHeight = 13.0;         // below it titles and the legend are short [lines]
constexpr std::size_t MostSearched = 4096; // samples of a series around the pointer
const QChar Dash(0x2013);

double Now(const PlotState& state) {
  double now = state.current.value_or(-std::numeric_limits<double>::infinity());
  for (const PlotSeries& each : state.series) {
    if (!each.samples->IsEmpty()) {
      now = std::max(now, each.samples->Time(each.samples->Size() - 1));
    }
  }
  return now;
}

} // namespace

QColor ColorOf(int number, const QPalette& palette) {
  static constexpr QRgb light[] = {0x0072b2, 0xc24e00, 0x008060, 0xa8328f,
                                   0x7a6200, 0x5546c8, 0x0f7285, 0x8a2a4e};
  static constexpr QRgb dark[] = {0x56b4e9, 0xff9e4a, 0x4bd3a0, 0xe59ac8,
                                  0xf0e442, 0xa79bff, 0x6fd6e0, 0xff8fa3};
  const bool isDark = palette.color(QPalette::Base).lightness() < 128;
  return QColor((isDark ? dark : light)[number % 8]);
}

QString WithUnit(double value, const QString& unit, int digits) {
  if (std::isnan(value)) {
    return QString(Dash);
  }
  const QString text = QString::number(value, 'g', digits);
  return unit.isEmpty() ? text : text + " " + unit;
}

QColor MixedColor(const QPalette& palette, double part) {
  const QColor a = palette.color(QPalette::Base);
  const QColor b = palette.color(QPalette::Text);
  const auto mix = [part](int from, int to) { return int(std::lround(from + part * (to - from))); };
  return {mix(a.red(), b.red()), mix(a.green(), b.green()), mix(a.blue(), b.blue())};
}

PlotPicture::PlotPicture(const PlotState& state, const QSizeF& size, const QFont& font,
                         const QPalette& palette, double ratio)
    : State_(state), Size_(size), Font_(font), Palette_(palette), Ratio_(ratio) {
  // The same on every device.
  this->Font_.setPixelSize(std::max(6, QFontInfo(font).pixelSize()));
  const QFontMetricsF metrics(this->Font_);
  this->Line_ = std::ceil(metrics.height());
  const double line = this->Line_;

  this->Low_ = size.height() < LowHeight * line;
  const int mostLines = this->Low_ ? 1 : MostLegendLines;

  // The legend, in lines.
  double top = Margin;
  double x = Margin;
  int lines = state.series.empty() ? 0 : 1;
  const double swatch = 1.4 * line;
  const double widest = std::max(size.width() - 2.0 * Margin, 1.0);
  for (std::size_t i = 0; i < state.series.size(); ++i) {
    const double most = std::max(0.5 * widest - swatch, 2.0 * line);
    LegendEntry entry;
    entry.series = int(i);
    entry.text = metrics.elidedText(state.series[i].Title(), Qt::ElideMiddle, most);
    const double width = swatch + metrics.horizontalAdvance(entry.text) + line;
    const bool last = i + 1 == state.series.size();
    const double room = lines == mostLines && !last ? widest - 4.0 * line : widest; // for "+12"
    if (x > Margin && x + width - line > Margin + room) {
      if (lines == mostLines) {
        this->LegendHidden_ = int(state.series.size() - i);
        this->LegendMore_ = QRectF(x, top, 4.0 * line, line);
        break;
      }
      ++lines;
      x = Margin;
      top += line + 2.0;
    }
    entry.area = QRectF(x, top, width - line, line);
    this->Legend_.push_back(entry);
    x += width;
  }
  top = Margin + lines * (line + 2.0) + (lines ? 4.0 : 0.0);

  // Tick texts, and the title below them, or before them.
  const double xHeight = Tick + 2.0 + (this->Low_ ? 1.0 : 2.0) * line;
  const QRectF room(Margin, top, widest, std::max(size.height() - Margin - top, 1.0));
  this->Readouts_.emplace(state, this->Font_, palette, room, xHeight);
  const QRectF rest = this->Readouts_->Rest();
  const double bottom = rest.bottom();
  const double areaBottom = std::max(bottom - xHeight, top + 1.0);

  // Ticks of the values fit the height.
  const int rows = std::clamp(int((areaBottom - top) / (2.2 * line)), 2, 12);
  double left = Margin;
  double right = rest.right();
  const bool many = state.axes.size() > 2;
  for (std::size_t i = 0; i < state.axes.size(); ++i) {
    Axis axis;
    axis.left = i % 2 == 0;
    axis.ticks = MakeTicks(state.axes[i].range, rows);
    for (const PlotTick& tick : axis.ticks.ticks) {
      axis.textWidth =
          std::max(axis.textWidth, metrics.horizontalAdvance(QString::fromStdString(tick.text)));
    }
    // In steps, so that the area stays where it is while the user zooms and moves.
    const double step = metrics.horizontalAdvance("0000");
    const double texts = step * std::max(many ? 1.0 : 2.0, std::ceil(axis.textWidth / step));
    const double title = this->Low_ && many ? 0.0 : line; // it is turned
    const double width = std::ceil(texts) + Tick + 6.0 + title;
    axis.area = QRectF(0.0, top, width, areaBottom - top);
    this->Axes_.push_back(axis);
    (axis.left ? left : right) += axis.left ? width + 4.0 : -width - 4.0;
  }
  if (state.axes.size() < 2) {
    right -= 2.0 * line; // for the text of the last tick
  }
  if (right < left + 1.0) {
    right = left + 1.0;
  }
  this->Area_ = QRectF(left, top, right - left, areaBottom - top);
  this->XArea_ = QRectF(left, areaBottom, right - left, bottom - areaBottom);
  double beginLeft = left;
  double beginRight = right;
  for (Axis& axis : this->Axes_) {
    if (axis.left) {
      beginLeft -= axis.area.width();
      axis.area.moveLeft(beginLeft);
      beginLeft -= 4.0;
    } else {
      axis.area.moveLeft(beginRight);
      beginRight += axis.area.width() + 4.0;
    }
  }
  // Of X as many as fit beside each other.
  for (int count = std::clamp(int(this->Area_.width() / (3.0 * line)), 1, 20);; --count) {
    this->XTicks_ = MakeTicks(state.XRange(), count);
    double text = 0.0;
    for (const PlotTick& tick : this->XTicks_.ticks) {
      text = std::max(text, metrics.horizontalAdvance(QString::fromStdString(tick.text)));
    }
    const double step = this->XTicks_.ticks.size() > 1
                            ? (this->XTicks_.ticks[1].value - this->XTicks_.ticks[0].value) /
                                  state.XRange().Length() * this->Area_.width()
                            : this->Area_.width();
    if (count == 1 || text + line <= step) {
      break;
    }
  }
}

PlotMap PlotPicture::MapOf(int axis) const {
  PlotMap map;
  map.area = this->Area_;
  map.x = this->State_.XRange();
  if (axis >= 0 && axis < int(this->State_.axes.size())) {
    map.y = this->State_.axes[std::size_t(axis)].range;
  }
  return map;
}

QColor PlotPicture::Mixed(double part) const {
  return MixedColor(this->Palette_, part);
}

QString PlotPicture::XTitle() const {
  const PlotSeries* x = this->State_.XSeries();
  QString name = x ? x->name : QString("time");
  const QString unit = x ? x->unit : QString("s");
  if (!this->XTicks_.offsetText.empty()) {
    name += QString(" ") + QChar(0x2212) + " (" + QString::fromStdString(this->XTicks_.offsetText) +
            ")";
  }
  return unit.isEmpty() ? name : name + " [" + unit + "]";
}

QString PlotPicture::TitleOf(int number) const {
  const PlotValueAxis& axis = this->State_.axes[std::size_t(number)];
  QStringList names;
  for (const PlotSeries& each : this->State_.series) {
    if (this->State_.IsDrawn(each) && each.unit == axis.unit) {
      names += each.name;
    }
  }
  QString title = names.size() == 1 ? names[0] : QString();
  const std::string& offset = this->Axes_[std::size_t(number)].ticks.offsetText;
  if (!offset.empty()) {
    title += QString(title.isEmpty() ? "values " : " ") + QChar(0x2212) + " (" +
             QString::fromStdString(offset) + ")";
  }
  if (axis.unit.isEmpty()) {
    return title.isEmpty() ? QString("no unit") : title;
  }
  return (title.isEmpty() ? QString() : title + " ") + "[" + axis.unit + "]";
}

void PlotPicture::PaintAxis(QPainter& painter, int number) const {
  const Axis& axis = this->Axes_[std::size_t(number)];
  const QFontMetricsF metrics(this->Font_);
  const PlotMap map = this->MapOf(number);
  // In the colour of its only series.
  QColor color = this->Palette_.color(QPalette::Text);
  int drawn = 0;
  for (const PlotSeries& each : this->State_.series) {
    if (this->State_.IsDrawn(each) && this->State_.AxisOf(each) == number) {
      color =
          ++drawn == 1 ? ColorOf(each.color, this->Palette_) : this->Palette_.color(QPalette::Text);
    }
  }
  const double edge = axis.left ? axis.area.right() : axis.area.left();
  const double out = axis.left ? -1.0 : 1.0;
  painter.setPen(QPen(this->Mixed(0.5), 1.0));
  painter.drawLine(QPointF(edge, axis.area.top()), QPointF(edge, axis.area.bottom()));
  for (const PlotTick& tick : axis.ticks.ticks) {
    const double y = map.At(map.x.low, tick.value).y();
    painter.setPen(QPen(this->Mixed(0.5), 1.0));
    painter.drawLine(QPointF(edge, y), QPointF(edge + out * Tick, y));
    painter.setPen(color);
    const QString text = QString::fromStdString(tick.text);
    const double width = metrics.horizontalAdvance(text);
    // Texts at the ends stay beside the area.
    const double base = std::clamp(y + 0.5 * metrics.ascent() - 0.5 * metrics.descent(),
                                   axis.area.top() + metrics.ascent(),
                                   axis.area.bottom() - 0.2 * metrics.descent());
    // Numbers are aligned at their right.
    const double x =
        axis.left ? edge - Tick - 3.0 - width : edge + Tick + 3.0 + axis.textWidth - width;
    painter.drawText(QPointF(x, base), text);
  }
  if (this->Low_ && this->Axes_.size() > 2) {
    return; // the legend has names and units, in the colours of the ticks
  }
  painter.save();
  painter.setPen(color);
  const QString title =
      metrics.elidedText(this->TitleOf(number), Qt::ElideMiddle, std::max(axis.area.height(), 1.0));
  const double width = metrics.horizontalAdvance(title);
  // Turned, the base line is at the right of the text.
  const double x =
      axis.left ? axis.area.left() + metrics.ascent() : axis.area.right() - metrics.descent();
  painter.translate(x, axis.area.center().y() + 0.5 * width);
  painter.rotate(-90.0);
  painter.drawText(QPointF(0.0, 0.0), title);
  painter.restore();
}

void PlotPicture::PaintXTitle(QPainter& painter) const {
  const QFontMetricsF metrics(this->Font_);
  painter.setPen(this->Palette_.color(QPalette::Text));
  const double base = this->Area_.bottom() + Tick + 2.0 + metrics.ascent();
  if (this->Low_) { // at the left of the ticks, below the axes of values
    const double room = this->Area_.left() - 1.5 * this->Line_ - Margin;
    const QString title = metrics.elidedText(this->XTitle(), Qt::ElideLeft, std::max(room, 1.0));
    painter.drawText(QPointF(Margin + room - metrics.horizontalAdvance(title), base), title);
    return;
  }
  const double most = this->Size_.width() - 2.0 * Margin;
  const QString title = metrics.elidedText(this->XTitle(), Qt::ElideMiddle, most);
  const double width = metrics.horizontalAdvance(title);
  const double end = std::max(this->Size_.width() - width - Margin, Margin);
  const double x = std::clamp(this->Area_.center().x() - 0.5 * width, Margin, end);
  painter.drawText(QPointF(x, base + this->Line_), title);
}

void PlotPicture::PaintGround(QPainter& painter) const {
  painter.setFont(this->Font_);
  const QFontMetricsF metrics(this->Font_);
  painter.fillRect(QRectF(QPointF(0.0, 0.0), this->Size_), this->Palette_.color(QPalette::Base));
  const QColor text = this->Palette_.color(QPalette::Text);
  if (this->State_.series.empty()) {
    return;
  }
  // Legend: a stroke in the colour, and the name; hidden series are dim.
  painter.setRenderHint(QPainter::Antialiasing, true);
  for (const LegendEntry& entry : this->Legend_) {
    const PlotSeries& series = this->State_.series[std::size_t(entry.series)];
    const bool isX = &series == this->State_.XSeries();
    const double middle = entry.area.center().y();
    if (isX) {
      painter.setPen(text);
      painter.drawText(QPointF(entry.area.left(), entry.area.top() + metrics.ascent()), "X");
    } else {
      painter.setPen(QPen(series.shown ? ColorOf(series.color, this->Palette_) : this->Mixed(0.35),
                          2.5, Qt::SolidLine, Qt::FlatCap));
      painter.drawLine(QPointF(entry.area.left(), middle),
                       QPointF(entry.area.left() + 1.1 * this->Line_, middle));
    }
    painter.setPen(series.shown || isX ? text : this->Mixed(0.45));
    painter.drawText(
        QPointF(entry.area.left() + 1.4 * this->Line_, entry.area.top() + metrics.ascent()),
        entry.text);
  }
  if (this->LegendHidden_ > 0) {
    painter.setPen(this->Mixed(0.6));
    painter.drawText(QPointF(this->LegendMore_.left(), this->LegendMore_.top() + metrics.ascent()),
                     "+" + QString::number(this->LegendHidden_));
  }

  // Grid, of X and the first axis of values.
  painter.setRenderHint(QPainter::Antialiasing, false);
  painter.setPen(QPen(this->Mixed(0.13), 1.0));
  const PlotMap first = this->MapOf(0);
  for (const PlotTick& tick : this->XTicks_.ticks) {
    const double x = first.At(tick.value, first.y.low).x();
    painter.drawLine(QPointF(x, this->Area_.top()), QPointF(x, this->Area_.bottom()));
  }
  if (!this->Axes_.empty()) {
    for (const PlotTick& tick : this->Axes_[0].ticks.ticks) {
      const double y = first.At(first.x.low, tick.value).y();
      painter.drawLine(QPointF(this->Area_.left(), y), QPointF(this->Area_.right(), y));
    }
  }
  for (int i = 0; i < int(this->Axes_.size()); ++i) {
    this->PaintAxis(painter, i);
  }
  painter.setPen(QPen(this->Mixed(0.5), 1.0));
  painter.setBrush(Qt::NoBrush);
  painter.drawLine(this->Area_.bottomLeft(), this->Area_.bottomRight());
  double after = -std::numeric_limits<double>::infinity(); // of the text before
  for (const PlotTick& tick : this->XTicks_.ticks) {
    const double x = first.At(tick.value, first.y.low).x();
    painter.setPen(QPen(this->Mixed(0.5), 1.0));
    painter.drawLine(QPointF(x, this->Area_.bottom()), QPointF(x, this->Area_.bottom() + Tick));
    painter.setPen(text);
    const QString label = QString::fromStdString(tick.text);
    const double width = metrics.horizontalAdvance(label);
    const double from =
        std::clamp(x - 0.5 * width, 2.0, std::max(this->Size_.width() - width - 2.0, 2.0));
    if (from > after) {
      painter.drawText(QPointF(from, this->Area_.bottom() + Tick + 2.0 + metrics.ascent()), label);
      after = from + width + 2.0;
    }
  }
  this->PaintXTitle(painter);

  // Curves.
  const PlotSeries* xSeries = this->State_.XSeries();
  const int columns = std::max(1, int(std::lround(this->Area_.width() * this->Ratio_)));
  const double now = Now(this->State_);
  bool any = false;
  for (const PlotSeries& series : this->State_.series) {
    any = any || !series.samples->IsEmpty();
    const int axis = this->State_.AxisOf(series);
    if (!this->State_.IsDrawn(series) || axis < 0) {
      continue;
    }
    const PlotMap map = this->MapOf(axis);
    const PlotCurve curve = xSeries ? PairCurve(*xSeries->samples, xSeries->holds, *series.samples,
                                                map, this->State_.xTimes)
                                    : TimeCurve(*series.samples, series.holds, map, columns, now);
    const QColor color = ColorOf(series.color, this->Palette_);
    // Smooth edges of a dense curve cannot be seen, and take most of the time.
    const bool dense = curve.travel > DenseTravel * this->Area_.width();
    painter.setRenderHint(QPainter::Antialiasing, !dense);
    QPen pen(color, dense ? 1.0 : LineWidth, Qt::SolidLine, Qt::FlatCap, Qt::BevelJoin);
    pen.setCosmetic(dense);
    painter.setPen(pen);
    painter.setBrush(Qt::NoBrush);
    for (const QPolygonF& line : curve.lines) {
      painter.drawPolyline(line);
    }
    painter.setRenderHint(QPainter::Antialiasing, true);
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    for (const QPointF& dot : curve.dots) {
      painter.drawEllipse(dot, 2.2, 2.2);
    }
  }
  if (!any) {
    painter.setPen(this->Mixed(0.6));
    const QString none = metrics.elidedText("No samples yet", Qt::ElideRight, this->Area_.width());
    painter.drawText(QPointF(this->Area_.center().x() - 0.5 * metrics.horizontalAdvance(none),
                             this->Area_.center().y()),
                     none);
  }
}

std::optional<QPointF> PlotPicture::PlaceOf(const PlotSeries& series, double time_s) const {
  const int axis = this->State_.AxisOf(series);
  if (!this->State_.IsDrawn(series) || axis < 0) {
    return {};
  }
  const PlotSeries* x = this->State_.XSeries();
  const double y = series.samples->At(time_s, series.holds);
  const QPointF place = this->MapOf(axis).At(x ? x->samples->At(time_s, x->holds) : time_s, y);
  if (std::isnan(place.x()) || std::isnan(place.y()) || !this->Area_.contains(place)) {
    return {};
  }
  return place;
}

void PlotPicture::PaintMarks(QPainter& painter) const {
  if (this->State_.series.empty()) {
    return;
  }
  painter.setFont(this->Font_);
  const QFontMetricsF metrics(this->Font_);
  const QColor highlight = this->Palette_.color(QPalette::Highlight);
  const PlotMap map = this->MapOf(-1);
  // name "": the current time.
  const auto mark = [&](double time_s, const QString& name, const QColor& color) {
    painter.setRenderHint(QPainter::Antialiasing, true);
    QPointF labelled(map.At(time_s, 0.0).x(), this->Area_.top());
    bool inside = !this->IsPairs() && labelled.x() >= this->Area_.left() &&
                  labelled.x() <= this->Area_.right();
    if (inside) {
      painter.setPen(QPen(color, name.isEmpty() ? 2.0 : 1.0,
                          name.isEmpty() ? Qt::SolidLine : Qt::DashLine, Qt::FlatCap));
      painter.drawLine(QPointF(labelled.x(), this->Area_.top()),
                       QPointF(labelled.x(), this->Area_.bottom()));
    }
    for (const PlotSeries& series : this->State_.series) {
      const std::optional<QPointF> place = this->PlaceOf(series, time_s);
      if (place && (!name.isEmpty() || this->IsPairs())) {
        painter.setPen(QPen(name.isEmpty() ? color : ColorOf(series.color, this->Palette_), 1.5));
        painter.setBrush(this->Palette_.color(QPalette::Base));
        painter.drawEllipse(*place, 4.0, 4.0);
        if (this->IsPairs()) {
          labelled = *place + QPointF(0.0, -this->Line_ - 6.0);
          labelled.setX(std::clamp(labelled.x(), this->Area_.left(), this->Area_.right()));
          inside = true;
        }
      }
    }
    if (inside && !name.isEmpty()) {
      const double width = metrics.horizontalAdvance(name) + 8.0;
      const QRectF box(std::clamp(labelled.x() - 0.5 * width, this->Area_.left(),
                                  std::max(this->Area_.right() - width, this->Area_.left())),
                       std::max(labelled.y(), this->Area_.top()), width, this->Line_);
      painter.setPen(Qt::NoPen);
      painter.setBrush(color);
      painter.drawRoundedRect(box, 3.0, 3.0);
      painter.setPen(this->Palette_.color(QPalette::Base));
      painter.drawText(QPointF(box.left() + 4.0, box.top() + metrics.ascent()), name);
    }
  };
  if (this->State_.current) {
    mark(*this->State_.current, "", highlight);
  }
  for (int i = 0; i < 2; ++i) {
    if (this->State_.cursors[std::size_t(i)]) {
      mark(*this->State_.cursors[std::size_t(i)], i == 0 ? "A" : "B", this->Mixed(0.8));
    }
  }
  this->Readouts_->Paint(painter);
}

PlotPicture::Hit PlotPicture::Nearest(const QPointF& place, double distance) const {
  Hit best;
  double least = distance * distance;
  const PlotSeries* x = this->State_.XSeries();
  const auto measure = [](const QPointF& d) { return QPointF::dotProduct(d, d); };
  for (std::size_t s = 0; s < this->State_.series.size(); ++s) {
    const PlotSeries& series = this->State_.series[s];
    const int axis = this->State_.AxisOf(series);
    if (!this->State_.IsDrawn(series) || axis < 0 || series.samples->IsEmpty()) {
      continue;
    }
    const SampleSeries& samples = *series.samples;
    const PlotMap map = this->MapOf(axis);
    const auto look = [&](std::size_t i) {
      const double at = x ? x->samples->At(samples.Time(i), x->holds) : samples.Time(i);
      const double d = measure(map.At(at, samples.Value(i)) - place);
      if (d <= least) { // never for NaN
        least = d;
        best = {int(s), i};
      }
    };
    if (!x) {
      std::size_t begin = samples.Lower(map.XAt(place.x() - distance));
      std::size_t end = samples.Upper(map.XAt(place.x() + distance));
      if (end - begin > MostSearched) {
        const std::size_t middle = samples.Lower(map.XAt(place.x()));
        begin = std::max(begin, middle - std::min(middle, MostSearched / 2));
        end = std::min(end, middle + MostSearched / 2);
      }
      for (std::size_t i = begin; i < end; ++i) {
        look(i);
      }
      continue;
    }
    // X-Y: intervals whose rectangle comes near.
    std::vector<std::pair<std::size_t, std::size_t>> todo = {
        {samples.Lower(this->State_.xTimes.low), samples.Upper(this->State_.xTimes.high)}};
    while (!todo.empty()) {
      const auto [begin, end] = todo.back();
      todo.pop_back();
      if (end - begin <= 16) {
        for (std::size_t i = begin; i < end; ++i) {
          look(i);
        }
        continue;
      }
      const std::size_t first = x->samples->Lower(samples.Time(begin));
      const std::size_t last = x->samples->Upper(samples.Time(end - 1));
      const SampleExtent wide =
          x->samples->Extent(first > 0 ? first - 1 : 0, std::min(last + 1, x->samples->Size()));
      const SampleExtent high = samples.Extent(begin, end);
      const QRectF box =
          QRectF(map.At(wide.min, high.max), map.At(wide.max, high.min)); // NaN: left out
      const double dx = std::max({box.left() - place.x(), place.x() - box.right(), 0.0});
      const double dy = std::max({box.top() - place.y(), place.y() - box.bottom(), 0.0});
      if (!std::isnan(wide.min) && !std::isnan(high.min) && dx * dx + dy * dy <= least) {
        const std::size_t middle = begin + (end - begin) / 2;
        todo.emplace_back(middle, end);
        todo.emplace_back(begin, middle);
      }
    }
  }
  return best;
}

} // namespace dspace::widgets
