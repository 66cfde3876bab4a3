// A dialog for the export of a movie.
#ifndef DSPACE_WIDGETS_EXPORT_DIALOG_H
#define DSPACE_WIDGETS_EXPORT_DIALOG_H

#include <QDialog>
#include <QJsonArray>

class QComboBox;
class QDialogButtonBox;
class QDoubleSpinBox;
class QLabel;
class QLineEdit;
class QSpinBox;

namespace dspace::widgets {

class ExportDialog : public QDialog {
  Q_OBJECT

public:
  // Of the movie; `size`: width and height [pixels], `rate`: pictures a second.
  ExportDialog(const QJsonArray& size, double rate, int samples, double duration_s,
               QWidget* parent = nullptr);

  // The line of Python.
  QString Line() const;

private:
  void Check();

  double Duration_s;
  QLineEdit* Path_;
  QComboBox* Size_;
  QDoubleSpinBox* Rate_;
  QSpinBox* Samples_;
  QSpinBox* Jobs_;
  QLabel* Note_;
  QDialogButtonBox* Buttons_;
};

} // namespace dspace::widgets

#endif
