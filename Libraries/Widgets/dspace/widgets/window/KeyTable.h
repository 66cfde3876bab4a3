// The keys of the application as a table, and over a view.
#ifndef DSPACE_WIDGETS_KEY_TABLE_H
#define DSPACE_WIDGETS_KEY_TABLE_H

#include <QString>

class QWidget;

namespace dspace::widgets {

QString KeyTable(); // rich text, of keys that are in no menu

// Shows the table over a view, or removes it. A click removes it, too.
void SwitchKeyOverlay(QWidget* view);
// False: the view shows none.
bool RemoveKeyOverlay(QWidget* view);

} // namespace dspace::widgets

#endif
