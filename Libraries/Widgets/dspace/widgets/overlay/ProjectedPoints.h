// Where points of a scene are in a view.
#ifndef DSPACE_WIDGETS_PROJECTED_POINTS_H
#define DSPACE_WIDGETS_PROJECTED_POINTS_H

#include <array>
#include <string>
#include <vector>

#include <QPointF>

namespace dspace::widgets {

class ShownSession;
class ViewportWidget;

// Places of points (root of `scene` [m]) in the coordinates of the view's widget [pixels of the
// widget, from the top left], in their order, through the view's lens if it has one. NaN: behind
// the camera, or beside the image of the lens. Empty: the view has no camera now.
std::vector<QPointF> ProjectedPoints(const ShownSession& session, const ViewportWidget& view,
                                     const std::string& scene,
                                     const std::vector<std::array<double, 3>>& points);

// Whether a place can be painted: finite, and not so far outside that a painter overflows.
bool IsPaintable(const QPointF& place);

} // namespace dspace::widgets

#endif
