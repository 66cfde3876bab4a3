#include <dspace/widgets/telemetry/TelemetryModel.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <limits>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include <QColor>
#include <QLocale>

#include <dspace/state/Telemetry.h>
#include <dspace/state/TelemetryColors.h>
#include <dspace/widgets/telemetry/ChannelMime.h>
#include <dspace/widgets/telemetry/SampleSeries.h>

namespace dspace::widgets {
namespace {

using Info = v1::TelemetryInfo;
using Kind = v1::CreateTelemetry;

constexpr double NoLimit = std::numeric_limits<double>::quiet_NaN();
constexpr std::size_t MostRuns = 64; // of rows that come or go one by one

struct Row {
  std::uint64_t id = 0;
  QString name;
  QString unit;
  QString description;
  Kind::Kind kind = Kind::NUMBER;
  double value = NoLimit;
  std::string text; // of a text, or the label of a choice
  double time_s = NoLimit;
  Info::State state = Info::NO_VALUE;
  std::array<double, 4> limits = {NoLimit, NoLimit, NoLimit, NoLimit}; // ascending
};

QColor ToColor(const std::array<double, 3>& color) {
  return QColor::fromRgbF(float(color[0]), float(color[1]), float(color[2]));
}

// Takes the state of a channel; true: something that cells show has changed.
bool Update(Row& row, const session::Telemetry::Channel& channel,
            const session::Telemetry& telemetry) {
  row.time_s = channel.time_s.value_or(NoLimit);
  const Info::State state = session::StateOf(channel);
  const v1::TelemetryLimits& given = channel.about.limits();
  const std::array<double, 4> limits = {given.has_alarm_low() ? given.alarm_low() : NoLimit,
                                        given.has_warning_low() ? given.warning_low() : NoLimit,
                                        given.has_warning_high() ? given.warning_high() : NoLimit,
                                        given.has_alarm_high() ? given.alarm_high() : NoLimit};
  const bool changed = state != row.state || !SameValue(channel.value, row.value) ||
                       (row.kind == Kind::TEXT && channel.text != row.text) ||
                       !std::equal(limits.begin(), limits.end(), row.limits.begin(), SameValue);
  if (!changed) {
    return false;
  }
  row.state = state;
  row.limits = limits;
  row.value = channel.value;
  if (row.kind == Kind::TEXT) {
    row.text = channel.text;
  } else if (row.kind == Kind::CHOICE) {
    v1::SetTextTable::Row shown;
    shown.set_telemetry(channel.about.name());
    row.text = session::ShownTelemetry(telemetry, shown);
  }
  return true;
}

Row MakeRow(const session::Telemetry::Channel& channel, const session::Telemetry& telemetry) {
  Row row;
  row.id = channel.about.id();
  row.name = QString::fromStdString(channel.about.name());
  row.unit = QString::fromStdString(channel.about.unit());
  row.description = QString::fromStdString(channel.about.description());
  row.kind = channel.about.kind();
  Update(row, channel, telemetry);
  return row;
}

QString ValueText(const Row& row) {
  if (row.state == Info::NO_VALUE) {
    return QString(QChar(0x2013));
  }
  return row.kind == Kind::NUMBER ? QString::number(row.value, 'g', 9)
                                  : QString::fromStdString(row.text);
}

QString ToolTip(const Row& row) {
  QStringList lines = {row.name};
  if (!row.description.isEmpty()) {
    lines += row.description;
  }
  QString value = row.state == Info::NO_VALUE || row.kind != Kind::NUMBER
                      ? (row.state == Info::NO_VALUE ? QString("no value") : ValueText(row))
                      : QString::number(row.value, 'g', QLocale::FloatingPointShortest);
  if (row.state != Info::NO_VALUE && !row.unit.isEmpty()) {
    value += " " + row.unit;
  }
  lines += value + (row.state == Info::ALARM     ? ", beyond an alarm limit"
                    : row.state == Info::WARNING ? ", beyond a warning limit"
                                                 : "");
  if (!std::isnan(row.time_s)) {
    lines +=
        "last change at " + QString::number(row.time_s, 'g', QLocale::FloatingPointShortest) + " s";
  }
  return lines.join('\n').toHtmlEscaped().replace('\n', "<br>");
}

} // namespace

struct TelemetryModel::Internals {
  std::vector<Row> rows;                      // by name, as UTF-8 bytes
  const session::Telemetry* source = nullptr; // only compared
  std::uint64_t revision = 0;
  std::uint64_t lastId = 0;
};

TelemetryModel::TelemetryModel(QObject* parent)
    : QAbstractTableModel(parent), Impl_(std::make_unique<Internals>()) {}

TelemetryModel::~TelemetryModel() = default;

void TelemetryModel::Refresh(const session::Telemetry* telemetry) {
  Internals& self = *this->Impl_;
  if (!telemetry) {
    if (!self.rows.empty()) {
      this->beginResetModel();
      self.rows.clear();
      this->endResetModel();
    }
    self.source = nullptr;
    return;
  }
  if (telemetry == self.source && telemetry->Revision() == self.revision) {
    return;
  }
  const bool other = telemetry != self.source;
  if (other || telemetry->LastId() != self.lastId ||
      telemetry->Names().size() != self.rows.size()) {
    // Both are in the same order. A name with another id is another channel.
    std::vector<Row>& rows = self.rows;
    struct Run {
      std::size_t at; // among the rows before
      std::size_t removed;
      std::vector<std::uint64_t> added;
    };
    std::vector<Run> runs;
    const auto run = [&](std::size_t at) -> Run& {
      if (runs.empty() || runs.back().at + runs.back().removed != at) {
        runs.push_back({at, 0, {}});
      }
      return runs.back();
    };
    std::size_t at = 0;
    for (const auto& [name, id] : telemetry->Names()) {
      while (at < rows.size() && rows[at].name.toStdString() < name) {
        ++run(at).removed;
        ++at;
      }
      if (at < rows.size() && rows[at].id == id && !other) {
        ++at;
        continue;
      }
      if (at < rows.size() && rows[at].name.toStdString() == name) {
        ++run(at).removed;
        ++at;
      }
      run(at).added.push_back(id);
    }
    if (at < rows.size()) {
      run(at).removed += rows.size() - at;
    }
    if (runs.size() > MostRuns || rows.empty() || other) {
      this->beginResetModel();
      rows.clear();
      for (const auto& [name, id] : telemetry->Names()) {
        rows.push_back(MakeRow(telemetry->Get(id), *telemetry));
      }
      this->endResetModel();
    } else {
      for (auto each = runs.rbegin(); each != runs.rend(); ++each) {
        const auto place = std::ptrdiff_t(each->at);
        if (each->removed > 0) {
          this->beginRemoveRows({}, int(each->at), int(each->at + each->removed) - 1);
          rows.erase(rows.begin() + place, rows.begin() + place + std::ptrdiff_t(each->removed));
          this->endRemoveRows();
        }
        if (!each->added.empty()) {
          std::vector<Row> added;
          for (const std::uint64_t id : each->added) {
            added.push_back(MakeRow(telemetry->Get(id), *telemetry));
          }
          this->beginInsertRows({}, int(each->at), int(each->at + added.size()) - 1);
          rows.insert(rows.begin() + place, std::make_move_iterator(added.begin()),
                      std::make_move_iterator(added.end()));
          this->endInsertRows();
        }
      }
    }
  }
  self.source = telemetry;
  self.revision = telemetry->Revision();
  self.lastId = telemetry->LastId();
  int first = -1; // of a run of changed rows
  const int count = int(self.rows.size());
  for (int i = 0; i <= count; ++i) {
    const bool changed =
        i < count &&
        Update(self.rows[std::size_t(i)], telemetry->Get(self.rows[std::size_t(i)].id), *telemetry);
    if (changed && first < 0) {
      first = i;
    } else if (!changed && first >= 0) {
      emit this->dataChanged(this->index(first, Value), this->index(i - 1, AlarmHigh),
                             {Qt::DisplayRole, Qt::BackgroundRole, Qt::ForegroundRole, SortRole});
      first = -1;
    }
  }
}

int TelemetryModel::RowOf(const QString& name) const {
  for (std::size_t i = 0; i < this->Impl_->rows.size(); ++i) {
    if (this->Impl_->rows[i].name == name) {
      return int(i);
    }
  }
  return -1;
}

int TelemetryModel::rowCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : int(this->Impl_->rows.size());
}

