#include <dspace/widgets/settings/OutlinedStyle.h>

#include <QApplication>
#include <QIconEngine>
#include <QPainter>
#include <QPixmap>
#include <QStyleOption>

#include <dspace/widgets/settings/Theme.h>

namespace dspace::widgets {
namespace {

constexpr double Corner = 2.0; // [pixels], as Fusion rounds them

void Outline(const QStyleOption& option, QPainter& painter, bool round) {
  const bool enabled = option.state.testFlag(QStyle::State_Enabled);
  const bool focus = enabled && option.state.testFlag(QStyle::State_HasFocus);
  painter.save();
  painter.setRenderHint(QPainter::Antialiasing);
  painter.setBrush(Qt::NoBrush);
  painter.setPen(focus ? option.palette.color(QPalette::Link) : OutlineOf(option.palette, enabled));
  const QRectF edge = QRectF(option.rect).adjusted(0.5, 0.5, -0.5, -0.5);
  if (round) {
    painter.drawEllipse(edge);
  } else {
    painter.drawRoundedRect(edge, Corner, Corner);
  }
  painter.restore();
}

// A mark of a title bar. Docks keep an icon when the theme changes, so that this one takes the
// colour of texts each time it is painted.
class TitleMark : public QIconEngine {
public:
  explicit TitleMark(bool close) : Close_(close) {}

  void paint(QPainter* painter, const QRect& rect, QIcon::Mode, QIcon::State) override {
    painter->save();
    painter->setRenderHint(QPainter::Antialiasing);
    painter->translate(rect.topLeft());
    painter->scale(rect.width() / 32.0, rect.height() / 32.0);
    painter->setPen(QPen(QApplication::palette().color(QPalette::WindowText), 3.0));
    if (this->Close_) {
      painter->drawLine(9, 9, 23, 23);
      painter->drawLine(23, 9, 9, 23);
    } else { // a window before another one
      painter->drawRect(7, 12, 13, 13);
      painter->drawPolyline(QPolygon({{12, 12}, {12, 7}, {25, 7}, {25, 20}, {20, 20}}));
    }
    painter->restore();
  }
  QPixmap pixmap(const QSize& size, QIcon::Mode mode, QIcon::State state) override {
    QPixmap pixmap(size);
    pixmap.fill(Qt::transparent);
    QPainter painter(&pixmap);
    this->paint(&painter, QRect(QPoint(0, 0), size), mode, state);
    return pixmap;
  }
  QIconEngine* clone() const override { return new TitleMark(*this); }

private:
  bool Close_;
};

} // namespace

OutlinedStyle::OutlinedStyle() : QProxyStyle(QStringLiteral("fusion")) {}

void OutlinedStyle::drawPrimitive(PrimitiveElement element, const QStyleOption* option,
                                  QPainter* painter, const QWidget* widget) const {
  QProxyStyle::drawPrimitive(element, option, painter, widget);
  switch (element) {
  case PE_FrameLineEdit:
  case PE_IndicatorCheckBox:
  case PE_IndicatorItemViewItemCheck:
    Outline(*option, *painter, false);
    break;
  case PE_PanelButtonCommand:
    if (const auto* button = qstyleoption_cast<const QStyleOptionButton*>(option);
        !button || !button->features.testFlag(QStyleOptionButton::Flat)) {
      Outline(*option, *painter, false);
    }
    break;
  case PE_IndicatorRadioButton:
    Outline(*option, *painter, true);
    break;
  default:
    break;
  }
}

void OutlinedStyle::drawComplexControl(ComplexControl control, const QStyleOptionComplex* option,
                                       QPainter* painter, const QWidget* widget) const {
  QProxyStyle::drawComplexControl(control, option, painter, widget);
  if (control == CC_ComboBox) {
    if (const auto* box = qstyleoption_cast<const QStyleOptionComboBox*>(option);
        !box || box->frame) {
      Outline(*option, *painter, false);
    }
  } else if (control == CC_SpinBox) {
    if (const auto* box = qstyleoption_cast<const QStyleOptionSpinBox*>(option);
        !box || box->frame) {
      Outline(*option, *painter, false);
    }
  }
}

QIcon OutlinedStyle::standardIcon(StandardPixmap icon, const QStyleOption* option,
                                  const QWidget* widget) const {
  const bool close = icon == SP_TitleBarCloseButton || icon == SP_DockWidgetCloseButton;
  if (!close && icon != SP_TitleBarNormalButton) {
    return QProxyStyle::standardIcon(icon, option, widget);
  }
  return QIcon(new TitleMark(close));
}

QColor OutlineOf(const QPalette& palette, bool enabled) {
  if (IsDark(palette)) {
    return QColor(enabled ? 0x8b9097 : 0x5b6067);
  }
  return QColor(enabled ? 0x75797e : 0xb4b8bd);
}

} // namespace dspace::widgets
