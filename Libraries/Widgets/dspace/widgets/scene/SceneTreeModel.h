// The frames and objects of a scene as rows of a tree view.
#ifndef DSPACE_WIDGETS_SCENE_TREE_MODEL_H
#define DSPACE_WIDGETS_SCENE_TREE_MODEL_H

#include <functional>
#include <memory>

#include <QAbstractItemModel>

#include <dspace/scene/Scene.h>
#include <dspace/widgets/scene/SceneRequest.h>

namespace dspace::widgets {

// The root frame is the only row at the top. The rows below a frame are its objects by id, then its
// child frames in their order. They are made when a view opens the frame.
// The model reads the scene in the thread of the GUI, in which the scene must change, too. Changes
// are shown by Refresh(): it emits signals only for rows that changed.
class SceneTreeModel : public QAbstractItemModel {
  Q_OBJECT

public:
  enum Column { NameColumn, VisibleColumn, NatureColumn, KindColumn, ColumnCount };
  enum Role { EyeRole = Qt::UserRole, IconRole, DimmedRole };
  // None: a frame without objects on it and below. Mixed: some of them are visible.
  enum class Eye { None, Hidden, Mixed, Visible };
  enum class Icon { Frame, Mesh, Lines, Points, Label, Drawn, Empty };

  explicit SceneTreeModel(QObject* parent = nullptr);
  ~SceneTreeModel() override;

  void SetScene(std::shared_ptr<Scene> scene); // null: no rows
  const std::shared_ptr<Scene>& GetScene() const;
  // Only rows whose names contain the text, in either case, and the frames above them. Empty: all.
  void SetFilter(const QString& text);
  // Frames and objects whose names contain the filter's text; 0 without a filter.
  int Matches() const;
  // Words for the kind of an object in place of "mesh", "lines", ...; an empty word: that one.
  void SetKinds(std::function<QString(ObjectId)> kinds);
  // Returns whether a row changed. Takes constant time where the scene did not change, apart from
  // poses and cameras; else time in proportion to the objects of the scene, and with a filter also
  // to its frames.
  bool Refresh();

  SceneItem ItemOf(const QModelIndex& index) const;
  // Makes the rows on the way. Invalid where the item does not exist or is filtered out.
  QModelIndex IndexOf(const SceneItem& item);
  Eye EyeOf(const SceneItem& item) const;
  QString KindOf(const SceneItem& item) const;

  QModelIndex index(int row, int column, const QModelIndex& parent = {}) const override;
  QModelIndex parent(const QModelIndex& index) const override;
  int rowCount(const QModelIndex& parent = {}) const override;
  int columnCount(const QModelIndex& parent = {}) const override;
  bool hasChildren(const QModelIndex& parent = {}) const override;
  bool canFetchMore(const QModelIndex& parent) const override;
  void fetchMore(const QModelIndex& parent) override;
  QVariant data(const QModelIndex& index, int role = Qt::DisplayRole) const override;
  QVariant headerData(int section, Qt::Orientation orientation,
                      int role = Qt::DisplayRole) const override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
