// What is drawn over a terrain's own colour.
#ifndef DSPACE_WIDGETS_STYLE_EDITOR_H
#define DSPACE_WIDGETS_STYLE_EDITOR_H

#include <QWidget>

#include <dspace/widgets/terrain/TerrainState.h>

class QCheckBox;
class QComboBox;
class QDoubleSpinBox;
class QPushButton;
class QToolButton;

namespace dspace::widgets {

// The ramp (height, slope, aspect, normals), contour lines, the grid with its labels, the colours
// of a clipmap's levels, and the Sun's direction, whose light shades the ground. It changes nothing
// itself: its signals have the arguments of Terrain.change_style(), and those of scene.sun.set().
class StyleEditor : public QWidget {
  Q_OBJECT

public:
  explicit StyleEditor(QWidget* parent = nullptr);
  void Show(const TerrainState& state);

signals:
  void styleWanted(const QString& arguments); // "contours={...}"
  void sunWanted(double azimuth_deg, double elevation_deg);

private:
  struct Lines {
    QCheckBox* shown;
    QDoubleSpinBox* interval;
    QToolButton* color;
  };
  Lines MakeLines(const QString& name, const QString& tip);
  void TellRange();
  void TellLines(const Lines& lines, const QString& argument);
  static void ShowLines(const Lines& lines, bool shown, const v1::StyleTerrain::Lines& from);

  // The number of a box, or the exact one that the box shows rounded.
  static double Exact(const QDoubleSpinBox* box, double known);

  v1::StyleTerrain::Ramp Ramp_; // as it is drawn
  QComboBox* By_;
  QDoubleSpinBox* Low_;
  QDoubleSpinBox* High_;
  QDoubleSpinBox* Opacity_;
  QCheckBox* Levels_;
  QCheckBox* Labels_;
  Lines Contours_;
  Lines Grid_;
  QDoubleSpinBox* Azimuth_;
  QDoubleSpinBox* Elevation_;
  QPushButton* Sun_;
};

} // namespace dspace::widgets

#endif
