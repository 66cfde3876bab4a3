// What the scene tree asks for, as lines of Python, and what such lines do.
#ifndef DSPACE_WIDGETS_TREE_ACTIONS_H
#define DSPACE_WIDGETS_TREE_ACTIONS_H

#include <QJsonObject>
#include <QString>

#include <dspace/widgets/scene/SceneRequest.h>

namespace dspace {
class Scene;
}

namespace dspace::widgets {

// app.act("trail", "rover"), app.act("hide", "rover", "hull"). Empty: the item is not in the
// scene, or the action is no command.
QString LineOf(const SceneRequest& request, const Scene& scene);

// A request {"do": "tree", "action", "frame", "object"} of such a line. object: a name or an id;
// null: the frame itself.
bool IsTreeRequest(const QJsonObject& request);
// Throws Error: NotFound for a frame or object that is not in the scene, InvalidArgument for
// another action.
SceneRequest RequestOf(const QJsonObject& request, const Scene& scene);

} // namespace dspace::widgets

#endif
