// Heights along a line.
#ifndef DSPACE_WIDGETS_PROFILE_CHART_H
#define DSPACE_WIDGETS_PROFILE_CHART_H

#include <vector>

#include <QWidget>

namespace dspace::widgets {

// The ground below a line against the distance from its start, with axes in the units of the
// preferences. The pointer over it shows the distance and the height of the nearest sample.
class ProfileChart : public QWidget {
  Q_OBJECT

public:
  explicit ProfileChart(QWidget* parent = nullptr);
  // Distances [m] that grow, and as many heights [m]; NaN where there are no data. Fewer than two:
  // the chart is empty.
  void SetProfile(std::vector<double> distances, std::vector<double> heights);
  int SampleCount() const { return int(this->Distances_.size()); }
  // The sample under the pointer; -1: none.
  int Pointed() const { return this->Pointed_; }
  // How many times heights are drawn larger than distances; 0: the chart is empty.
  double Exaggeration() const;
  QSize sizeHint() const override { return {300, 180}; }

signals:
  void pointed(int sample);

protected:
  void paintEvent(QPaintEvent* event) override;
  void mouseMoveEvent(QMouseEvent* event) override;
  void leaveEvent(QEvent* event) override;

private:
  struct Plan; // where things are
  Plan Planned() const;
  void Point(int sample);

  std::vector<double> Distances_;
  std::vector<double> Heights_;
  int Pointed_ = -1;
};

} // namespace dspace::widgets

#endif
