// What plug-ins add to a window: docks, menu entries, keys, read-outs of the status bar.
#ifndef DSPACE_WIDGETS_PLUG_INS_H
#define DSPACE_WIDGETS_PLUG_INS_H

#include <map>
#include <string>

#include <QJsonObject>
#include <QObject>
#include <QPointer>

class QDockWidget;
class QLabel;
class QMainWindow;

namespace dspace::widgets {

class PanelWidget;

// Requests are objects of JSON, as Python's dspace.application.plugins makes them:
//
//   {"do": "panel", "title": ..., "area": "left", "right", "bottom" or "top"}   -> {"panel":
//   number}
//   {"do": "row", "panel": n, "row": {...}} (PanelWidget::AddRow)               -> {"row": number}
//   {"do": "set", "panel": n, "row": n, "changes": {...}}
//   {"do": "close", "panel": n}
//   {"do": "action", "menu": ..., "text": ..., "key": ..., "tip": ...}          -> {"action":
//   number}
//   {"do": "key", "key": ...}                                                   -> {"action":
//   number}
//   {"do": "read_out", "name": ..., "text": ..., "tip": ...}                    -> {"read_out":
//   number}
//   {"do": "tell", "read_out": n, "text": ..., "state": "", "amber" or "red"}
//   {"do": "untell", "read_out": n}
class PlugIns : public QObject {
  Q_OBJECT

public:
  explicit PlugIns(QMainWindow* window);
  ~PlugIns() override; // with its docks

  // Throws Error: InvalidArgument for what is not listed above and for keys that are taken,
  // NotFound for a panel or a read-out that is closed, AlreadyExists for a read-out of a name
  // that another one has.
  QJsonObject Handle(const QJsonObject& request);
  PanelWidget* Panel(int panel) const; // null: it is closed

  // Puts the docks of the right side into a column beside the views, of which this is one.
  void ArrangeBeside(QDockWidget* view);

signals:
  // The user set a row's value, or pressed its button; or chose an action, or its key.
  void changed(int panel, int row, const QJsonValue& value);
  void triggered(int action);

private:
  int AddPanel(const QString& title, const QString& area);
  bool eventFilter(QObject* watched, QEvent* event) override; // of the window: another theme
  int AddReadOut(const QString& name, const QString& text, const QString& tip);
  void Tell(int readOut, const QString& text, const QString& state);
  int AddAction(const QString& menu, const QString& text, const QString& key, const QString& tip);

  QMainWindow* Window_;
  std::map<int, QPointer<QDockWidget>> Docks_;
  int LastPanel_ = 0;
  int LastAction_ = 0;
  struct ReadOut {
    QString name;
    QPointer<QLabel> label;
    QString state;
  };
  void Paint(const ReadOut& readOut) const; // in the colour of its state
  std::map<int, ReadOut> ReadOuts_;
  int LastReadOut_ = 0;
};

} // namespace dspace::widgets

#endif
