#include <dspace/widgets/telemetry/ChannelMime.h>

namespace dspace::widgets {

QMimeData* MakeChannelMime(const QStringList& names) {
  auto* data = new QMimeData;
  data->setData(ChannelMimeType, names.join('\n').toUtf8());
  data->setText(names.join('\n'));
  return data;
}

QStringList ChannelsOf(const QMimeData* data) {
  if (!data || !data->hasFormat(ChannelMimeType)) {
    return {};
  }
  return QString::fromUtf8(data->data(ChannelMimeType)).split('\n', Qt::SkipEmptyParts);
}

} // namespace dspace::widgets
