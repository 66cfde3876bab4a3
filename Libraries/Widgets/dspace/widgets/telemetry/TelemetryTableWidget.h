// A widget that shows the telemetry of a scene as a table.
#ifndef DSPACE_WIDGETS_TELEMETRY_TABLE_WIDGET_H
#define DSPACE_WIDGETS_TELEMETRY_TABLE_WIDGET_H

#include <memory>

#include <QStringList>
#include <QWidget>

#include <dspace/widgets/telemetry/TelemetrySource.h>

class QLineEdit;
class QTableView;

namespace dspace::widgets {

class TelemetryModel;

// A search field, and a row for each channel: name, value, unit, limits. A value beyond a warning
// limit is on amber, one beyond an alarm limit on red. A click on a title sorts. Rows are dragged
// into plots (ChannelMime.h). While it is visible it looks for changes up to 30 times a second, and
// more seldom where looking would take more than a twentieth of the time.
class TelemetryTableWidget : public QWidget {
  Q_OBJECT

public:
  explicit TelemetryTableWidget(QWidget* parent = nullptr);
  ~TelemetryTableWidget() override;

  void SetSource(TelemetrySource source); // empty: none
  // Shows the channels that have all words in their name, unit or description, in any case of
  // letters; "": all. The user types it into the search field.
  void SetSearch(const QString& words);
  // Names of the selected rows, in the order shown.
  QStringList Selected() const;
  // Looks for changes now.
  void Refresh();

  TelemetryModel* Model() const;
  QTableView* View() const; // its model is sorted and searched
  QLineEdit* SearchField() const;
  QSize sizeHint() const override;

signals:
  // A double click on its row, or Enter.
  void activated(const QString& channel);
  void selectionChanged();

protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
