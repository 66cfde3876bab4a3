#include <dspace/commands/sky/SkyPlaces.h>

#include <dspace/Checks.h>
#include <dspace/messages/Convert.h>
#include <dspace/state/TerrainBody.h>
#include <dspace/state/TerrainObject.h>

namespace dspace::session {
namespace {

dspace::SkyPlace PlaceOfSite(const Context& context, const v1::SkyPlace& asked) {
  const v1::Site& site = asked.site();
  const auto found = context.scene->terrains.find(site.terrain());
  if (found == context.scene->terrains.end()) {
    throw Error(Error::Kind::NotFound, "terrain '" + site.terrain() + "'",
                "there is no such terrain in scene '" + context.sceneName + "'");
  }
  const TerrainObject& terrain = *found->second;
  const std::string label = "terrain '" + terrain.Name() + "'";
  const TerrainSurface& surface = terrain.Surface();
  const SurfaceSample sample = surface.SampleMap({site.map_x(), site.map_y()});
  if (!sample.valid) {
    Reject(label, "the place " + NumberText(site.map_x()) + ", " + NumberText(site.map_y()) +
                      " is off its data; accepted: map coordinates on its data");
  }
  Require(site.height() >= 0.0 && site.height() <= 1e12, label, "the height above the ground",
          site.height(), "0 to 1e12 m");
  Rows3 map(1, 3);
  map << site.map_x(), site.map_y(), sample.height + site.height();
  const BodyCoordinates place = surface.Locate(map)[0];
  if (!place.bodyFixed.allFinite()) {
    throw Error(Error::Kind::Unsupported, label,
                "its CRS has no longitudes and latitudes; accepted: terrain on a body, or a place "
                "on a frame that follows the time");
  }
  const KernelSet& kernels = *context.scene->sky.kernels;
  dspace::SkyPlace out;
  out.body = BodyFor(kernels, terrain.Surface().GetCrs(), asked.body(), label,
                     [&](const std::string& warning) { context.reply.add_warning(warning); });
  out.frame = kernels.GetFrames().Table().BodyFixed(out.body).name;
  // Up is the normal of the CRS's ellipsoid.
  out.axes = AxesAt({place.longitude_deg, place.latitude_deg, 0.0, LatitudeKind::Planetocentric},
                    Eigen::Vector3d::Ones());
  out.axes.position = place.bodyFixed;
  return out;
}

dspace::SkyPlace PlaceOnFrame(const Context& context, const v1::Place& place) {
  const FrameTree& tree = context.Frames();
  const SkyMotions& sky = context.scene->sky;
  const FrameId frame = ToFrame(place.frame());
  FrameId above = frame;
  while (above != RootFrame && !sky.frames.count(above)) {
    above = tree.Parent(above);
  }
  Pose X = tree.RelativePose(above, frame);
  X.position = X.Apply(ToVector(place.position()));
  return SkyPlaceOf(*sky.kernels, sky.PlaceOf(tree, above), X);
}

} // namespace

dspace::SkyPlace PlaceUnderSky(const Context& context, const v1::SkyPlace& asked,
                               const std::string& command) {
  switch (asked.from_case()) {
  case v1::SkyPlace::kPlace:
    return PlaceOnFrame(context, asked.place());
  case v1::SkyPlace::kSite:
    return PlaceOfSite(context, asked);
  case v1::SkyPlace::kCelestial: {
    const SkyMotions& sky = context.scene->sky;
    return SkyPlaceOf(*sky.kernels, sky.PlaceOf(asked.celestial()), Pose());
  }
  default:
    Reject(command, "it names no place; accepted: place, site or celestial");
  }
}

} // namespace dspace::session
