// Places of commands under the sky.
#ifndef DSPACE_SESSION_SKY_PLACES_H
#define DSPACE_SESSION_SKY_PLACES_H

#include <functional>
#include <string>

#include <dspace/interpreter/Registry.h>
#include <dspace/proto/visibility.pb.h>
#include <dspace/sky/SkyView.h>
#include <dspace/trajectories/Trajectory.h>

namespace dspace::session {

// Throws Error: NotFound for an unknown frame, terrain or body, InvalidArgument for a message
// without a place (which names `command`), a frame that follows nothing and a site off the data,
// Unsupported for terrain without longitudes and latitudes. A frame is where the scene's time has
// it over its body.
dspace::SkyPlace PlaceUnderSky(const Context& context, const v1::SkyPlace& asked,
                               const std::string& command);

// A place at each time: frames follow the time, and move along trajectories, as they do in the
// scene now. It holds what it needs of the scene; any thread may call it.
struct TimedPlace {
  std::function<dspace::SkyPlace(double tdb)> at;
  bool moves = false; // over its body's axes, along a trajectory
};

// As PlaceUnderSky. `at` throws Error(InvalidArgument) at times without a state of the trajectory.
TimedPlace TimedPlaceUnderSky(const Context& context, const v1::SkyPlace& asked,
                              const std::string& command);
TimedPlace TimedPlaceOnFrame(const Context& context, const v1::Place& place);

// The state's position at a time. Light that arrives at a path's begin left before it: up to 3 s
// before its first state the position is extrapolated. Throws Error(InvalidArgument) naming
// `label` at other times without a state.
Eigen::Vector3d PositionAt(const Trajectory& path, double tdb, const std::string& label);

} // namespace dspace::session

#endif
