// A dialog for a camera key frame.
#ifndef DSPACE_WIDGETS_KEY_DIALOG_H
#define DSPACE_WIDGETS_KEY_DIALOG_H

#include <QDialog>
#include <QJsonObject>
#include <QStringList>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;

namespace dspace::widgets {

// Shows a key as MovieTrack::Handle() describes it. `next`: the one after it; empty: it is the
// last.
class KeyDialog : public QDialog {
  Q_OBJECT

public:
  KeyDialog(int key, const QJsonObject& given, const QJsonObject& next, QWidget* parent = nullptr);

  // Lines of Python for what the user changed, in the order in which they are valid.
  QStringList Lines() const;

private:
  int Key_;
  QJsonObject Given_;
  double SpanBefore_ = 0.0; // [s] of the movie to the next key
  bool Frozen_ = false;     // the run stands still meanwhile
  QDoubleSpinBox* Run_;
  QDoubleSpinBox* Span_;
  QDoubleSpinBox* Freeze_;
  QDoubleSpinBox* Lens_;
  QComboBox* Easing_;
  QCheckBox* Cut_;
};

} // namespace dspace::widgets

#endif
