// What is under the pointer: the object, its place, and what its terrain knows there.
#ifndef DSPACE_WIDGETS_POINTER_READOUT_H
#define DSPACE_WIDGETS_POINTER_READOUT_H

#include <map>
#include <string>

#include <QLabel>
#include <QPointer>
#include <QTimer>

class vtkObject;

namespace dspace::widgets {

class ViewportWidget;

// For a status bar. The pixel under the pointer is picked after the pointer moved and after each
// new picture of the view: at most ten times a second and a tenth of the time, from a picture that
// is drawn already, and not while a button is held. Of an object the label shows the name and the
// point in the root [m]; of terrain the map coordinates [m], longitude and latitude [deg], height
// above the vertical datum [m], slope [deg] and fields too; body-fixed and inertial coordinates
// where they are chosen (UnitChoice). Its text can be selected; its context menu copies it.
class PointerReadout : public QLabel {
  Q_OBJECT

public:
  explicit PointerReadout(QWidget* parent = nullptr);

  // From now on the pointer over the view of a viewport is followed.
  void Add(ViewportWidget* widget, vtkObject* of, const std::string& viewport);

  // Of a serialized Reply with a PickReply, and one with the terrain's slope there (may be empty).
  // "": nothing was hit. `all`: with the coordinates that are not chosen, too.
  static QString TextOf(const std::string& pick, const std::string& slope, bool all = false);

protected:
  bool eventFilter(QObject* watched, QEvent* event) override;
  void paintEvent(QPaintEvent* event) override; // a text that is too long ends in "..."

private:
  struct View {
    vtkObject* of;
    std::string viewport;
  };

  void Later(); // a look, unless one is due
  void Look();

  std::map<QObject*, View> Views_;
  QPointer<ViewportWidget> Over_; // the view that the pointer is over
  QPointF Place_;                 // in it
  QTimer Rest_;
  int Pause_ms_;         // before the next look
  bool Waiting_ = false; // for a new picture of the view
  bool Fresh_ = false;   // it has come
};

} // namespace dspace::widgets

#endif
