// What goes on in the background, each with its progress and a button that cancels it.
#ifndef DSPACE_WIDGETS_TASK_STRIP_H
#define DSPACE_WIDGETS_TASK_STRIP_H

#include <map>

#include <QWidget>

class QLabel;
class QProgressBar;
class QToolButton;

namespace dspace::widgets {

// For a status bar. It is empty while nothing goes on.
class TaskStrip : public QWidget {
  Q_OBJECT

public:
  explicit TaskStrip(QWidget* parent = nullptr);

  // Shows a task, or changes what is shown of it. `done`: from 0 to 1; below: how much is not
  // known. `cancel`: the text of the button; empty: there is none. An empty text ends the task.
  void Show(long id, const QString& text, double done, const QString& cancel);
  int Count() const { return int(this->Rows_.size()); }
  // Of a task; "": there is no such task.
  QString Text(long id) const;

signals:
  void cancelled(long id);

private:
  struct Row {
    QWidget* widget;
    QLabel* text;
    QProgressBar* bar;
    QToolButton* button;
  };
  std::map<long, Row> Rows_;
};

} // namespace dspace::widgets

#endif
