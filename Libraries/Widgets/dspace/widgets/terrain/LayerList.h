// The layers of a terrain, top first.
#ifndef DSPACE_WIDGETS_LAYER_LIST_H
#define DSPACE_WIDGETS_LAYER_LIST_H

#include <QTreeWidget>

#include <dspace/proto/layers.pb.h>

namespace dspace::widgets {

// A row a layer: a check box (whether it is visible), its name, its kind and its opacity. Rows are
// dragged to their new place, or moved by Alt+Up and Alt+Down; Delete removes. It changes nothing
// itself.
class LayerList : public QTreeWidget {
  Q_OBJECT

public:
  explicit LayerList(QWidget* parent = nullptr);

  // Keeps the selected layer by its name. `canChange` false: rows are only shown.
  void Show(const v1::TerrainLayerList& layers, bool canChange = true);
  QString Selected() const; // "": none
  void Select(const QString& name);
  static QString KindText(int kind);
  QSize sizeHint() const override; // a few rows

signals:
  void visibleWanted(const QString& name, bool visible);
  void positionWanted(const QString& name, int position); // from the bottom, 0
  void removeWanted(const QString& name);

protected:
  void dropEvent(QDropEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

private:
  void Move(int row, int to);

  bool CanChange_ = true;
};

} // namespace dspace::widgets

#endif
