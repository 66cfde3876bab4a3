#include <dspace/widgets/settings/PreferencesDialog.h>

#include <algorithm>

#include <QCheckBox>
#include <QComboBox>
#include <QDialogButtonBox>
#include <QFormLayout>
#include <QPushButton>
#include <QSpinBox>
#include <QVBoxLayout>

namespace dspace::widgets {
namespace {

void Choose(QComboBox* box, const QString& word) {
  box->setCurrentIndex(std::max(0, box->findData(word)));
}

} // namespace

PreferencesDialog::PreferencesDialog(const Preferences& shown, QWidget* parent)
    : QDialog(parent), Theme_(new QComboBox), Samples_(new QSpinBox), Navigation_(new QComboBox),
      Length_(new QComboBox), Angle_(new QComboBox),
      BodyFixed_(new QCheckBox(tr("Show &body-fixed coordinates under the pointer"))),
      Inertial_(new QCheckBox(tr("Show &inertial coordinates (J2000) under the pointer"))),
      Recent_(new QSpinBox),
      Restore_(new QCheckBox(tr("&Restore the docks of the last time at start"))) {
  this->setWindowTitle(tr("Preferences"));
  this->Theme_->addItem(tr("As the desktop"), WordOf(Theme::System));
  this->Theme_->addItem(tr("Dark"), WordOf(Theme::Dark));
  this->Theme_->addItem(tr("Light"), WordOf(Theme::Light));
  this->Theme_->setToolTip(tr("Colours of all windows, docks and plots"));
  this->Samples_->setRange(1, Preferences::MostSamples);
  this->Samples_->setToolTip(tr("Samples a pixel along each side, of new views (1 to %1): 2 takes "
                                "four times the work of 1")
                                 .arg(Preferences::MostSamples));
  this->Navigation_->addItem(tr("Orbit about a point"), QStringLiteral("orbit"));
  this->Navigation_->addItem(tr("Walk on the ground"), QStringLiteral("walk"));
  this->Navigation_->addItem(tr("Map that does not turn"), QStringLiteral("map"));
  this->Navigation_->setToolTip(tr("How the mouse and keys move the camera of new views"));
  this->Length_->addItem(tr("metres (m)"), UnitChoice::WordOf(UnitChoice::Length::Metre));
  this->Length_->addItem(tr("kilometres (km)"), UnitChoice::WordOf(UnitChoice::Length::Kilometre));
  this->Length_->setToolTip(tr("The unit of lengths that docks show; Python keeps metres"));
  this->Angle_->addItem(tr("degrees"), UnitChoice::WordOf(UnitChoice::Angle::Degree));
  this->Angle_->addItem(tr("radians (rad)"), UnitChoice::WordOf(UnitChoice::Angle::Radian));
  this->Angle_->setToolTip(tr("The unit of angles that docks show; Python keeps degrees"));
  this->BodyFixed_->setToolTip(
      tr("On terrain: from the body's centre, Z to its north pole, X to longitude 0"));
  this->Inertial_->setToolTip(
      tr("On terrain: from the body's centre in the axes of J2000, at the scene's time"));
  this->Recent_->setRange(0, Preferences::MostRecentFiles);
  this->Recent_->setToolTip(
      tr("Files in the menu Open recent (0 to %1)").arg(Preferences::MostRecentFiles));
  this->Restore_->setToolTip(tr("Docks, their sizes, and the window's place"));
  auto* form = new QFormLayout;
  form->addRow(tr("&Theme"), this->Theme_);
  form->addRow(tr("&Samples of new views"), this->Samples_);
  form->addRow(tr("&Navigation of new views"), this->Navigation_);
  form->addRow(tr("&Lengths"), this->Length_);
  form->addRow(tr("&Angles"), this->Angle_);
  form->addRow(this->BodyFixed_);
  form->addRow(this->Inertial_);
  form->addRow(tr("Recent &files"), this->Recent_);
  form->addRow(this->Restore_);
  auto* buttons = new QDialogButtonBox(QDialogButtonBox::Ok | QDialogButtonBox::Cancel |
                                       QDialogButtonBox::Apply | QDialogButtonBox::RestoreDefaults);
  connect(buttons, &QDialogButtonBox::accepted, this, [this] {
    emit this->chosen(this->Chosen());
    this->accept();
  });
  connect(buttons, &QDialogButtonBox::rejected, this, &QDialog::reject);
  connect(buttons->button(QDialogButtonBox::Apply), &QPushButton::clicked, this,
          [this] { emit this->chosen(this->Chosen()); });
  connect(buttons->button(QDialogButtonBox::RestoreDefaults), &QPushButton::clicked, this,
          [this] { this->Show(Preferences()); });
  auto* all = new QVBoxLayout(this);
  all->addLayout(form);
  all->addStretch();
  all->addWidget(buttons);
  // Tab goes through the controls, then through the buttons from left to right. Without this order
  // it reaches one of the buttons only.
  QWidget* last = this->Theme_;
  QList<QWidget*> order{this->Samples_,   this->Navigation_, this->Length_, this->Angle_,
                        this->BodyFixed_, this->Inertial_,   this->Recent_, this->Restore_};
  for (int i = 0; i < buttons->layout()->count(); ++i) {
    order << buttons->layout()->itemAt(i)->widget(); // null: a space
  }
  for (QWidget* each : order) {
    if (each) {
      QWidget::setTabOrder(last, each);
      last = each;
    }
  }
  this->Show(shown);
}

void PreferencesDialog::Show(const Preferences& shown) {
  Choose(this->Theme_, WordOf(shown.theme));
  this->Samples_->setValue(shown.samples);
  Choose(this->Navigation_, shown.navigation);
  Choose(this->Length_, UnitChoice::WordOf(shown.units.length));
  Choose(this->Angle_, UnitChoice::WordOf(shown.units.angle));
  this->BodyFixed_->setChecked(shown.units.bodyFixed);
  this->Inertial_->setChecked(shown.units.inertial);
  this->Recent_->setValue(shown.recentFiles);
  this->Restore_->setChecked(shown.restoreLayout);
}

Preferences PreferencesDialog::Chosen() const {
  Preferences chosen;
  chosen.theme = ThemeOf(this->Theme_->currentData().toString()).value_or(chosen.theme);
  chosen.samples = this->Samples_->value();
  chosen.navigation = this->Navigation_->currentData().toString();
  chosen.units.length =
      UnitChoice::LengthOf(this->Length_->currentData().toString()).value_or(chosen.units.length);
  chosen.units.angle =
      UnitChoice::AngleOf(this->Angle_->currentData().toString()).value_or(chosen.units.angle);
  chosen.units.bodyFixed = this->BodyFixed_->isChecked();
  chosen.units.inertial = this->Inertial_->isChecked();
  chosen.recentFiles = this->Recent_->value();
  chosen.restoreLayout = this->Restore_->isChecked();
  return chosen;
}

} // namespace dspace::widgets
