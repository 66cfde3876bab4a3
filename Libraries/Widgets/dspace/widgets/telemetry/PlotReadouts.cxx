#include <dspace/widgets/telemetry/PlotReadouts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <QFontMetricsF>

#include <dspace/widgets/telemetry/PlotPicture.h>

namespace dspace::widgets {
namespace {

constexpr int MostReadouts = 8;     // series
constexpr int LeastRows = 3;        // below the curves, or all where these are fewer
constexpr double LeastCurves = 5.0; // height below which the table is beside [lines]
constexpr double CurvesShare = 0.4; // of the height
constexpr double TableGap = 6.0;
constexpr double LeastBeside = 17.0; // widths [lines]
constexpr double MostBeside = 34.0;
constexpr double BesideShare = 0.45; // of the width
constexpr double LeastRest = 14.0;   // of curves and axes
constexpr int BesideDigits = 5;

// With decimals to a ten-thousandth of the times that are shown, or better.
QString TimeWithin(double time_s, double shown_s) {
  if (std::isnan(time_s)) {
    return WithUnit(time_s, "s");
  }
  const int decimals = std::clamp(4 - int(std::floor(std::log10(shown_s))), 0, 9);
  QString text = QString::number(time_s, 'f', decimals);
  while (decimals > 0 && text.endsWith('0')) {
    text.chop(1);
  }
  return (text.endsWith('.') ? text.chopped(1) : text) + " s";
}

} // namespace

PlotReadouts::PlotReadouts(const PlotState& state, const QFont& font, const QPalette& palette,
                           const QRectF& room, double below)
    : State_(state), Font_(font), Palette_(palette), Line_(std::ceil(QFontMetricsF(font).height())),
      Rest_(room) {
  if (!state.cursors[0] && !state.cursors[1]) {
    return;
  }
  const double line = this->Line_;
  const int drawn = int(std::count_if(state.series.begin(), state.series.end(),
                                      [](const PlotSeries& each) { return each.shown; }));
  const int wanted = std::min(drawn, MostReadouts) + 1 + (drawn > MostReadouts ? 1 : 0);
  const double curves = std::max(LeastCurves * line, CurvesShare * room.height());
  const int fit = int(std::floor((room.height() - below - curves - TableGap) / line));
  if (fit >= std::min(wanted, LeastRows)) {
    const double height = std::min(fit, wanted) * line;
    this->Rest_.setBottom(room.bottom() - height - TableGap);
    this->Area_ = QRectF(room.left(), room.bottom() - height, room.width(), height);
    return;
  }
  const double width = std::min(BesideShare * room.width(), MostBeside * line);
  const int rows = std::min(wanted, int(room.height() / line));
  if (width >= LeastBeside * line && room.width() - width >= LeastRest * line && rows > 0) {
    this->Beside_ = true;
    this->Rest_.setRight(room.right() - width - TableGap);
    this->Area_ = QRectF(room.right() - width, room.top(), width, rows * line);
  }
}

void PlotReadouts::Paint(QPainter& painter) const {
  if (this->Area_.isEmpty()) {
    return;
  }
  painter.setFont(this->Font_);
  const QFontMetricsF metrics(this->Font_);
  const auto& [a, b] = this->State_.cursors;
  const double none = std::numeric_limits<double>::quiet_NaN();
  struct Row {
    QString cells[4];
    QColor color;
  };
  const QColor text = this->Palette_.color(QPalette::Text);
  const QString delta(QChar(0x0394));
  const int digits = this->Beside_ ? BesideDigits : 7;
  std::vector<Row> rows;
  const double shown_s =
      (this->State_.XSeries() ? this->State_.xTimes : this->State_.time).Length();
  rows.push_back({{"time", "A " + TimeWithin(a.value_or(none), shown_s),
                   "B " + TimeWithin(b.value_or(none), shown_s),
                   delta + "t " + TimeWithin(a && b ? *b - *a : none, shown_s)},
                  text});
  const std::size_t fit = std::size_t(std::max(1.0, this->Area_.height() / this->Line_));
  std::size_t left = 0;
  for (const PlotSeries& series : this->State_.series) {
    if (!series.shown) {
      continue;
    }
    if (rows.size() >= fit) {
      ++left;
      continue;
    }
    const double valueA = a ? series.samples->At(*a, series.holds) : none;
    const double valueB = b ? series.samples->At(*b, series.holds) : none;
    rows.push_back(
        {{series.name, WithUnit(valueA, series.unit, digits), WithUnit(valueB, series.unit, digits),
          delta + " " + WithUnit(valueB - valueA, series.unit, digits)},
         ColorOf(series.color, this->Palette_)});
  }
  if (left > 0 && rows.size() > 1) {
    rows.back() = {{QString("+%1 more").arg(left + 1), "", "", ""},
                   MixedColor(this->Palette_, 0.6)};
  }
  const double width = this->Area_.width();
  const double column = std::min((this->Beside_ ? 0.26 : 0.24) * width, 14.0 * this->Line_);
  const double names = width - 3.0 * column;
  for (std::size_t i = 0; i < rows.size(); ++i) {
    const double base = this->Area_.top() + double(i) * this->Line_ + metrics.ascent();
    for (int c = 0; c < 4; ++c) {
      painter.setPen(c == 0 ? rows[i].color : text);
      const double room = (c == 0 ? names : column) - (this->Beside_ ? 4.0 : 8.0);
      const QString shown = metrics.elidedText(
          rows[i].cells[c], c == 0 ? Qt::ElideMiddle : Qt::ElideRight, std::max(room, 1.0));
      const double x =
          c == 0 ? this->Area_.left()
                 : this->Area_.left() + names + c * column - metrics.horizontalAdvance(shown);
      painter.drawText(QPointF(x, base), shown);
    }
  }
}

} // namespace dspace::widgets
