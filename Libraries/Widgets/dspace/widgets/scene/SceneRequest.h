// What the user asks for in a scene tree.
#ifndef DSPACE_WIDGETS_SCENE_REQUEST_H
#define DSPACE_WIDGETS_SCENE_REQUEST_H

#include <QMetaType>

#include <dspace/scene/GraphicsObject.h>

namespace dspace::widgets {

// A row of a scene tree: a frame, or an object with the frame that it is attached to.
struct SceneItem {
  FrameId frame = NoFrame; // NoFrame: nothing
  ObjectId object = 0;     // 0: the frame itself

  bool operator==(const SceneItem& o) const {
    return this->frame == o.frame && this->object == o.object;
  }
  bool operator!=(const SceneItem& o) const { return !(*this == o); }
};

enum class SceneAction {
  Chase, // follow the frame with the camera
  Focus, // bring it into view
  Show,  // the object, or all objects on the frame and below
  Hide,
  Trail, // begin or end the trail of the frame
  Axes,  // add or remove the axes of the frame
  CopyPath
};

struct SceneRequest {
  SceneAction action = SceneAction::Focus;
  SceneItem item;
};

} // namespace dspace::widgets

Q_DECLARE_METATYPE(dspace::widgets::SceneItem)
Q_DECLARE_METATYPE(dspace::widgets::SceneAction)

#endif
