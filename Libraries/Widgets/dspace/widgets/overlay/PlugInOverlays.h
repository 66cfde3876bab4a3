// What plug-ins in Python paint over views.
#ifndef DSPACE_WIDGETS_PLUG_IN_OVERLAYS_H
#define DSPACE_WIDGETS_PLUG_IN_OVERLAYS_H

#include <map>
#include <string>

#include <QJsonObject>
#include <QObject>
#include <QPointer>

class QPainter;
class vtkObject;

namespace dspace::widgets {

class OverlayPane;
class ViewportWidget;

// Requests are objects of JSON, as Python's dspace.application.overlays makes them:
//
//   {"do": "overlay", "what": "add", "view": viewport, or "" for all views}   -> {"overlay":
//   number}
//   {"do": "overlay", "what": "item", "overlay": n, "item": {...}}            -> {"item": number}
//   {"do": "overlay", "what": "set", "overlay": n, "item": m, "changes": {...}}
//   {"do": "overlay", "what": "remove", "overlay": n, "item": m}
//   {"do": "overlay", "what": "close", "overlay": n}
//
// Items: "kind" ("text", "line", "circle"); their places as "points" ([[x, y, z]] in the root of
// the view's scene [m]), or as "at" ([[x, y]] in pixels of the view from the top left; below 0:
// from the right or the bottom); "color" ("#rrggbb"), "text", "size" [pixels], "align" ("left",
// "center", "right"), "radius" and "width" [pixels], "filled", "closed". Items lie over everything
// in the picture. They are painted in their order, with an edge that sets them off from any ground.
// Items at points move with the camera, and are seen through the view's lens. Sizes are
// kept within 4 to 400, radii within 0.5 to 10,000, widths within 0.5 to 100 pixels.
class PlugInOverlays : public QObject {
  Q_OBJECT

public:
  explicit PlugInOverlays(QObject* parent);

  // A view of the window. `of`: what it is of (ShownSession.h).
  void Add(ViewportWidget* view, vtkObject* of, const std::string& viewport);
  static bool Handles(const QJsonObject& request);
  // Throws Error: NotFound for an overlay or item that is closed, InvalidArgument for what is not
  // listed above.
  QJsonObject Handle(const QJsonObject& request);

private:
  struct Overlay {
    std::string viewport; // empty: all
    std::map<int, QJsonObject> items;
    int last = 0;
  };
  struct View {
    vtkObject* of;
    std::string viewport;
    QPointer<OverlayPane> pane;
  };
  Overlay& Find(const QJsonObject& request);
  bool Any(const std::string& viewport) const; // items over it
  void Update();
  void Paint(QPainter& painter, ViewportWidget* view);

  std::map<int, Overlay> Overlays_;
  int Last_ = 0;
  std::map<QObject*, View> Views_;
};

} // namespace dspace::widgets

#endif
