#include <dspace/commands/sky/SkyPlaces.h>

#include <algorithm>
#include <memory>
#include <utility>
#include <vector>

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

// The nearest of a frame and its ancestors that says what it stands for.
FrameId PlacedAbove(const Context& context, FrameId frame) {
  const auto& moving = context.scene->sky.frames;
  while (frame != RootFrame && !moving.count(frame)) {
    frame = context.Frames().Parent(frame);
  }
  return frame;
}

dspace::SkyPlace PlaceOnFrame(const Context& context, const v1::Place& place) {
  const FrameTree& tree = context.Frames();
  const SkyMotions& sky = context.scene->sky;
  const FrameId frame = ToFrame(place.frame());
  const FrameId above = PlacedAbove(context, frame);
  Pose X = tree.RelativePose(above, frame);
  X.position = X.Apply(ToVector(place.position()));
  return SkyPlaceOf(*sky.kernels, sky.PlaceOf(tree, above), X);
}

// One frame of a chain: at rest, or along a trajectory, as it is now.
struct Link {
  Pose pose;
  std::shared_ptr<const TrajectoryObject> trajectory;
  std::string label;
};

Pose PoseOf(const Link& link, double tdb) {
  if (!link.trajectory) {
    return link.pose;
  }
  const Trajectory& path = *link.trajectory->Shown();
  const Eigen::Vector3d position = PositionAt(path, tdb, link.label);
  std::string warning; // of an attitude that ends
  Pose X = link.trajectory->FollowerPose(std::max(tdb, path.Span().begin), warning);
  if (!warning.empty()) {
    Reject(link.label, "its trajectory has no attitude at " + NumberText(tdb) +
                           " s; accepted: times that have one");
  }
  X.position = position;
  return X;
}

} // namespace

Eigen::Vector3d PositionAt(const Trajectory& path, double tdb, const std::string& label) {
  constexpr double Before = 3.0; // [s]
  const std::vector<TimeSpan> parts = path.Parts();
  const double nearest = NearestTime(parts, tdb);
  if (tdb == nearest) {
    return path.At(tdb).position;
  }
  if (!(tdb < path.Span().begin && path.Span().begin - tdb <= Before)) {
    Reject(label, "no state is known at " + NumberText(tdb) +
                      " s, when the light left; accepted: times from " +
                      NumberText(path.Span().begin) + " to " + NumberText(path.Span().end) +
                      " s that have one");
  }
  const dspace::State first = path.At(nearest);
  return first.position + (tdb - nearest) * first.velocity;
}

TimedPlace TimedPlaceOnFrame(const Context& context, const v1::Place& place) {
  const FrameTree& tree = context.Frames();
  const SkyMotions& sky = context.scene->sky;
  const FrameId above = PlacedAbove(context, ToFrame(place.frame()));
  std::vector<Link> chain; // from the place's frame up
  bool moves = false;
  for (FrameId frame = ToFrame(place.frame()); frame != above; frame = tree.Parent(frame)) {
    Link link{tree.LocalPose(frame), nullptr, "frame '" + tree.Path(frame) + "'"};
    for (const auto& [id, trajectory] : context.scene->trajectories) {
      if (trajectory->Follower() == frame) {
        link.trajectory = std::make_shared<const TrajectoryObject>(*trajectory);
        moves = true;
      }
    }
    chain.push_back(std::move(link));
  }
  const CelestialPlace base = sky.PlaceOf(tree, above);
  const std::shared_ptr<const KernelSet> kernels = sky.kernels;
  const Eigen::Vector3d point = ToVector(place.position());
  const auto at = [chain, base, kernels, point](double tdb) {
    Pose X;
    for (const Link& link : chain) {
      X = PoseOf(link, tdb) * X;
    }
    X.position = X.Apply(point);
    return SkyPlaceOf(*kernels, base, X);
  };
  return {at, moves};
}

TimedPlace TimedPlaceUnderSky(const Context& context, const v1::SkyPlace& asked,
                              const std::string& command) {
  if (asked.has_place()) {
    return TimedPlaceOnFrame(context, asked.place());
  }
  return {[place = PlaceUnderSky(context, asked, command)](double) { return place; }, false};
}

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
