// Saved arrangements of a window's docks, by name.
#ifndef DSPACE_WIDGETS_LAYOUTS_H
#define DSPACE_WIDGETS_LAYOUTS_H

#include <QByteArray>
#include <QJsonObject>
#include <QObject>
#include <QSet>
#include <QStringList>

class QDockWidget;
class QMainWindow;

namespace dspace::widgets {

class SettingsFile;

// Docks and tool bars are known by their object names; those whose names begin with "view " show
// viewports. A layout has their places, sizes and whether they are shown, and the names of the
// views. The layout of the last time has the window's place too.
class Layouts : public QObject {
  Q_OBJECT

public:
  static constexpr int LongestName = 60; // letters

  // Both must outlive it.
  Layouts(QMainWindow* window, SettingsFile* file, QObject* parent = nullptr);

  QStringList Names() const;
  // Throw Error: InvalidArgument for a name that is empty or too long, NotFound for a layout that
  // is not there, Io where the settings cannot be written, Corrupt for a layout that this window
  // does not take; the window is then as it was.
  void Save(const QString& name);
  void Restore(const QString& name);
  void Remove(const QString& name);

  // Of the last time that the window closed. False: there is none, or it does not fit.
  bool SaveLast();
  bool RestoreLast();
  // Puts a dock that is made after a layout was restored where the layout has it. False: it has
  // none, or had it and it was closed since; the dock is where it was.
  bool Place(QDockWidget* dock);

signals:
  // The names of views that a layout to be restored has and the window has not: whoever can make
  // them does so now.
  void viewsWanted(const QStringList& viewports);
  void changed(); // the names

private:
  QJsonObject Take() const;
  bool Put(const QJsonObject& layout);

  QMainWindow* Window_;
  SettingsFile* File_;
  QByteArray Put_;        // the docks of the restored layout
  QSet<QString> Awaited_; // docks of the restored layout that are not there yet
};

} // namespace dspace::widgets

#endif
