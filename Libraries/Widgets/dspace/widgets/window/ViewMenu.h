// The menu of a right click in a view.
#ifndef DSPACE_WIDGETS_VIEW_MENU_H
#define DSPACE_WIDGETS_VIEW_MENU_H

#include <functional>
#include <string>

class QMenu;
class QString;

namespace dspace::widgets {

class ShownSession;
class ViewportWidget;

// Opens the menu of the point that was clicked, where a session replied to `event` (a
// ViewportEvent, serialized) that the right button was clicked on an object: copy its coordinates,
// send it to the simulation as a goal, by a line of Python that `run` takes. A drag opens none. The
// menu belongs to the widget and ends when it closes. Null: none was opened.
QMenu* OpenViewMenu(ViewportWidget* widget, const ShownSession& session, const std::string& event,
                    const std::string& reply, std::function<bool(const QString&)> run);

} // namespace dspace::widgets

#endif
