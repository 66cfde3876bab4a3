// A window that is kept small.
#ifndef DSPACE_WIDGETS_SMALL_WINDOW_H
#define DSPACE_WIDGETS_SMALL_WINDOW_H

#include <QSize>
#include <QStringList>

class QMainWindow;

namespace dspace::widgets {

// Gives a window a size [pixels], for which docks that leave no room are closed: first those that
// are used least (measure, terrain, the Python prompt, messages, telemetry), then plots and those
// of plug-ins, then scene and time. Views stay. Returns what was done as a sentence; "": the window
// has the size, and nothing was closed. A size that is less than views and bars need becomes the
// least that they need, and the sentence says it.
QString KeepSmall(QMainWindow& window, const QSize& size);

} // namespace dspace::widgets

#endif
