#include <dspace/widgets/terrain/RampLegend.h>

#include <algorithm>
#include <cmath>

#include <QPainter>

namespace dspace::widgets {
namespace {

constexpr int Bar = 14;   // pixels
constexpr int Margin = 4; // pixels
constexpr int Values = 5;

} // namespace

RampLegend::RampLegend(QWidget* parent) : QWidget(parent) {
  this->setSizePolicy(QSizePolicy::Expanding, QSizePolicy::Fixed);
  this->hide(); // until it has entries
}

void RampLegend::SetEntries(std::vector<RampEntry> entries) {
  if (entries == this->Entries_) {
    return;
  }
  this->Entries_ = std::move(entries);
  QStringList spoken;
  for (const RampEntry& entry : this->Entries_) {
    spoken << tr("%1: %2 to %3").arg(entry.title).arg(entry.low).arg(entry.high);
  }
  this->setAccessibleDescription(spoken.join(QStringLiteral("; ")));
  this->setVisible(!this->Entries_.empty());
  this->updateGeometry();
  this->update();
}

QColor RampLegend::ColorAt(const RampEntry& entry, double fraction) {
  const auto& colors = entry.colors;
  if (colors.size() < 2) {
    return colors.empty() ? QColor() : colors.front();
  }
  const double place = std::clamp(fraction, 0.0, 1.0) * double(colors.size() - 1);
  const std::size_t i = std::min(std::size_t(place), colors.size() - 2);
  const double t = place - double(i);
  const auto mix = [t](double a, double b) { return std::clamp((1.0 - t) * a + t * b, 0.0, 1.0); };
  return QColor::fromRgbF(float(mix(colors[i].redF(), colors[i + 1].redF())),
                          float(mix(colors[i].greenF(), colors[i + 1].greenF())),
                          float(mix(colors[i].blueF(), colors[i + 1].blueF())));
}

int RampLegend::EntryHeight() const {
  return 2 * this->fontMetrics().height() + Bar + 3 * Margin;
}

QSize RampLegend::sizeHint() const {
  return {220, std::max(1, int(this->Entries_.size()) * this->EntryHeight())};
}

void RampLegend::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  const int line = this->fontMetrics().height();
  int top = 0;
  for (const RampEntry& entry : this->Entries_) {
    const QRect bar(Margin, top + line + Margin, this->width() - 2 * Margin, Bar);
    painter.setPen(this->palette().color(QPalette::WindowText));
    painter.drawText(QRect(Margin, top, bar.width(), line), Qt::AlignLeft | Qt::AlignVCenter,
                     this->fontMetrics().elidedText(entry.title, Qt::ElideRight, bar.width()));
    for (int x = 0; x < bar.width(); ++x) {
      painter.fillRect(bar.left() + x, bar.top(), 1, bar.height(),
                       ColorAt(entry, (x + 0.5) / bar.width()));
    }
    painter.setBrush(Qt::NoBrush);
    painter.setPen(this->palette().color(QPalette::Mid));
    painter.drawRect(bar.adjusted(0, 0, -1, -1));
    painter.setPen(this->palette().color(QPalette::WindowText));
    int free = bar.left(); // where the next value may begin
    for (int i = 0; i < Values; ++i) {
      const double value = entry.low + (entry.high - entry.low) * i / (Values - 1);
      const QString text = QString::number(value, 'g', 5);
      const int width = this->fontMetrics().horizontalAdvance(text);
      const int at = bar.left() + bar.width() * i / (Values - 1);
      const int left = std::clamp(at - width / 2, bar.left(), bar.right() + 1 - width);
      const bool last = i == Values - 1;
      const int lastWidth =
          this->fontMetrics().horizontalAdvance(QString::number(entry.high, 'g', 5));
      if (left < free || (!last && left + width + 8 > bar.right() + 1 - lastWidth)) {
        continue;
      }
      painter.drawLine(std::min(at, bar.right()), bar.bottom() + 1, std::min(at, bar.right()),
                       bar.bottom() + 3);
      painter.drawText(QRect(left, bar.bottom() + Margin, width, line), Qt::AlignCenter, text);
      free = left + width + 8;
    }
    top += this->EntryHeight();
  }
}

} // namespace dspace::widgets
