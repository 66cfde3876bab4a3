// The colours of values that are beyond their limits, wherever telemetry is shown.
#ifndef DSPACE_SESSION_TELEMETRYCOLORS_H
#define DSPACE_SESSION_TELEMETRYCOLORS_H

#include <array>

namespace dspace::session {

// sRGB, 0 to 1.
constexpr std::array<double, 3> WarningColor = {1.0, 0.75, 0.2}; // amber: beyond a warning limit
constexpr std::array<double, 3> AlarmColor = {1.0, 0.35, 0.3};   // red: beyond an alarm limit

} // namespace dspace::session

#endif
