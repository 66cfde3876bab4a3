// The tree view of a SceneTreeModel.
#ifndef DSPACE_WIDGETS_SCENE_TREE_VIEW_H
#define DSPACE_WIDGETS_SCENE_TREE_VIEW_H

#include <utility>
#include <vector>

#include <QTreeView>

#include <dspace/widgets/scene/SceneTreeModel.h>

namespace dspace::widgets {

// A click on an eye, or Space, asks to show or hide the row; clicks on eyes select nothing. Changed
// rows are painted only where they are in view.
class SceneTreeView : public QTreeView {
  Q_OBJECT

public:
  explicit SceneTreeView(SceneTreeModel* model, QWidget* parent = nullptr);
  // Paintings so far.
  int Paintings() const { return this->Paintings_; }

  void dataChanged(const QModelIndex& topLeft, const QModelIndex& bottomRight,
                   const QList<int>& roles = {}) override;

signals:
  void eyeClicked(const QModelIndex& index);

protected:
  void paintEvent(QPaintEvent* event) override;
  void resizeEvent(QResizeEvent* event) override;
  void mousePressEvent(QMouseEvent* event) override;
  void mouseDoubleClickEvent(QMouseEvent* event) override;
  void mouseReleaseEvent(QMouseEvent* event) override;
  void keyPressEvent(QKeyEvent* event) override;

private:
  // Gives names their room: what the other columns leave, or what those in view need, and then the
  // tree scrolls sideways.
  void FitNames();
  bool OnEye(const QMouseEvent& event);

  // The rows in view when it was last painted: their parent's node and their number, sorted.
  std::vector<std::pair<const void*, int>> InView_;
  bool Painted_ = false; // and no painting is due
  bool EyePressed_ = false;
  bool Fitting_ = false;
  int Paintings_ = 0;
};

} // namespace dspace::widgets

#endif