int TelemetryModel::columnCount(const QModelIndex& parent) const {
  return parent.isValid() ? 0 : int(Columns);
}

QVariant TelemetryModel::data(const QModelIndex& index, int role) const {
  if (!index.isValid() || index.row() >= this->rowCount()) {
    return {};
  }
  const Row& row = this->Impl_->rows[std::size_t(index.row())];
  const int column = index.column();
  const bool limit = column >= AlarmLow;
  switch (role) {
  case Qt::DisplayRole:
    if (limit) {
      const double value = row.limits[std::size_t(column - AlarmLow)];
      return std::isnan(value) ? QString() : QString::number(value, 'g', 9);
    }
    return column == Name ? row.name : column == Value ? ValueText(row) : row.unit;
  case SortRole:
    if (limit) {
      return row.limits[std::size_t(column - AlarmLow)];
    }
    if (column == Value) {
      return row.kind == Kind::TEXT || (row.kind == Kind::CHOICE && row.state != Info::NO_VALUE)
                 ? QVariant(QString::fromStdString(row.text))
                 : QVariant(row.value);
    }
    return column == Name ? row.name : row.unit;
  case SearchRole:
    return QString(row.name + '\n' + row.unit + '\n' + row.description);
  case StateRole:
    return int(row.state);
  case Qt::TextAlignmentRole:
    return int(
        (limit || (column == Value && row.kind == Kind::NUMBER) ? Qt::AlignRight : Qt::AlignLeft) |
        Qt::AlignVCenter);
  case Qt::BackgroundRole:
  case Qt::ForegroundRole:
    // The colours of the text tables in pictures, as grounds: they suit light and dark palettes.
    if (column == Value && (row.state == Info::WARNING || row.state == Info::ALARM)) {
      return role == Qt::ForegroundRole ? QColor(Qt::black)
             : row.state == Info::ALARM ? ToColor(session::AlarmColor)
                                        : ToColor(session::WarningColor);
    }
    return {};
  case Qt::ToolTipRole:
    return ToolTip(row);
  default:
    return {};
  }
}

