#include <dspace/widgets/overlay/OverlayPane.h>

#include <utility>

#include <QEvent>
#include <QPainter>

#include <dspace/widgets/viewport/ViewportWidget.h>

namespace dspace::widgets {

OverlayPane::OverlayPane(ViewportWidget* view, std::function<void(QPainter&)> draw)
    : QWidget(view), Draw_(std::move(draw)) {
  this->setAttribute(Qt::WA_TransparentForMouseEvents);
  this->setAttribute(Qt::WA_NoSystemBackground);
  this->setFocusPolicy(Qt::NoFocus);
  this->setObjectName(QStringLiteral("overlay"));
  this->resize(view->size());
  view->installEventFilter(this);
  connect(view, &ViewportWidget::shown, this, qOverload<>(&QWidget::update));
  this->show();
}

bool OverlayPane::eventFilter(QObject* object, QEvent* event) {
  if (event->type() == QEvent::Resize) {
    this->resize(this->parentWidget()->size());
  }
  return QWidget::eventFilter(object, event);
}

void OverlayPane::paintEvent(QPaintEvent*) {
  QPainter painter(this);
  painter.setRenderHint(QPainter::Antialiasing);
  this->Draw_(painter);
}

} // namespace dspace::widgets
