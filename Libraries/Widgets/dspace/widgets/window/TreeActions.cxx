#include <dspace/widgets/window/TreeActions.h>

#include <algorithm>
#include <array>
#include <string>
#include <utility>

#include <dspace/Error.h>
#include <dspace/scene/Scene.h>
#include <dspace/widgets/script/PythonText.h>

namespace dspace::widgets {
namespace {

using Name = std::pair<SceneAction, const char*>;
constexpr std::array<Name, 6> Names{{{SceneAction::Chase, "chase"},
                                     {SceneAction::Focus, "focus"},
                                     {SceneAction::Show, "show"},
                                     {SceneAction::Hide, "hide"},
                                     {SceneAction::Trail, "trail"},
                                     {SceneAction::Axes, "axes"}}};

} // namespace

QString LineOf(const SceneRequest& request, const Scene& scene) {
  const auto* name = std::find_if(Names.begin(), Names.end(),
                                  [&](const Name& each) { return each.first == request.action; });
  const SceneItem& item = request.item;
  if (name == Names.end() || !scene.Frames().Contains(item.frame) ||
      (item.object != 0 && !scene.Objects().count(item.object))) {
    return {};
  }
  QString line = QStringLiteral("app.act(%1, %2")
                     .arg(Quoted(QString::fromLatin1(name->second)),
                          Quoted(QString::fromStdString(scene.Frames().Path(item.frame))));
  if (item.object != 0) {
    line += QStringLiteral(", ") + Quoted(QString::fromStdString(scene.Object(item.object).name));
  }
  return line + QLatin1Char(')');
}

bool IsTreeRequest(const QJsonObject& request) {
  return request["do"].toString() == "tree";
}

SceneRequest RequestOf(const QJsonObject& request, const Scene& scene) {
  const std::string action = request["action"].toString().toStdString();
  const auto* name = std::find_if(Names.begin(), Names.end(),
                                  [&](const Name& each) { return each.second == action; });
  if (name == Names.end()) {
    throw Error(Error::Kind::InvalidArgument, "action",
                "it is '" + action + "'; accepted: chase, focus, show, hide, trail, axes");
  }
  SceneRequest made;
  made.action = name->first;
  const std::string path = request["frame"].toString().toStdString();
  made.item.frame = scene.Frames().Find(path);
  if (made.item.frame == NoFrame) {
    throw Error(Error::Kind::NotFound, "frame '" + path + "'",
                "there is no such frame; accepted: the path of a frame in the scene in the docks");
  }
  const QJsonValue object = request["object"];
  if (object.isNull() || object.isUndefined()) {
    return made;
  }
  for (const auto& [id, each] : scene.Objects()) {
    const bool same = object.isString() ? each.name == object.toString().toStdString()
                                        : double(id) == object.toDouble(-1.0);
    if (each.frame == made.item.frame && same) {
      made.item.object = id;
      return made;
    }
  }
  throw Error(Error::Kind::NotFound, "object '" + object.toVariant().toString().toStdString() + "'",
              "it is not on frame '" + scene.Frames().Path(made.item.frame) +
                  "'; accepted: the name or id of an object on this frame");
}

} // namespace dspace::widgets