QVariant TelemetryModel::headerData(int section, Qt::Orientation orientation, int role) const {
  if (orientation != Qt::Horizontal || section < 0 || section >= Columns) {
    return {};
  }
  static const char* const titles[Columns] = {"Name",   "Value",  "Unit",   "Alarm <",
                                              "Warn <", "Warn >", "Alarm >"};
  static const char* const tips[Columns] = {
      "Channel; drag it into a plot",
      "Last value; amber: beyond a warning limit, red: beyond an alarm limit",
      "Unit of the value and of the limits",
      "Values below are an alarm",
      "Values below are a warning",
      "Values above are a warning",
      "Values above are an alarm"};
  switch (role) {
  case Qt::DisplayRole:
    return QString(titles[section]);
  case Qt::ToolTipRole:
    return QString(tips[section]);
  case Qt::TextAlignmentRole:
    return int((section == Name || section == Unit ? Qt::AlignLeft : Qt::AlignRight) |
               Qt::AlignVCenter);
  default:
    return {};
  }
}

Qt::ItemFlags TelemetryModel::flags(const QModelIndex& index) const {
  return QAbstractTableModel::flags(index) |
         (index.isValid() ? Qt::ItemIsDragEnabled : Qt::NoItemFlags);
}

QStringList TelemetryModel::mimeTypes() const {
  return {ChannelMimeType};
}

QMimeData* TelemetryModel::mimeData(const QModelIndexList& indexes) const {
  QStringList names;
  std::set<int> seen;
  for (const QModelIndex& index : indexes) {
    if (seen.insert(index.row()).second) {
      names += this->Impl_->rows[std::size_t(index.row())].name;
    }
  }
  return MakeChannelMime(names);
}

} // namespace dspace::widgets
