// Channels that are dragged from widget to widget.
#ifndef DSPACE_WIDGETS_CHANNEL_MIME_H
#define DSPACE_WIDGETS_CHANNEL_MIME_H

#include <QMimeData>
#include <QStringList>

namespace dspace::widgets {

// UTF-8 names of channels, one a line.
constexpr const char* ChannelMimeType = "application/x-dspace-telemetry";

// The caller owns it. Other programs get the names as text.
QMimeData* MakeChannelMime(const QStringList& names);
// Empty: it holds no channels. `data` may be null.
QStringList ChannelsOf(const QMimeData* data);

} // namespace dspace::widgets

#endif
