#include <dspace/widgets/timeline/TransportIcons.h>

#include <QPainter>
#include <QPainterPath>
#include <QPixmap>

namespace dspace::widgets {
namespace {

constexpr int Edge = 20;

QPolygonF Triangle(double left, double right, double half) {
  return QPolygonF({{left, 10.0 - half}, {right, 10.0}, {left, 10.0 + half}});
}

void Draw(TransportIcon icon, QPainter& painter, const QColor& color) {
  painter.setPen(Qt::NoPen);
  painter.setBrush(color);
  const QPen line(color, 1.8, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin);
  switch (icon) {
  case TransportIcon::Play:
    painter.drawPolygon(Triangle(5.5, 16.5, 6.5));
    break;
  case TransportIcon::Pause:
    painter.drawRect(QRectF(5.0, 4.0, 3.6, 12.0));
    painter.drawRect(QRectF(11.4, 4.0, 3.6, 12.0));
    break;
  case TransportIcon::StepBack:
    painter.drawPolygon(Triangle(14.5, 6.5, 5.0));
    painter.drawRect(QRectF(4.0, 5.0, 2.0, 10.0));
    break;
  case TransportIcon::StepOn:
    painter.drawPolygon(Triangle(5.5, 13.5, 5.0));
    painter.drawRect(QRectF(14.0, 5.0, 2.0, 10.0));
    break;
  case TransportIcon::Slower:
    painter.drawPolygon(Triangle(9.5, 3.0, 4.5));
    painter.drawPolygon(Triangle(16.5, 10.0, 4.5));
    break;
  case TransportIcon::Faster:
    painter.drawPolygon(Triangle(3.5, 10.0, 4.5));
    painter.drawPolygon(Triangle(10.5, 17.0, 4.5));
    break;
  case TransportIcon::Reverse:
    painter.drawPolygon(Triangle(14.5, 3.5, 6.5));
    break;
  case TransportIcon::Loop: {
    painter.setPen(line);
    painter.setBrush(Qt::NoBrush);
    painter.drawArc(QRectF(4.0, 4.0, 12.0, 12.0), 30 * 16, 280 * 16);
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    painter.drawPolygon(QPolygonF({{17.8, 5.0}, {16.6, 10.4}, {12.4, 7.0}}));
    break;
  }
  case TransportIcon::Live:
    painter.drawPolygon(Triangle(3.5, 12.0, 5.0));
    painter.setBrush(QColor(0xd9, 0x45, 0x3d, color.alpha()));
    painter.drawEllipse(QPointF(15.0, 10.0), 3.0, 3.0);
    break;
  case TransportIcon::Mark: {
    painter.setPen(line);
    painter.drawLine(QPointF(6.0, 3.5), QPointF(6.0, 17.0));
    painter.setPen(Qt::NoPen);
    painter.drawPolygon(QPolygonF({{6.0, 3.5}, {15.5, 6.8}, {6.0, 10.2}}));
    break;
  }
  }
}

} // namespace

QIcon MakeTransportIcon(TransportIcon icon, const QPalette& palette) {
  QIcon made;
  for (const int density : {1, 2, 3}) {
    for (const bool enabled : {true, false}) {
      QPixmap pixmap(Edge * density, Edge * density);
      pixmap.setDevicePixelRatio(density);
      pixmap.fill(Qt::transparent);
      QPainter painter(&pixmap);
      painter.setRenderHint(QPainter::Antialiasing);
      QColor color = palette.color(QPalette::Active, QPalette::ButtonText);
      color.setAlphaF(enabled ? 1.0f : 0.3f);
      Draw(icon, painter, color);
      painter.end();
      made.addPixmap(pixmap, enabled ? QIcon::Normal : QIcon::Disabled);
    }
  }
  return made;
}

} // namespace dspace::widgets
