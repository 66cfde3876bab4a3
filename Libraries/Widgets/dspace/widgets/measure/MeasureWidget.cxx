#include <dspace/widgets/measure/MeasureWidget.h>

#include <algorithm>
#include <cmath>

#include <QClipboard>
#include <QFileDialog>
#include <QGridLayout>
#include <QGuiApplication>
#include <QHBoxLayout>
#include <QHeaderView>
#include <QJsonArray>
#include <QLabel>
#include <QPushButton>
#include <QTableWidget>
#include <QToolButton>
#include <QVBoxLayout>

#include <dspace/widgets/measure/ProfileChart.h>
#include <dspace/widgets/script/PythonText.h>
#include <dspace/widgets/settings/DisplayUnits.h>

namespace dspace::widgets {
namespace {

struct Kind {
  const char* name;
  const char* title;
  const char* tip;
  std::size_t least; // points
  std::size_t most;  // 0: any number
};
constexpr Kind Kinds[] = {
    {"line", "Line", "Distances, azimuths and slopes between points, and the profile of the ground",
     2, 0},
    {"area", "Area", "The area of a polygon, and the ground within it", 3, 0},
    {"angle", "Angle", "The angle at the second of three points", 3, 3},
};

const Kind* Find(const QString& name) {
  const auto* found = std::find_if(std::begin(Kinds), std::end(Kinds),
                                   [&](const Kind& kind) { return name == kind.name; });
  return found == std::end(Kinds) ? nullptr : found;
}

MeasureWidget::Point PointOf(const QJsonValue& value) {
  const QJsonArray row = value.toArray();
  return {row[0].toDouble(NAN), row[1].toDouble(NAN), row[2].toDouble(NAN)};
}

// A value in the units of the preferences.
QString ValueText(const QJsonValue& value, const QString& what) {
  const UnitChoice& units = DisplayUnits::The().Get();
  if (!value.isDouble()) {
    return QObject::tr("no data");
  }
  const double number = value.toDouble();
  if (what == "angle") {
    const QString unit = units.AngleUnit();
    return QString::number(number * units.AngleFactor(), 'f', units.AngleDecimals(4)) +
           (unit.size() == 1 ? unit : ' ' + unit);
  }
  if (what == "area") {
    const double factor = units.LengthFactor() * units.LengthFactor();
    return QString::number(number * factor, 'g', 9) + ' ' + units.LengthUnit() + QChar(0xb2);
  }
  if (what == "share") {
    return QString::number(100.0 * number, 'f', 1) + QStringLiteral(" %");
  }
  return QString::number(number * units.LengthFactor(), 'f', units.LengthDecimals(3)) + ' ' +
         units.LengthUnit();
}

} // namespace

MeasureWidget::MeasureWidget(QWidget* parent) : QWidget(parent) {
  auto* column = new QVBoxLayout(this);
  auto* bar = new QHBoxLayout;
  for (const Kind& kind : Kinds) {
    auto* tool = new QToolButton(this);
    tool->setText(tr(kind.title));
    tool->setToolTip(tr(kind.tip));
    tool->setObjectName(QString("tool ") + kind.name);
    tool->setCheckable(true);
    connect(tool, &QToolButton::clicked, this,
            [this, name = QString(kind.name)](bool on) { this->Use(on ? name : QString()); });
    bar->addWidget(tool);
    this->Tools_.push_back(tool);
  }
  bar->addStretch();
  column->addLayout(bar);
  this->Hint_ = new QLabel(this);
  this->Hint_->setWordWrap(true);
  column->addWidget(this->Hint_);
  this->Table_ = new QTableWidget(0, 2, this);
  this->Table_->setObjectName(QStringLiteral("results"));
  this->Table_->setAccessibleName(tr("Results"));
  this->Table_->horizontalHeader()->hide();
  this->Table_->verticalHeader()->hide();
  this->Table_->horizontalHeader()->setSectionResizeMode(0, QHeaderView::Stretch);
  this->Table_->horizontalHeader()->setSectionResizeMode(1, QHeaderView::ResizeToContents);
  this->Table_->setEditTriggers(QAbstractItemView::NoEditTriggers);
  this->Table_->setShowGrid(false);
  column->addWidget(this->Table_, 1);
  this->Chart_ = new ProfileChart(this);
  column->addWidget(this->Chart_, 1);
  auto* grid = new QGridLayout; // two by two: the dock may be narrow
  const auto button = [&](const QString& text, const QString& name, const QString& tip) {
    auto* made = new QPushButton(text, this);
    made->setObjectName(name);
    made->setToolTip(tip);
    grid->addWidget(made, grid->count() / 2, grid->count() % 2);
    return made;
  };
  this->Last_ = button(tr("Remove last"), "last", tr("Removes the last point"));
  this->Clear_ = button(tr("Clear"), "clear", tr("Removes all points"));
  this->Copy_ = button(tr("Copy"), "copy", tr("Copies the results as text"));
  this->Save_ = button(tr("Save profile..."), "save", tr("Writes the profile as a table (CSV)"));
  column->addLayout(grid);
  connect(this->Last_, &QPushButton::clicked, this, &MeasureWidget::RemoveLast);
  connect(this->Clear_, &QPushButton::clicked, this, &MeasureWidget::Clear);
  connect(this->Copy_, &QPushButton::clicked, this,
          [this] { QGuiApplication::clipboard()->setText(this->Text()); });
  connect(this->Save_, &QPushButton::clicked, this, [this] {
    const QString path =
        QFileDialog::getSaveFileName(this, tr("Save profile"), QString(), tr("Table (*.csv)"));
    if (!path.isEmpty()) {
      emit this->saveWanted(path);
    }
  });
  connect(this->Chart_, &ProfileChart::pointed, this, &MeasureWidget::marksChanged);
  connect(&DisplayUnits::The(), &DisplayUnits::changed, this, &MeasureWidget::ShowRows);
  this->Restart();
}

void MeasureWidget::Use(const QString& tool) {
  if (tool == this->Tool_) {
    return;
  }
  this->Tool_ = Find(tool) ? tool : QString();
  for (std::size_t i = 0; i < this->Tools_.size(); ++i) {
    this->Tools_[i]->setChecked(this->Tool_ == Kinds[i].name);
  }
  if (!this->Tool_.isEmpty()) { // the results stay when the tool is put down
    this->Restart();
  } else {
    this->ShowRows();
  }
  emit this->toolChanged();
}

void MeasureWidget::Restart() {
  this->Points_.clear();
  this->Path_.clear();
  this->Terrain_.clear();
  this->Result_ = {};
  this->Chart_->SetProfile({}, {});
  this->ShowRows();
  emit this->marksChanged();
}

void MeasureWidget::Add(const Point& point, const QString& terrain) {
  const Kind* kind = Find(this->Tool_);
  if (!kind) {
    return;
  }
  if (kind->most > 0 && this->Points_.size() >= kind->most) {
    this->Restart();
  }
  if (this->Terrain_.isEmpty()) {
    this->Terrain_ = terrain;
  }
  this->Points_.push_back(point);
  this->Ask();
}

void MeasureWidget::RemoveLast() {
  if (!this->Points_.empty()) {
    this->Points_.pop_back();
    this->Ask();
  }
}

void MeasureWidget::Clear() {
  this->Restart();
}

void MeasureWidget::Ask() {
  const Kind* kind = Find(this->Tool_);
  this->Result_ = {};
  this->Path_ = this->Points_;
  this->Chart_->SetProfile({}, {});
  if (kind && this->Points_.size() >= kind->least) {
    QStringList points;
    for (const Point& point : this->Points_) {
      points << QStringLiteral("(%1, %2, %3)")
                    .arg(PythonOf(point[0]), PythonOf(point[1]), PythonOf(point[2]));
    }
    const QString terrain = this->Terrain_.isEmpty() || this->Tool_ == "angle"
                                ? QString()
                                : ", terrain=" + Quoted(this->Terrain_);
    emit this->measureWanted(QStringLiteral("app.measure(%1, [%2]%3)")
                                 .arg(Quoted(this->Tool_), points.join(", "), terrain));
  }
  this->ShowRows();
  emit this->marksChanged();
}

void MeasureWidget::Show(const QJsonObject& result) {
  this->Result_ = result;
  this->Points_.clear();
  for (const QJsonValue& value : result["points"].toArray()) {
    this->Points_.push_back(PointOf(value));
  }
  this->Path_ = this->Points_;
  const QJsonObject profile = result["profile"].toObject();
  std::vector<double> distances;
  std::vector<double> heights;
  if (!profile.isEmpty()) {
    this->Path_.clear();
    for (const QJsonValue& value : profile["distance"].toArray()) {
      distances.push_back(value.toDouble(NAN));
    }
    for (const QJsonValue& value : profile["height"].toArray()) {
      heights.push_back(value.toDouble(NAN));
    }
    for (const QJsonValue& value : profile["point"].toArray()) {
      this->Path_.push_back(PointOf(value));
    }
  }
  this->Chart_->SetProfile(std::move(distances), std::move(heights));
  this->ShowRows();
  emit this->marksChanged();
}

bool MeasureWidget::IsClosed() const {
  const QString kind = this->Result_.isEmpty() ? this->Tool_ : this->Result_["kind"].toString();
  return kind == "area" && this->Points_.size() > 2;
}

const MeasureWidget::Point* MeasureWidget::Pointed() const {
  const int sample = this->Chart_->Pointed();
  return sample >= 0 && std::size_t(sample) < this->Path_.size() ? &this->Path_[std::size_t(sample)]
                                                                 : nullptr;
}

void MeasureWidget::ShowRows() {
  const QJsonArray rows = this->Result_["rows"].toArray();
  this->Table_->setRowCount(int(rows.size()));
  for (int i = 0; i < int(rows.size()); ++i) {
    const QJsonArray row = rows[i].toArray();
    this->Table_->setItem(i, 0, new QTableWidgetItem(row[0].toString()));
    auto* value = new QTableWidgetItem(ValueText(row[1], row[2].toString()));
    value->setTextAlignment(Qt::AlignRight | Qt::AlignVCenter);
    this->Table_->setItem(i, 1, value);
  }
  this->Table_->resizeRowsToContents();
  const Kind* kind = Find(this->Tool_);
  const std::size_t count = this->Points_.size();
  QString hint;
  if (!kind) {
    hint = rows.isEmpty() ? tr("Choose a tool, then click on points in a view") : QString();
  } else if (count < kind->least) {
    hint = tr("Click on point %1 of %2 in a view; Escape ends").arg(count + 1).arg(kind->least);
  } else if (rows.isEmpty()) {
    hint = tr("These points cannot be measured: see the notice above the views");
  } else {
    hint = kind->most > 0 ? tr("The next click starts anew; Escape ends")
                          : tr("Each click adds a point; Escape ends");
  }
  this->Hint_->setText(hint);
  this->Hint_->setVisible(!hint.isEmpty());
  this->Last_->setEnabled(kind && count > 0);
  this->Clear_->setEnabled(count > 0);
  this->Copy_->setEnabled(!rows.isEmpty());
  this->Save_->setEnabled(this->Chart_->SampleCount() > 1);
}

QString MeasureWidget::Text() const {
  QStringList lines;
  for (const QJsonValue& value : this->Result_["rows"].toArray()) {
    const QJsonArray row = value.toArray();
    lines << row[0].toString() + '\t' + ValueText(row[1], row[2].toString());
  }
  return lines.join('\n');
}

} // namespace dspace::widgets
