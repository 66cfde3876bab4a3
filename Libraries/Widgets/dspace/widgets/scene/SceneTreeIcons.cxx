#include <dspace/widgets/scene/SceneTreeIcons.h>

#include <functional>
#include <map>
#include <tuple>

#include <QPainter>
#include <QPainterPath>
#include <QPixmap>

namespace dspace::widgets {
namespace {

constexpr int IconSize = 16;

QColor Mixed(const QColor& a, const QColor& b, double share) {
  return QColor::fromRgbF(float(a.redF() + share * (b.redF() - a.redF())),
                          float(a.greenF() + share * (b.greenF() - a.greenF())),
                          float(a.blueF() + share * (b.blueF() - a.blueF())));
}

// Draws `draw` in a colour for each mode, at several densities.
QIcon MakeIcon(const QColor& plain, const QColor& selected,
               const std::function<void(QPainter&, const QColor&)>& draw) {
  QIcon icon;
  for (const int density : {1, 2, 3}) {
    for (const bool highlighted : {false, true}) {
      QPixmap pixmap(IconSize * density, IconSize * density);
      pixmap.setDevicePixelRatio(density);
      pixmap.fill(Qt::transparent);
      QPainter painter(&pixmap);
      painter.setRenderHint(QPainter::Antialiasing);
      draw(painter, highlighted ? selected : plain);
      painter.end();
      icon.addPixmap(pixmap, highlighted ? QIcon::Selected : QIcon::Normal);
    }
  }
  return icon;
}

using IconKey = std::tuple<int, QRgb, QRgb>;

void DrawKind(SceneTreeModel::Icon icon, QPainter& painter, const QColor& color) {
  using Icon = SceneTreeModel::Icon;
  QPen pen(color, 1.2, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin);
  QColor fill = color;
  fill.setAlphaF(0.22f);
  painter.setPen(pen);
  switch (icon) {
  case Icon::Frame: { // axes
    const QPointF origin(5.5, 10.5);
    const struct {
      QPointF end;
      QColor color;
    } axes[] = {{{14.0, 12.5}, QColor(0xd9, 0x45, 0x3d)},
                {{1.5, 14.5}, QColor(0x3f, 0xa2, 0x4a)},
                {{5.5, 1.5}, QColor(0x3d, 0x7d, 0xe0)}};
    for (const auto& axis : axes) {
      painter.setPen(QPen(axis.color, 1.8, Qt::SolidLine, Qt::RoundCap));
      painter.drawLine(origin, axis.end);
    }
    break;
  }
  case Icon::Mesh: { // a cube
    QPainterPath outline;
    outline.addPolygon(QPolygonF(
        {{8.0, 1.5}, {14.0, 4.8}, {14.0, 11.2}, {8.0, 14.5}, {2.0, 11.2}, {2.0, 4.8}, {8.0, 1.5}}));
    painter.fillPath(outline, fill);
    painter.drawPath(outline);
    painter.drawPolyline(QPolygonF({{2.0, 4.8}, {8.0, 8.0}, {14.0, 4.8}}));
    painter.drawLine(QPointF(8.0, 8.0), QPointF(8.0, 14.5));
    break;
  }
  case Icon::Lines: {
    QPainterPath path({1.5, 12.5});
    path.cubicTo({5.0, 1.0}, {10.0, 17.0}, {14.5, 3.5});
    painter.drawPath(path);
    break;
  }
  case Icon::Points:
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    for (const QPointF& point : {QPointF(3.5, 11.5), QPointF(6.5, 5.0), QPointF(9.0, 12.5),
                                 QPointF(11.0, 7.5), QPointF(13.0, 3.0)}) {
      painter.drawEllipse(point, 1.4, 1.4);
    }
    break;
  case Icon::Label:
    painter.setBrush(fill);
    painter.drawRoundedRect(QRectF(1.5, 3.5, 13.0, 9.0), 2.0, 2.0);
    painter.drawLine(QPointF(5.5, 6.0), QPointF(10.5, 6.0));
    painter.drawLine(QPointF(8.0, 6.0), QPointF(8.0, 10.3));
    break;
  case Icon::Drawn: { // hills
    QPainterPath hills({1.0, 13.5});
    hills.lineTo(5.5, 5.0);
    hills.lineTo(8.5, 9.5);
    hills.lineTo(10.5, 7.0);
    hills.lineTo(15.0, 13.5);
    hills.closeSubpath();
    painter.fillPath(hills, fill);
    painter.drawPath(hills);
    break;
  }
  case Icon::Empty:
    pen.setStyle(Qt::DotLine);
    painter.setPen(pen);
    painter.drawRect(QRectF(2.5, 2.5, 11.0, 11.0));
    break;
  }
}

void DrawEye(SceneTreeModel::Eye eye, QPainter& painter, QColor color) {
  if (eye == SceneTreeModel::Eye::Hidden) {
    color.setAlphaF(0.6f);
  }
  QPainterPath lid({1.2, 8.0});
  lid.quadTo({8.0, 1.2}, {14.8, 8.0});
  lid.quadTo({8.0, 14.8}, {1.2, 8.0});
  painter.setPen(QPen(color, 1.3, Qt::SolidLine, Qt::RoundCap, Qt::RoundJoin));
  if (eye == SceneTreeModel::Eye::Hidden) { // closed
    QPainterPath closed({1.2, 7.0});
    closed.quadTo({8.0, 13.0}, {14.8, 7.0});
    painter.drawPath(closed);
    painter.drawLine(QPointF(4.2, 9.7), QPointF(3.0, 11.6));
    painter.drawLine(QPointF(8.0, 10.6), QPointF(8.0, 12.8));
    painter.drawLine(QPointF(11.8, 9.7), QPointF(13.0, 11.6));
    return;
  }
  painter.drawPath(lid);
  if (eye == SceneTreeModel::Eye::Mixed) {
    painter.drawEllipse(QPointF(8.0, 8.0), 2.2, 2.2);
  } else {
    painter.setPen(Qt::NoPen);
    painter.setBrush(color);
    painter.drawEllipse(QPointF(8.0, 8.0), 2.6, 2.6);
  }
}

} // namespace

QIcon SceneIcon(SceneTreeModel::Icon icon, const QPalette& palette) {
  static auto& icons = *new std::map<IconKey, QIcon>; // never destroyed: the application ends first
  const QColor plain = Mixed(palette.color(QPalette::Active, QPalette::Text),
                             palette.color(QPalette::Active, QPalette::Base), 0.2);
  const QColor selected = palette.color(QPalette::HighlightedText);
  QIcon& made = icons[{int(icon), plain.rgba(), selected.rgba()}];
  if (made.isNull()) {
    made = MakeIcon(plain, selected, [icon](QPainter& painter, const QColor& color) {
      DrawKind(icon, painter, color);
    });
  }
  return made;
}

QIcon EyeIcon(SceneTreeModel::Eye eye, const QPalette& palette) {
  if (eye == SceneTreeModel::Eye::None) {
    return {};
  }
  static auto& icons = *new std::map<IconKey, QIcon>; // never destroyed: the application ends first
  const QColor plain = palette.color(QPalette::Active, QPalette::Text);
  const QColor selected = palette.color(QPalette::HighlightedText);
  QIcon& made = icons[{int(eye), plain.rgba(), selected.rgba()}];
  if (made.isNull()) {
    made = MakeIcon(plain, selected, [eye](QPainter& painter, const QColor& color) {
      DrawEye(eye, painter, color);
    });
  }
  return made;
}

} // namespace dspace::widgets
