// The Sun of a scene in commands: the directional light "sun".
#ifndef DSPACE_SESSION_SUN_MESSAGES_H
#define DSPACE_SESSION_SUN_MESSAGES_H

#include <dspace/proto/cameras.pb.h>
#include <dspace/proto/common.pb.h>

namespace dspace::session {

inline constexpr const char* SunLabel = "light 'sun'"; // for errors

// The Sun of a new scene: 1361 W/m^2 from azimuth 315 (north-west), elevation 45 degrees in the
// root, as shaded relief is lit by default.
v1::SetLight DefaultSun();

// Changes a light as SetSun does; absent fields of `sun` keep the light's values. `sun` has no
// `horizontal`. Throws Error(InvalidArgument) about the light "sun" and changes nothing.
void ChangeSun(const v1::SunState& sun, v1::SetLight& light);

// The light as SunInfo has it, but for the direction.
void DescribeSun(const v1::SetLight& light, v1::SunInfo& info);

} // namespace dspace::session

#endif
