// Qt's style Fusion with outlines of controls that can be seen.
#ifndef DSPACE_WIDGETS_OUTLINED_STYLE_H
#define DSPACE_WIDGETS_OUTLINED_STYLE_H

#include <QColor>
#include <QIcon>
#include <QProxyStyle>

class QPalette;

namespace dspace::widgets {

// Fusion draws the edges of boxes a little darker than the window, so that in a dark theme they are
// not seen. This style draws them again, in OutlineOf(), and marks of title bars in the colour of
// texts.
class OutlinedStyle : public QProxyStyle {
  Q_OBJECT

public:
  OutlinedStyle();

  void drawPrimitive(PrimitiveElement element, const QStyleOption* option, QPainter* painter,
                     const QWidget* widget) const override;
  void drawComplexControl(ComplexControl control, const QStyleOptionComplex* option,
                          QPainter* painter, const QWidget* widget) const override;
  // The marks of docks' title bars in the colour of texts.
  QIcon standardIcon(StandardPixmap icon, const QStyleOption* option,
                     const QWidget* widget) const override;
};

// Of controls: its contrast to Window, Base and Button is 3 at least, as WCAG 2.1 asks of them
// (1.4.11). `enabled`: controls that do nothing may be dimmer.
QColor OutlineOf(const QPalette& palette, bool enabled);

} // namespace dspace::widgets

#endif
