// Measurements between the points that the user clicks on.
#ifndef DSPACE_WIDGETS_MEASURE_WIDGET_H
#define DSPACE_WIDGETS_MEASURE_WIDGET_H

#include <array>
#include <string>
#include <vector>

#include <QJsonObject>
#include <QWidget>

class QLabel;
class QPushButton;
class QTableWidget;
class QToolButton;

namespace dspace::widgets {

class ProfileChart;

// A tool of it takes the clicks in views: "line" (distances and the profile of the ground), "area",
// "angle". It measures nothing itself: measureWanted() has the line of Python that does, and Show()
// takes what came of it.
class MeasureWidget : public QWidget {
  Q_OBJECT

public:
  using Point = std::array<double, 3>; // in the scene's root [m]

  explicit MeasureWidget(QWidget* parent = nullptr);

  // The tool that takes clicks: "line", "area", "angle", or "" for none. Another one starts anew.
  void Use(const QString& tool);
  const QString& Used() const { return this->Tool_; }
  // A click on a point, with the name of the terrain there; "": an object. The first click on
  // terrain chooses the terrain on which is measured. Nothing happens without a tool.
  void Add(const Point& point, const QString& terrain);
  const std::vector<Point>& Points() const { return this->Points_; }
  void RemoveLast();
  void Clear();

  // {"kind", "points": [[x, y, z]], "rows": [[name, value or null, "length" | "angle" | "area" |
  // "share"]], "profile": null or {"distance": [], "height": [], "point": [[x, y, z]]}}; lengths
  // and areas in metres, angles in degrees, null: not known.
  void Show(const QJsonObject& result);
  // What Show() had, as lines "name<tab>value unit" in the units that are shown.
  QString Text() const;
  ProfileChart* Chart() const { return this->Chart_; }

  // The line to mark in views: the points, or with a profile its places.
  const std::vector<Point>& Path() const { return this->Path_; }
  bool IsClosed() const; // the last point is joined to the first one
  // The place of the profile under the pointer; null: none.
  const Point* Pointed() const;
  QSize sizeHint() const override { return {300, 460}; }
  // Views get the room of a small window.
  QSize minimumSizeHint() const override { return {140, 140}; }

signals:
  void measureWanted(const QString& python);
  void saveWanted(const QString& path); // of the profile
  void toolChanged();
  void marksChanged();

private:
  void Ask();
  void ShowRows();
  void Restart();

  QString Tool_;
  QString Terrain_;
  std::vector<Point> Points_;
  std::vector<Point> Path_;
  QJsonObject Result_;
  std::vector<QToolButton*> Tools_;
  QLabel* Hint_;
  QTableWidget* Table_;
  ProfileChart* Chart_;
  QPushButton* Last_;
  QPushButton* Clear_;
  QPushButton* Copy_;
  QPushButton* Save_;
};

} // namespace dspace::widgets

#endif
