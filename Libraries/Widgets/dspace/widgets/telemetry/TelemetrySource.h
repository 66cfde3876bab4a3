// Where widgets take telemetry from.
#ifndef DSPACE_WIDGETS_TELEMETRY_SOURCE_H
#define DSPACE_WIDGETS_TELEMETRY_SOURCE_H

#include <functional>

namespace dspace::session {
class Telemetry;
}

namespace dspace::widgets {

// The telemetry of a scene; null while there is none. The widget's thread calls it at every look,
// and keeps no pointer to what it returns.
using TelemetrySource = std::function<const session::Telemetry*()>;

} // namespace dspace::widgets

#endif
