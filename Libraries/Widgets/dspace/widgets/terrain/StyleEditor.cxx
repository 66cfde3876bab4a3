#include <dspace/widgets/terrain/StyleEditor.h>

#include <algorithm>
#include <cmath>
#include <initializer_list>

#include <QCheckBox>
#include <QColorDialog>
#include <QComboBox>
#include <QDoubleSpinBox>
#include <QFormLayout>
#include <QHBoxLayout>
#include <QLabel>
#include <QPushButton>
#include <QSignalBlocker>
#include <QToolButton>

#include <dspace/widgets/script/PythonText.h>

namespace dspace::widgets {
namespace {

const char* const Kinds[] = {"height", "slope", "aspect", "normal"}; // of StyleTerrain.Ramp.By
const char* const ColorProperty = "color";

QDoubleSpinBox* MakeNumber(double low, double high, const QString& tip) {
  auto* box = new QDoubleSpinBox;
  box->setDecimals(3);
  box->setRange(low, high);
  box->setStepType(QAbstractSpinBox::AdaptiveDecimalStepType);
  box->setKeyboardTracking(false); // once it is entered, not at every key
  box->setToolTip(tip);
  box->setMinimumWidth(70); // the largest number would need far more
  return box;
}

void SetColor(QToolButton* button, const QColor& color) {
  button->setProperty(ColorProperty, color);
  QPixmap picture(14, 14);
  picture.fill(color);
  button->setIcon(QIcon(picture));
}

} // namespace

StyleEditor::StyleEditor(QWidget* parent) : QWidget(parent) {
  auto* form = new QFormLayout(this);
  form->setContentsMargins(4, 4, 4, 4);
  form->setFieldGrowthPolicy(QFormLayout::AllNonFixedFieldsGrow);
  this->By_ = new QComboBox;
  this->By_->setObjectName(QStringLiteral("ramp"));
  this->By_->addItem(tr("none"));
  this->By_->addItem(tr("height [m]"));
  this->By_->addItem(tr("slope [deg]"));
  this->By_->addItem(tr("aspect [deg]"));
  this->By_->addItem(tr("normals"));
  this->By_->setToolTip(tr("What the ground is coloured by"));
  form->addRow(tr("Colour by"), this->By_);
  this->Low_ = MakeNumber(-1e9, 1e9, tr("The value of the first colour"));
  this->Low_->setObjectName(QStringLiteral("low"));
  this->High_ = MakeNumber(-1e9, 1e9, tr("The value of the last colour"));
  this->High_->setObjectName(QStringLiteral("high"));
  this->Opacity_ = MakeNumber(0.0, 1.0, tr("The opacity of these colours, 0 to 1"));
  this->Opacity_->setObjectName(QStringLiteral("ramp opacity"));
  this->Opacity_->setDecimals(2);
  this->Opacity_->setSingleStep(0.1);
  this->Opacity_->setValue(1.0);
  auto* range = new QHBoxLayout;
  range->addWidget(this->Low_);
  range->addWidget(new QLabel(tr("to")));
  range->addWidget(this->High_);
  form->addRow(tr("Range"), range);
  form->addRow(tr("Opacity"), this->Opacity_);
  this->Contours_ =
      this->MakeLines(QStringLiteral("contours"), tr("Metres of height between lines"));
  auto* row = new QHBoxLayout;
  row->addWidget(this->Contours_.shown);
  row->addWidget(this->Contours_.interval, 1);
  row->addWidget(this->Contours_.color);
  form->addRow(tr("Contours [m]"), row);
  this->Grid_ =
      this->MakeLines(QStringLiteral("grid"), tr("Map units between lines, on a body degrees"));
  row = new QHBoxLayout;
  row->addWidget(this->Grid_.shown);
  row->addWidget(this->Grid_.interval, 1);
  row->addWidget(this->Grid_.color);
  form->addRow(tr("Grid"), row);
  this->Labels_ = new QCheckBox(tr("with values"));
  this->Labels_->setObjectName(QStringLiteral("grid labels"));
  form->addRow(QString(), this->Labels_);
  this->Levels_ = new QCheckBox(tr("levels of detail"));
  this->Levels_->setObjectName(QStringLiteral("levels"));
  this->Levels_->setToolTip(tr("A colour for each level of the clipmap"));
  form->addRow(tr("Show"), this->Levels_);
  this->Azimuth_ = MakeNumber(0.0, 360.0, tr("Where the Sun stands, degrees clockwise from north"));
  this->Azimuth_->setObjectName(QStringLiteral("azimuth"));
  this->Azimuth_->setDecimals(1);
  this->Azimuth_->setSuffix(tr("°"));
  this->Azimuth_->setValue(315.0);
  this->Elevation_ = MakeNumber(-90.0, 90.0, tr("How high the Sun stands, degrees"));
  this->Elevation_->setObjectName(QStringLiteral("elevation"));
  this->Elevation_->setDecimals(1);
  this->Elevation_->setSuffix(tr("°"));
  this->Elevation_->setValue(45.0);
  this->Sun_ = new QPushButton(tr("Set"));
  this->Sun_->setObjectName(QStringLiteral("sun"));
  this->Sun_->setMaximumWidth(this->Sun_->fontMetrics().horizontalAdvance(this->Sun_->text()) + 24);
  this->Sun_->setToolTip(tr("Shades the hills by a Sun there (the Sun of the scene)"));
  row = new QHBoxLayout;
  row->addWidget(this->Azimuth_, 1);
  row->addWidget(this->Elevation_, 1);
  row->addWidget(this->Sun_);
  form->addRow(tr("Move Sun to"), row);

  connect(this->By_, &QComboBox::activated, this, [this](int index) {
    if (index == 0) {
      emit this->styleWanted(QStringLiteral("color_by=None"));
    } else { // with the range of its own
      emit this->styleWanted(QStringLiteral("color_by=%1, opacity=%2")
                                 .arg(Quoted(QString::fromLatin1(Kinds[index - 1])),
                                      PythonOf(this->Opacity_->value())));
    }
  });
  for (QDoubleSpinBox* box : {this->Low_, this->High_}) {
    connect(box, &QDoubleSpinBox::valueChanged, this, [this] { this->TellRange(); });
  }
  connect(this->Opacity_, &QDoubleSpinBox::valueChanged, this, [this](double value) {
    emit this->styleWanted(QStringLiteral("opacity=") + PythonOf(value));
  });
  const auto follow = [this](const Lines& lines, const QString& argument) {
    connect(lines.shown, &QCheckBox::toggled, this,
            [this, lines, argument] { this->TellLines(lines, argument); });
    connect(lines.interval, &QDoubleSpinBox::valueChanged, this, [this, lines, argument] {
      if (lines.shown->isChecked()) {
        this->TellLines(lines, argument);
      }
    });
    connect(lines.color, &QToolButton::clicked, this, [this, lines, argument] {
      auto* dialog = new QColorDialog(lines.color->property(ColorProperty).value<QColor>(), this);
      dialog->setAttribute(Qt::WA_DeleteOnClose);
      connect(dialog, &QColorDialog::colorSelected, this,
              [this, lines, argument](const QColor& color) {
                SetColor(lines.color, color);
                if (lines.shown->isChecked()) {
                  this->TellLines(lines, argument);
                }
              });
      dialog->open();
    });
  };
  follow(this->Contours_, QStringLiteral("contours"));
  follow(this->Grid_, QStringLiteral("grid"));
  connect(this->Labels_, &QCheckBox::toggled, this, [this](bool on) {
    emit this->styleWanted(QStringLiteral("grid_labels=") + PythonOf(on));
  });
  connect(this->Levels_, &QCheckBox::toggled, this, [this](bool on) {
    emit this->styleWanted(on ? QStringLiteral("levels=0.5") : QStringLiteral("levels=None"));
  });
  connect(this->Sun_, &QPushButton::clicked, this,
          [this] { emit this->sunWanted(this->Azimuth_->value(), this->Elevation_->value()); });
}

StyleEditor::Lines StyleEditor::MakeLines(const QString& name, const QString& tip) {
  Lines lines{new QCheckBox, MakeNumber(0.001, 1e9, tip), new QToolButton};
  lines.shown->setObjectName(name);
  lines.shown->setAccessibleName(name);
  lines.interval->setObjectName(name + QStringLiteral(" interval"));
  lines.interval->setValue(10.0);
  lines.color->setToolTip(tr("The colour of the lines"));
  SetColor(lines.color, Qt::black);
  return lines;
}

double StyleEditor::Exact(const QDoubleSpinBox* box, double known) {
  const double step = std::pow(10.0, -box->decimals());
  return std::abs(box->value() - known) < 0.51 * step ? known : box->value();
}

void StyleEditor::TellRange() {
  emit this->styleWanted(QStringLiteral("range=(%1, %2)")
                             .arg(PythonOf(Exact(this->Low_, this->Ramp_.low())),
                                  PythonOf(Exact(this->High_, this->Ramp_.high()))));
}

void StyleEditor::TellLines(const Lines& lines, const QString& argument) {
  if (!lines.shown->isChecked()) {
    emit this->styleWanted(argument + QStringLiteral("=None"));
    return;
  }
  emit this->styleWanted(
      QStringLiteral("%1={\"interval\": %2, \"color\": %3}")
          .arg(argument, PythonOf(lines.interval->value()),
               Quoted(lines.color->property(ColorProperty).value<QColor>().name())));
}

void StyleEditor::ShowLines(const Lines& lines, bool shown, const v1::StyleTerrain::Lines& from) {
  const QSignalBlocker silent[] = {QSignalBlocker(lines.shown), QSignalBlocker(lines.interval)};
  lines.shown->setChecked(shown);
  if (shown) {
    lines.interval->setValue(from.interval());
    SetColor(lines.color, QColor::fromRgbF(float(from.color().r()), float(from.color().g()),
                                           float(from.color().b())));
  }
}

void StyleEditor::Show(const TerrainState& state) {
  const bool styled = state.layered && state.canChange;
  for (QWidget* each : std::initializer_list<QWidget*>{
           this->By_, this->Contours_.shown, this->Contours_.interval, this->Contours_.color,
           this->Grid_.shown, this->Grid_.interval, this->Grid_.color, this->Levels_}) {
    each->setEnabled(styled);
  }
  for (QWidget* each :
       std::initializer_list<QWidget*>{this->Azimuth_, this->Elevation_, this->Sun_}) {
    each->setEnabled(state.canChange);
  }
  this->setToolTip(state.layered ? QString()
                                 : tr("Terrain drawn as triangles has no style: open it with "
                                      "mode=\"clipmap\""));
  const v1::StyleTerrain& style = state.style;
  const QSignalBlocker silent[] = {QSignalBlocker(this->By_),     QSignalBlocker(this->Low_),
                                   QSignalBlocker(this->High_),   QSignalBlocker(this->Opacity_),
                                   QSignalBlocker(this->Labels_), QSignalBlocker(this->Levels_)};
  this->Ramp_ = style.ramp();
  const bool ramp = style.has_ramp();
  this->By_->setCurrentIndex(ramp ? int(style.ramp().by()) + 1 : 0);
  const bool ranged = ramp && style.ramp().by() != v1::StyleTerrain::Ramp::NORMAL;
  this->Low_->setEnabled(styled && ranged);
  this->High_->setEnabled(styled && ranged);
  this->Opacity_->setEnabled(styled && ramp);
  if (ranged) {
    this->Low_->setValue(style.ramp().low());
    this->High_->setValue(style.ramp().high());
  }
  if (ramp) {
    this->Opacity_->setValue(style.ramp().opacity());
  }
  ShowLines(this->Contours_, style.has_contours(), style.contours());
  ShowLines(this->Grid_, style.has_grid(), style.grid());
  this->Labels_->setEnabled(styled && style.has_grid());
  this->Labels_->setChecked(style.has_grid_labels());
  this->Levels_->setChecked(style.has_levels() && style.levels() > 0.0);
}

} // namespace dspace::widgets
