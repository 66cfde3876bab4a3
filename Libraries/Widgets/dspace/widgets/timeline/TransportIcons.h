// Icons of a timeline's buttons, drawn in the colours of a palette.
#ifndef DSPACE_WIDGETS_TRANSPORT_ICONS_H
#define DSPACE_WIDGETS_TRANSPORT_ICONS_H

#include <QIcon>
#include <QPalette>

namespace dspace::widgets {

enum class TransportIcon {
  Play,
  Pause,
  StepBack,
  StepOn,
  Slower,
  Faster,
  Reverse,
  Loop,
  Live,
  Mark
};

// 20 × 20, with a paler one for disabled buttons.
QIcon MakeTransportIcon(TransportIcon icon, const QPalette& palette);

} // namespace dspace::widgets

#endif
