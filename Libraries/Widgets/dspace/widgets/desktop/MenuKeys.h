// The keys of a window's menus, and a table of them.
#ifndef DSPACE_WIDGETS_MENU_KEYS_H
#define DSPACE_WIDGETS_MENU_KEYS_H

#include <QKeySequence>
#include <QString>
#include <QStringList>

class QAction;
class QMainWindow;
class QMenu;
class QMenuBar;

namespace dspace::widgets {

// A menu's text without the marks of its letters ("&").
QString WithoutMnemonics(QString text);
// The sequence of one key of a new action `text`, such as "F6" or "Ctrl+Shift+D"; none for an empty
// text. Throws Error(InvalidArgument) for what is none, and for the key of another action of the
// window.
QKeySequence FreeKey(const QMainWindow* window, const QString& text, const QString& key);
// The menu of this title, in the menu bar; null: there is none.
QMenu* MenuNamed(const QMainWindow* window, const QString& title);
// A dialog: `fixed` is a table of HTML with keys and mouse buttons that are no menu's; below it
// stand the menus' own.
void ShowKeys(QMainWindow* window, const QString& fixed);
// As HTML: a row for each action of the menus that has a key.
QString KeysOfMenus(const QMenuBar* menus);
// Entries of the menus that no letter of Alt reaches, and letters that two entries of a menu share,
// each as "File > Open: ...". A window is accessible by keyboard when there are none.
QStringList MnemonicFaults(const QMenuBar* menus);
// Gives each entry that has none a letter ("&") that no other of its menu has, where one is left.
void CompleteMnemonics(QMenuBar* menus);

} // namespace dspace::widgets

#endif
