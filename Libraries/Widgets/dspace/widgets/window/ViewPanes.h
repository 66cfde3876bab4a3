// The docks of a window's views: which one is used, split, tiled, maximised.
#ifndef DSPACE_WIDGETS_VIEW_PANES_H
#define DSPACE_WIDGETS_VIEW_PANES_H

#include <set>
#include <string>
#include <vector>

#include <QByteArray>
#include <QJsonObject>
#include <QObject>
#include <QPointer>

class QDockWidget;
class QMainWindow;
class vtkObject;

namespace dspace::widgets {

class ViewportWidget;

class ViewPanes : public QObject {
  Q_OBJECT

public:
  struct Pane {
    QPointer<QDockWidget> dock;
    QPointer<ViewportWidget> widget;
    vtkObject* of = nullptr; // ShownSession.h
    std::string viewport;
  };

  explicit ViewPanes(QMainWindow* window);

  // The dock's place is not changed, but docks that a maximised view hides come back.
  void Add(QDockWidget* dock, ViewportWidget* widget, vtkObject* of, const std::string& viewport);
  // Those that are open, in the order in which they were added.
  std::vector<Pane> Panes() const;
  // The view that had the focus last, of `of` where it is not null; else any of it. A pane without
  // a dock: there is none.
  Pane Current(vtkObject* of = nullptr) const;

  // {"do": "views", "what": "maximize", "copy" (the picture to the clipboard), "view": name}
  // {"what": "split", "view": name, "beside": name, "side": "right" or "below"}
  // {"what": "restore"}, {"what": "tile"}
  // {"what": "current"} -> {"view": the name of Current(), or ""}
  // {"what": "watch", "view": name, "on": bool}: drawn() tells of its pictures.
  // Throws Error: NotFound for a view that is not open, InvalidArgument for other words.
  static bool Handles(const QJsonObject& request);
  QJsonObject Handle(const QJsonObject& request);

  // A floating dock fills its screen, another one its window.
  void Maximize(QDockWidget* dock);
  void Restore();
  bool IsMaximized() const { return !this->Before_.isEmpty(); }
  void Tile();

signals:
  void drawn(const QString& viewport);
  void arranged();
  void currentChanged(); // another view has the focus

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  const Pane& Find(const QString& viewport) const;
  void Split(const Pane& pane, const Pane& beside, const QString& side);
  static void Copy(const Pane& pane);

  QMainWindow* Window_;
  std::vector<Pane> Panes_;
  QPointer<QDockWidget> Used_;
  QByteArray Before_; // the window's state before a view was maximised
  std::set<std::string> Watched_;
};

} // namespace dspace::widgets

#endif
