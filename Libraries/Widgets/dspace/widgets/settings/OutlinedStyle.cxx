#include <dspace/widgets/settings/OutlinedStyle.h>

#include <QPainter>
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

QColor OutlineOf(const QPalette& palette, bool enabled) {
  if (IsDark(palette)) {
    return QColor(enabled ? 0x8b9097 : 0x5b6067);
  }
  return QColor(enabled ? 0x75797e : 0xb4b8bd);
}

} // namespace dspace::widgets
