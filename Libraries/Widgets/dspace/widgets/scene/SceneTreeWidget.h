// A widget that shows the frames and objects of a scene.
#ifndef DSPACE_WIDGETS_SCENE_TREE_WIDGET_H
#define DSPACE_WIDGETS_SCENE_TREE_WIDGET_H

#include <functional>
#include <memory>

#include <QWidget>

#include <dspace/scene/Scene.h>
#include <dspace/widgets/scene/SceneRequest.h>

namespace dspace::widgets {

class ScenePropertyPanel;
class SceneTreeModel;
class SceneTreeView;

// A search field, the tree with an eye for each row, and the properties of the selected row. While
// it is visible it looks for changes of the scene up to 30 times a second, and more seldom where
// looking would take more than a twentieth of the time.
// It changes nothing in the scene. What the user asks for is told by contextAction(), and goes to
// the handler; copying a path needs neither. What a handler throws is shown, and told by failed().
class SceneTreeWidget : public QWidget {
  Q_OBJECT

public:
  using Handler = std::function<void(const SceneRequest&)>;
  using Source = std::function<std::shared_ptr<Scene>()>;

  explicit SceneTreeWidget(QWidget* parent = nullptr);
  ~SceneTreeWidget() override;

  void SetScene(std::shared_ptr<Scene> scene); // null: none; ends a source
  // The scene is asked for at every refresh: playbacks replace their scenes. Paths of opened and
  // selected frames are found again in the next scene.
  void SetSource(Source source);
  void SetHandler(Handler handler);
  // As SceneTreeModel::SetKinds.
  void SetKinds(std::function<QString(ObjectId)> kinds);

  // Selects a row and scrolls to it. An item that does not exist ends the selection. selected() is
  // emitted when the selection changes.
  void Select(const SceneItem& item);
  SceneItem Selected() const;
  // The frame that the shown pose is relative to: by default the root; NoFrame: the parent.
  void SetReference(FrameId frame);
  FrameId Reference() const;
  // Asks for an action, as the context menu does.
  void Request(SceneAction action, const SceneItem& item);
  // Looks for changes now.
  void Refresh();

  SceneTreeModel* Model() const;
  SceneTreeView* View() const;
  QSize sizeHint() const override;

signals:
  void selected(const dspace::widgets::SceneItem& item); // frame NoFrame: nothing
  void clicked(const dspace::widgets::SceneItem& item);  // a row, but for its eye
  void contextAction(dspace::widgets::SceneAction action, const dspace::widgets::SceneItem& item);
  void failed(const QString& message);

protected:
  void showEvent(QShowEvent* event) override;
  void hideEvent(QHideEvent* event) override;
  bool eventFilter(QObject* watched, QEvent* event) override;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
