// Paints over a view.
#ifndef DSPACE_WIDGETS_OVERLAY_PANE_H
#define DSPACE_WIDGETS_OVERLAY_PANE_H

#include <functional>

#include <QWidget>

class QPainter;

namespace dspace::widgets {

class ViewportWidget;

// Lies over a view, which owns it, lets input through, and is painted after each picture of the
// view. `draw` paints with antialiasing in the view's own coordinates; it must not throw.
class OverlayPane : public QWidget {
public:
  OverlayPane(ViewportWidget* view, std::function<void(QPainter&)> draw);

protected:
  bool eventFilter(QObject* object, QEvent* event) override;
  void paintEvent(QPaintEvent* event) override;

private:
  std::function<void(QPainter&)> Draw_;
};

} // namespace dspace::widgets

#endif
