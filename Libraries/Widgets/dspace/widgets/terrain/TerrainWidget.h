// A widget that shows the terrains of a scene.
#ifndef DSPACE_WIDGETS_TERRAIN_WIDGET_H
#define DSPACE_WIDGETS_TERRAIN_WIDGET_H

#include <functional>
#include <string>

#include <QWidget>

#include <dspace/widgets/terrain/TerrainState.h>

class QComboBox;
class QLabel;
class QSlider;
class QStackedWidget;
class QTimer;
class QToolButton;

namespace dspace::widgets {

class LayerList;
class RampLegend;
class StyleEditor;

// A list of the terrains; of the chosen one the layers, a legend, and the style. While it is
// visible it looks for changes three times a second. It changes nothing itself: changeWanted()
// has the line of Python that makes a change, without the "SCENE." before it.
class TerrainWidget : public QWidget {
  Q_OBJECT

public:
  // Carries out a serialized command and returns the reply (vtkDspaceSession::Execute).
  using Executor = std::function<std::string(const std::string&)>;
  struct Shown {
    Executor execute; // empty: there is no scene
    std::string scene;
    bool canChange = true; // false: a recording, or the scene of a server
    bool busy = false;     // it is not asked now; what is shown stays
  };
  using Source = std::function<Shown()>;

  explicit TerrainWidget(QWidget* parent = nullptr);
  void SetSource(Source source);
  // Looks for changes now.
  void Refresh();
  QString Terrain() const; // the chosen one; "": none
  LayerList* Layers() const { return this->Layers_; }
  StyleEditor* Style() const { return this->Style_; }
  RampLegend* Legend() const { return this->Legend_; }
  // Of a file that the user has chosen, or the name of a field: "terrains[...].add_...".
  void AddLayer(const QString& kind, const QString& what);
  QSize sizeHint() const override { return {300, 520}; }

signals:
  void changeWanted(const QString& python);

protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;

private:
  static v1::Reply Ask(const Shown& shown, v1::Command& command);
  void ShowTerrains(const Shown& shown);
  TerrainState StateOf(const Shown& shown, const std::string& terrain) const;
  // Tells a change, and shows what came of it once the event that made it has ended.
  void Change(const QString& python);
  void ShowTerrain(const TerrainState& state);
  void ShowLegend(const TerrainState& state);
  void ShowSelected();
  void FillAddMenu();
  void ChooseFile(const QString& kind, const QString& filter);
  QString Path() const; // "terrains[...]"
  QString LayerPath(const QString& layer) const;

  Source Source_;
  TerrainState State_;
  std::string Seen_; // what is shown, to see changes
  QTimer* Timer_;
  QStackedWidget* Pages_;
  QComboBox* Terrains_;
  QLabel* About_;
  LayerList* Layers_;
  QSlider* Opacity_;
  QLabel* OpacityText_;
  QToolButton* Add_;
  QToolButton* Remove_;
  QToolButton* Up_;
  QToolButton* Down_;
  RampLegend* Legend_;
  StyleEditor* Style_;
};

} // namespace dspace::widgets

#endif
