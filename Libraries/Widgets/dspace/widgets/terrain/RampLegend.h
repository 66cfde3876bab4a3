// The colours of a ramp with the values of its ends.
#ifndef DSPACE_WIDGETS_RAMP_LEGEND_H
#define DSPACE_WIDGETS_RAMP_LEGEND_H

#include <vector>

#include <QColor>
#include <QWidget>

namespace dspace::widgets {

struct RampEntry {
  QString title; // with the unit
  double low = 0.0;
  double high = 1.0;
  std::vector<QColor> colors; // evenly spaced, linear between in sRGB; one or more

  bool operator==(const RampEntry& o) const {
    return this->title == o.title && this->low == o.low && this->high == o.high &&
           this->colors == o.colors;
  }
};

// One bar below the other: the title, the bar, and up to five values at even distances.
class RampLegend : public QWidget {
  Q_OBJECT

public:
  explicit RampLegend(QWidget* parent = nullptr);
  void SetEntries(std::vector<RampEntry> entries);
  const std::vector<RampEntry>& Entries() const { return this->Entries_; }
  // The colour at a fraction (0 to 1) of an entry's bar.
  static QColor ColorAt(const RampEntry& entry, double fraction);
  QSize sizeHint() const override;
  QSize minimumSizeHint() const override { return this->sizeHint(); }

protected:
  void paintEvent(QPaintEvent* event) override;

private:
  int EntryHeight() const;

  std::vector<RampEntry> Entries_;
};

} // namespace dspace::widgets

#endif
