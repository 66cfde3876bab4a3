// A panel that is described by rows.
#ifndef DSPACE_WIDGETS_PANEL_WIDGET_H
#define DSPACE_WIDGETS_PANEL_WIDGET_H

#include <vector>

#include <QJsonObject>
#include <QScrollArea>

class QGridLayout;

namespace dspace::widgets {

// Rows of Qt's own widgets, for programs that have no Qt, such as a plug-in in Python. A row is an
// object with "kind", "name" (the text beside it), "tip" (tool tip), and:
//
//   heading, text   "text"
//   value           "text"; "state": "", "amber" or "red", told by colour and by a mark
//   button          "text"
//   slider          "low", "high", "value" (numbers), "decimals" (0 to 6), "unit"
//   choice          "options" (texts), "value" (one of them)
//   check           "value" (true or false)
//   entry           "value" (text)
//   table           "columns" (texts), "rows" (lists of texts), "height" (rows that it shows, 1 to
//   50)
//
// Every row may have "enabled" (default true).
class PanelWidget : public QScrollArea {
  Q_OBJECT

public:
  explicit PanelWidget(QWidget* parent = nullptr);

  // Returns the number of the row, from 0. Throws dspace::Error(InvalidArgument) for a kind that is
  // not listed above.
  int AddRow(const QJsonObject& row);
  // Changes what the object names: "text", "state", "value", "options", "rows", "enabled", "tip",
  // or "append" (a row of a table, shown). No signal. Throws dspace::Error(InvalidArgument) if
  // there is no such row.
  void Set(int row, const QJsonObject& changes);
  int RowCount() const { return int(this->Rows_.size()); }
  // The row's control.
  QWidget* Control(int row) const;
  QSize sizeHint() const override;

signals:
  // The user pressed a button (null), or set a value: a number, text, or true or false.
  void changed(int row, const QJsonValue& value);

private:
  struct Row {
    QString kind;
    QWidget* control = nullptr; // what it shows
    QWidget* second = nullptr;  // the number beside a slider
    double low = 0.0;
    double step = 1.0;
  };
  const Row& At(int row) const;

  std::vector<Row> Rows_;
  QGridLayout* Grid_;
};

} // namespace dspace::widgets

#endif
