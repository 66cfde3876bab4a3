#include <dspace/widgets/window/SmallWindow.h>

#include <algorithm>
#include <vector>

#include <QCoreApplication>
#include <QDockWidget>
#include <QEvent>
#include <QLayout>
#include <QMainWindow>

namespace dspace::widgets {
namespace {

const QStringList ClosedFirst = {"measure", "terrain", "console", "messages", "telemetry"};
const QStringList ClosedLast = {"scene", "time"};

// Greater: it is closed later.
int RankOf(const QDockWidget& dock) {
  const QString name = dock.objectName();
  if (const qsizetype first = ClosedFirst.indexOf(name); first >= 0) {
    return int(first);
  }
  const qsizetype last = ClosedLast.indexOf(name);
  return int(ClosedFirst.size() + (last < 0 ? 0 : 1 + last));
}

QSize LeastSize(QMainWindow& window) {
  QCoreApplication::sendPostedEvents(nullptr, QEvent::LayoutRequest); // of docks that came or went
  window.layout()->invalidate();
  window.layout()->activate(); // the window's own minimum
  return window.layout()->totalMinimumSize();
}

QString SizeText(const QSize& size) {
  return QStringLiteral("%1 x %2").arg(size.width()).arg(size.height());
}

} // namespace

QString KeepSmall(QMainWindow& window, const QSize& size) {
  const auto fits = [&] {
    const QSize least = LeastSize(window);
    return least.width() <= size.width() && least.height() <= size.height();
  };
  std::vector<QDockWidget*> docks;
  for (QDockWidget* each : window.findChildren<QDockWidget*>()) {
    if (!each->isFloating() && !each->isHidden() &&
        !each->objectName().startsWith(QLatin1String("view "))) {
      docks.push_back(each);
    }
  }
  std::stable_sort(docks.begin(), docks.end(), [](const QDockWidget* a, const QDockWidget* b) {
    return RankOf(*a) < RankOf(*b);
  });
  std::vector<QDockWidget*> out;
  for (QDockWidget* each : docks) {
    if (fits()) {
      break;
    }
    each->close();
    out.push_back(each);
  }
  QStringList closed;
  for (auto each = out.rbegin(); each != out.rend(); ++each) { // one may have been closed in vain
    (*each)->show();
    if (!fits()) {
      (*each)->close();
      closed.prepend((*each)->windowTitle());
    }
  }
  const QSize least = LeastSize(window);
  window.resize(size.expandedTo(least));
  QString told;
  if (!closed.isEmpty()) {
    told = QStringLiteral("%1 has no room for all docks; closed are %2 (menu View)")
               .arg(SizeText(size), closed.join(QStringLiteral(", ")));
  }
  if (!fits()) {
    told +=
        QStringLiteral("%1the least size of this window is %2")
            .arg(told.isEmpty() ? SizeText(size) + ": " : QStringLiteral("; "), SizeText(least));
  }
  return told;
}

} // namespace dspace::widgets
