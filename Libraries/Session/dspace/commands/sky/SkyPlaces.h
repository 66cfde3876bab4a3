// Places of commands under the sky.
#ifndef DSPACE_SESSION_SKY_PLACES_H
#define DSPACE_SESSION_SKY_PLACES_H

#include <string>

#include <dspace/interpreter/Registry.h>
#include <dspace/proto/visibility.pb.h>
#include <dspace/sky/SkyView.h>

namespace dspace::session {

// Throws Error: NotFound for an unknown frame, terrain or body, InvalidArgument for a message
// without a place (which names `command`), a frame that follows nothing and a site off the data,
// Unsupported for terrain without longitudes and latitudes.
dspace::SkyPlace PlaceUnderSky(const Context& context, const v1::SkyPlace& asked,
                               const std::string& command);

} // namespace dspace::session

#endif
