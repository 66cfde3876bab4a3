// The Sun: the directional light "sun".
#include <dspace/commands/scene/SunCommands.h>

#include <optional>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/messages/Convert.h>
#include <dspace/messages/SunMessages.h>
#include <dspace/state/SunPlace.h>

namespace dspace::session {
namespace {

const TerrainObject& TerrainNamed(const Context& context, const std::string& name) {
  const auto found = context.scene->terrains.find(name);
  if (found == context.scene->terrains.end()) {
    throw Error(Error::Kind::NotFound, "terrain '" + name + "'",
                "there is no such terrain in scene '" + context.sceneName + "'");
  }
  return *found->second;
}

// The axes X east, Y north, Z up of the place that a message names, and the frame that they are in.
// Without a terrain they are the axes of `frame`.
template<class Place>
std::pair<Eigen::Matrix3d, FrameId> AxesOf(const Context& context, const Place& place,
                                           FrameId frame) {
  if (place.has_map_x() != place.has_map_y()) {
    Reject(SunLabel, "one map coordinate of its place is given; accepted: both or none");
  }
  if (place.terrain().empty()) {
    if (place.has_map_x()) {
      Reject(SunLabel, "map coordinates of no terrain are given; accepted: a terrain with them");
    }
    return {Eigen::Matrix3d::Identity(), frame};
  }
  if (frame != NoFrame) {
    Reject(SunLabel, "frame " + std::to_string(frame) + " and terrain '" + place.terrain() +
                         "' are given; accepted: one of them");
  }
  const TerrainObject& terrain = TerrainNamed(context, place.terrain());
  std::optional<Eigen::Vector2d> map;
  if (place.has_map_x()) {
    map = Eigen::Vector2d(place.map_x(), place.map_y());
  }
  return {HorizontalAxes(terrain, map), context.GetScene().Object(terrain.Object()).frame};
}

// Replaces `horizontal` by a direction.
void ResolveHorizontal(const Context& context, v1::SunState& sun) {
  const v1::HorizontalDirection& from = sun.horizontal();
  if (sun.has_direction()) {
    Reject(SunLabel, "a direction " + VectorText(ToVector(sun.direction())) +
                         " and an azimuth of " + NumberText(from.azimuth_deg()) +
                         " degrees are given; accepted: one of direction and horizontal");
  }
  const auto [axes, frame] = AxesOf(context, from, sun.frame());
  Put(axes * ToDirection(from.azimuth_deg(), from.elevation_deg()), sun.mutable_direction());
  sun.set_frame(frame);
  sun.clear_horizontal();
}

void SetSun(const Context& context, v1::SetSun& command) {
  v1::SunState& sun = *command.mutable_sun();
  if (context.scene->sky.sun) {
    Reject(SunLabel, "it follows the scene's time; accepted: set_sun_motion with stop first");
  }
  context.GetScene().SetLight(ChangedSun(context, sun));
}

void GetSun(const Context& context, v1::GetSun& command) {
  const Light* sun = FindSunLight(context.GetScene());
  if (!sun || !IsSun(*sun)) {
    throw Error(Error::Kind::NotFound, SunLabel,
                "scene '" + context.sceneName + "' has no Sun: no directional light of this name");
  }
  const auto [axes, frame] = AxesOf(context, command, NoFrame);
  v1::SetLight light;
  Put(*sun, &light);
  v1::SunInfo* info = context.reply.mutable_sun();
  DescribeSun(light, *info);
  Put(TowardsSun(context.GetScene(), *sun, RootFrame), info->mutable_direction());
  const Eigen::Vector2d angles =
      ToHorizontal(axes.transpose() * TowardsSun(context.GetScene(), *sun, ToFrame(frame)));
  info->set_azimuth_deg(angles[0]);
  info->set_elevation_deg(angles[1]);
}

} // namespace

Light ChangedSun(const Context& context, v1::SunState& sun) {
  if (sun.has_horizontal()) {
    ResolveHorizontal(context, sun);
  }
  if (sun.frame() != NoFrame && !sun.has_direction()) {
    Reject(SunLabel, "frame " + std::to_string(sun.frame()) +
                         " is given without a direction; accepted: both, or no frame");
  }
  return MovedSun(context.GetScene(), sun);
}

void AddSunCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kSetSun, &C::mutable_set_sun, SetSun);
  registry.Add(C::kGetSun, &C::mutable_get_sun, GetSun);
}

} // namespace dspace::session
