// What is measured, marked in the views.
#ifndef DSPACE_WIDGETS_MEASURE_MARKS_H
#define DSPACE_WIDGETS_MEASURE_MARKS_H

#include <array>
#include <map>
#include <string>

#include <QJsonObject>
#include <QObject>
#include <QPointer>

class QPainter;
class vtkObject;

namespace dspace::widgets {

class MeasureWidget;
class OverlayPane;
class ViewportWidget;

// Paints the points and the line of a MeasureWidget over the views of the scene in which they are.
// Marks lie over everything, also over what hides their places. Clicks in views go to the widget
// while it has a tool.
class MeasureMarks : public QObject {
  Q_OBJECT

public:
  MeasureMarks(MeasureWidget* widget, QObject* parent); // the widget must outlive it
  void Add(ViewportWidget* view, vtkObject* of, const std::string& viewport);
  // What a session replied to an event of a view: whether the widget took the point that was
  // clicked on. A point of another scene replaces those that there are.
  bool Take(vtkObject* of, const std::string& viewport, const std::string& event,
            const std::string& reply);
  // A point of a scene (root [m]) that was chosen in another way, such as the origin of an object's
  // row: whether the widget took it. A point of another scene replaces those that there are.
  bool TakePoint(vtkObject* of, const std::string& scene, const std::array<double, 3>& point,
                 const std::string& terrain = {});
  // {"do": "measured", ...}: what Python measured in a scene (MeasureWidget::Show).
  static bool Handles(const QJsonObject& request);
  void Handle(const QJsonObject& request, vtkObject* of, const std::string& scene);
  // Puts the tool down. Returns whether there was one.
  bool End();

private:
  struct View {
    vtkObject* of;
    std::string viewport;
    QPointer<QWidget> pane;
  };
  void Paint(QPainter& painter, ViewportWidget* view);
  void Update();

  MeasureWidget* Widget_;
  std::map<QObject*, View> Views_;
  vtkObject* Of_ = nullptr; // of the scene of the points
  std::string Scene_;
};

} // namespace dspace::widgets

#endif
