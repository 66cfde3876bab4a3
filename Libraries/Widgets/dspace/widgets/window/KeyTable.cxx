#include <dspace/widgets/window/KeyTable.h>

#include <QEvent>
#include <QLabel>
#include <QObject>

namespace dspace::widgets {
namespace {

const char* const Name = "keyOverlay";

struct Entry {
  const char* keys;
  const char* effect;
};
constexpr Entry Entries[] = {
    {"Left drag", "orbits about the point under the pointer"},
    {"Middle drag, Shift+left drag", "pans"},
    {"Wheel, right drag", "moves towards the point under the pointer"},
    {"Arrows, + and -", "orbit, move nearer and farther; on the timeline: step"},
    {"Click", "selects"},
    {"Double click", "turns to the point under the pointer"},
    {"W A S D", "walk, where the view's bar says so; Shift hurries"},
    {"F", "shows the selection, else everything"},
    {"R", "returns to the first view"},
    {"Space", "plays and pauses"},
    {"K", "a camera key of the movie, where the camera is"},
    {"M", "on the timeline: a mark"},
    {"Escape", "cancels a drag, ends a preview or a measurement, clears the selection"},
    {"H", "shows and hides these keys"},
};

class KeyOverlay : public QLabel {
public:
  explicit KeyOverlay(QWidget* view) : QLabel(view) {
    this->setObjectName(Name);
    this->setText(KeyTable());
    this->setTextFormat(Qt::RichText);
    this->setAlignment(Qt::AlignCenter);
    this->setStyleSheet(
        "QLabel { background: rgba(10, 12, 16, 210); color: white; padding: 12px; }");
    view->installEventFilter(this);
    this->Place();
    this->show();
    this->raise();
  }

protected:
  void mousePressEvent(QMouseEvent*) override { this->deleteLater(); }
  bool eventFilter(QObject* watched, QEvent* event) override {
    if (event->type() == QEvent::Resize) {
      this->Place();
    }
    return QLabel::eventFilter(watched, event);
  }

private:
  void Place() {
    const QRect room = this->parentWidget()->rect();
    const QSize size = this->sizeHint().boundedTo(room.size());
    this->setGeometry(QRect(room.center() - QPoint(size.width() / 2, size.height() / 2), size));
  }
};

QWidget* OverlayOf(QWidget* view) {
  return view->findChild<QWidget*>(Name, Qt::FindDirectChildrenOnly);
}

} // namespace

QString KeyTable() {
  QString rows;
  for (const Entry& entry : Entries) {
    rows += QStringLiteral("<tr><td><b>%1</b></td><td>%2</td></tr>")
                .arg(QObject::tr(entry.keys), QObject::tr(entry.effect));
  }
  return QStringLiteral("<table cellspacing=4>%1</table>").arg(rows);
}

void SwitchKeyOverlay(QWidget* view) {
  if (!RemoveKeyOverlay(view)) {
    new KeyOverlay(view); // of the view
  }
}

bool RemoveKeyOverlay(QWidget* view) {
  QWidget* overlay = OverlayOf(view);
  delete overlay;
  return overlay != nullptr;
}

} // namespace dspace::widgets
