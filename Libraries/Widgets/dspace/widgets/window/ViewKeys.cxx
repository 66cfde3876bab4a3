#include <dspace/widgets/window/ViewKeys.h>

#include <utility>

#include <QCoreApplication>
#include <QKeyEvent>

#include <dspace/widgets/overlay/MeasureMarks.h>
#include <dspace/widgets/script/PythonText.h>
#include <dspace/widgets/timeline/TimelineWidget.h>
#include <dspace/widgets/viewport/ViewportWidget.h>
#include <dspace/widgets/window/KeyTable.h>
#include <dspace/widgets/window/MovieTrack.h>
#include <dspace/widgets/window/ViewSelection.h>

namespace dspace::widgets {

ViewKeys::ViewKeys(TimelineWidget* timeline, ViewSelection* selection, MovieTrack* movies,
                   MeasureMarks* marks, std::function<bool(const QString&)> run, QObject* parent)
    : QObject(parent), Timeline_(timeline), Selection_(selection), Movies_(movies), Marks_(marks),
      Run_(std::move(run)) {}

void ViewKeys::Add(ViewportWidget* widget, const std::string& viewport) {
  this->Views_[widget] =
      QStringLiteral("app.views[%1]").arg(Quoted(QString::fromStdString(viewport)));
  widget->installEventFilter(this);
  connect(widget, &QObject::destroyed, this, [this](QObject* gone) { this->Views_.erase(gone); });
}

bool ViewKeys::eventFilter(QObject* watched, QEvent* event) {
  if (event->type() == QEvent::KeyPress) {
    const auto* pressed = static_cast<QKeyEvent*>(event);
    const auto found = this->Views_.find(watched);
    const Qt::KeyboardModifiers held = pressed->modifiers() & ~Qt::KeypadModifier;
    if (found != this->Views_.end() && held == Qt::NoModifier &&
        this->Take(static_cast<ViewportWidget*>(watched), found->second, pressed->key())) {
      return true;
    }
  }
  return QObject::eventFilter(watched, event);
}

bool ViewKeys::Take(ViewportWidget* widget, const QString& view, int key) {
  switch (key) {
  case Qt::Key_Space: {
    const auto& clock = this->Timeline_->Source();
    if (!clock || !clock->GetState().canPlay) {
      return false; // a script may want it
    }
    QKeyEvent press(QEvent::KeyPress, Qt::Key_Space, Qt::NoModifier);
    QCoreApplication::sendEvent(this->Timeline_, &press);
    return true;
  }
  case Qt::Key_F: {
    const QString thing = this->Selection_->Python();
    return this->Run_(thing.isEmpty() ? QStringLiteral("app.fit(%1)").arg(view)
                                      : QStringLiteral("app.fit(%1, %1.%2)").arg(view, thing)) ||
           true;
  }
  case Qt::Key_K:
    return this->Movies_->AddKey();
  case Qt::Key_H:
    SwitchKeyOverlay(widget);
    return true;
  case Qt::Key_Escape:
    if (RemoveKeyOverlay(widget) || this->Movies_->Stop() || this->Marks_->End()) {
      return true;
    }
    if (!this->Selection_->Python().isEmpty()) {
      this->Selection_->Clear();
    }
    return false; // a drag ends, too
  default:
    return false;
  }
}

} // namespace dspace::widgets
