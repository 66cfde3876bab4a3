// The channels of a scene as rows of a table.
#ifndef DSPACE_WIDGETS_TELEMETRY_MODEL_H
#define DSPACE_WIDGETS_TELEMETRY_MODEL_H

#include <memory>

#include <QAbstractTableModel>

#include <dspace/widgets/telemetry/TelemetrySource.h>

namespace dspace::widgets {

// A row a channel, in the order of names. It keeps copies of all that it shows.
class TelemetryModel : public QAbstractTableModel {
  Q_OBJECT

public:
  enum Column { Name, Value, Unit, AlarmLow, WarningLow, WarningHigh, AlarmHigh, Columns };
  enum Role {
    SortRole = Qt::UserRole, // texts and numbers; NaN: none
    SearchRole,              // of the name's column: name, unit and description
    StateRole                // of the name's column: v1::TelemetryInfo::State
  };

  explicit TelemetryModel(QObject* parent = nullptr);
  ~TelemetryModel() override;

  // Takes the present state; null: there are no channels. Only rows that changed are told, in runs.
  void Refresh(const session::Telemetry* telemetry);
  // -1: there is no such channel.
  int RowOf(const QString& name) const;

  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation,
                      int role = Qt::DisplayRole) const override;
  Qt::ItemFlags flags(const QModelIndex& index) const override;
  QStringList mimeTypes() const override;
  QMimeData* mimeData(const QModelIndexList& indexes) const override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
