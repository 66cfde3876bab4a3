// The selection of a window: the row of the scene tree, outlined in the views.
#ifndef DSPACE_WIDGETS_VIEW_SELECTION_H
#define DSPACE_WIDGETS_VIEW_SELECTION_H

#include <memory>
#include <string>
#include <vector>

#include <QImage>
#include <QObject>

#include <dspace/scene/GraphicsObject.h>

class vtkObject;

namespace dspace::widgets {

class SceneTreeWidget;
class ShownScenes;
class ViewportWidget;

// A click in a view selects the row of what it hits, and what is selected has an outline in the
// views of its scene. The outline comes a moment after a picture, at most eight times a second, and
// not while the user drags, so that movements stay as fast as they are.
class ViewSelection : public QObject {
  Q_OBJECT

public:
  // All must outlive it.
  ViewSelection(SceneTreeWidget* tree, ShownScenes* scenes, QObject* parent);
  ~ViewSelection() override;

  void Add(ViewportWidget* widget, vtkObject* of, const std::string& viewport);
  // What a session replied to an event of a view: a click selects what it hit, or nothing.
  void Take(const std::string& event, const std::string& reply);
  void Clear();
  // What is selected, as Python of a view's scene ("scene" stands for it); "": nothing.
  QString Python() const;
  // The pixels on the edge of what is selected, in a picture of object ids: opaque orange, others
  // transparent. Empty: nothing of it is seen.
  static QImage Outline(const std::vector<std::uint32_t>& labels, int width, int height,
                        const std::vector<ObjectId>& selected);
  // Whether the view shows an outline now.
  bool IsOutlined(ViewportWidget* widget) const;

private:
  struct Internals;
  std::unique_ptr<Internals> Impl_;
};

} // namespace dspace::widgets

#endif
