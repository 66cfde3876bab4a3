#include <dspace/widgets/window/ViewMenu.h>

#include <utility>

#include <QAction>
#include <QClipboard>
#include <QCoreApplication>
#include <QGuiApplication>
#include <QMenu>

#include <dspace/proto/commands.pb.h>
#include <dspace/widgets/overlay/PointerReadout.h>
#include <dspace/widgets/script/PythonText.h>
#include <dspace/widgets/viewport/ShownSession.h>
#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {
namespace {

QString Text(const char* text) {
  return QCoreApplication::translate("ViewMenu", text);
}

} // namespace

QMenu* OpenViewMenu(ViewportWidget* widget, const ShownSession& session, const std::string& event,
                    const std::string& reply, std::function<bool(const QString&)> run) {
  v1::ViewportEvent given;
  v1::Reply told;
  if (!given.ParseFromString(event) || !told.ParseFromString(reply) || !told.has_input() ||
      told.input().button() != v1::ViewportEvent::RIGHT || told.input().pick().object() == 0) {
    return nullptr;
  }
  const v1::PickReply& pick = told.input().pick();
  v1::Reply picked; // as a pick replies
  *picked.mutable_pick() = pick;
  auto* menu = new QMenu(widget);
  menu->setObjectName(QStringLiteral("view menu"));
  menu->setAttribute(Qt::WA_DeleteOnClose);
  QObject::connect(menu->addAction(Text("&Copy coordinates")), &QAction::triggered, menu,
                   [line = PointerReadout::TextOf(picked.SerializeAsString(), {}, true)] {
                     QGuiApplication::clipboard()->setText(line);
                   });
  QAction* const goal = menu->addAction(Text("Send as &goal"));
  goal->setEnabled(!session.Player()); // nobody hears it
  const QString point = QStringLiteral("(%1, %2, %3)")
                            .arg(PythonOf(pick.in_root().x()), PythonOf(pick.in_root().y()),
                                 PythonOf(pick.in_root().z()));
  QObject::connect(goal, &QAction::triggered, widget, [run = std::move(run), point] {
    run(QStringLiteral("app.send_goal(%1)").arg(point));
  });
  const double ratio = widget->devicePixelRatioF();
  menu->popup(
      widget->mapToGlobal(QPointF((given.x() + 0.5) / ratio, (given.y() + 0.5) / ratio).toPoint()));
  return menu;
}

} // namespace dspace::widgets
