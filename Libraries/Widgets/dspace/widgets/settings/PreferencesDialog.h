// The dialog of the preferences.
#ifndef DSPACE_WIDGETS_PREFERENCES_DIALOG_H
#define DSPACE_WIDGETS_PREFERENCES_DIALOG_H

#include <QDialog>

#include <dspace/widgets/settings/Preferences.h>

class QCheckBox;
class QComboBox;
class QSpinBox;

namespace dspace::widgets {

// OK and Apply tell what is chosen by chosen(); Cancel changes nothing that was not applied.
class PreferencesDialog : public QDialog {
  Q_OBJECT

public:
  explicit PreferencesDialog(const Preferences& shown, QWidget* parent = nullptr);
  Preferences Chosen() const;

signals:
  void chosen(const Preferences& preferences);

private:
  void Show(const Preferences& shown);

  QComboBox* Theme_;
  QSpinBox* Samples_;
  QComboBox* Navigation_;
  QComboBox* Length_;
  QComboBox* Angle_;
  QCheckBox* BodyFixed_;
  QCheckBox* Inertial_;
  QSpinBox* Recent_;
  QCheckBox* Restore_;
};

} // namespace dspace::widgets

#endif
