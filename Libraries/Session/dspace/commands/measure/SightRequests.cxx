// Lines of sight and horizons.
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>

#include <dspace/Checks.h>
#include <dspace/commands/measure/MeasuredPictures.h>
#include <dspace/measure/SightLine.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

constexpr int MostPairs = 1000000;
constexpr double Infinity = std::numeric_limits<double>::infinity();

MeasuredScene::Spot StartOf(const MeasuredScene& scene, const v1::LineOfSight::Pair& pair,
                            const std::string& number) {
  switch (pair.start_case()) {
  case v1::LineOfSight::Pair::kFrom:
    return scene.At(pair.from(), "the start of line " + number);
  case v1::LineOfSight::Pair::kFromSite:
    return scene.At(pair.from_site(), "the start of line " + number);
  default:
    Reject("line " + number, "it has no start; accepted: a place or a site");
  }
}

MeasuredScene::Spot EndOf(const MeasuredScene& scene, const v1::LineOfSight::Pair& pair,
                          const std::string& number) {
  switch (pair.end_case()) {
  case v1::LineOfSight::Pair::kTo:
    return scene.At(pair.to(), "the end of line " + number);
  case v1::LineOfSight::Pair::kToSite:
    return scene.At(pair.to_site(), "the end of line " + number);
  default:
    Reject("line " + number, "it has no end; accepted: a place or a site");
  }
}

void PutClearance(const SightLine& line, v1::LineOfSightReply::Sight& sight) {
  const Obstacles::Hit& first = line.First();
  double height = line.Height();
  double angle_deg = line.Angle();
  if (!first.hit) {
    const SightLine::Beside solids = line.Solids();
    height = std::min(height, solids.distance);
    angle_deg = std::min(angle_deg, solids.angle_deg);
  } else if (first.object != 0) {
    height = std::min(height, 0.0);
    angle_deg = std::min(angle_deg, 0.0);
  }
  sight.set_clearance(height);
  sight.set_clearance_deg(angle_deg);
}

// What rays find of one line.
void PutExact(const MeasuredScene& scene, const v1::LineOfSight& command,
              const MeasuredScene::Spot& from, const MeasuredScene::Spot& to,
              v1::LineOfSightReply::Sight& sight) {
  const SightLine line(scene.Get(), from.p_R, to.p_R, from.label, to.label);
  const Obstacles::Hit& first = line.First();
  sight.set_clear(!first.hit);
  sight.set_terrain(first.terrain);
  sight.set_object(first.object);
  sight.set_distance(first.hit ? first.distance : Infinity);
  if (first.hit) {
    Put(first.point, sight.mutable_point());
  }
  if (!command.no_clearance()) {
    PutClearance(line, sight);
  }
  if (command.has_wavelength()) {
    const double free = line.Fresnel(command.wavelength());
    sight.set_fresnel_free(first.object != 0 ? std::min(free, 0.0) : free);
  }
}

// The place as rays take it: lifted where it stands on the ground. Throws for a place below it.
Eigen::Vector3d Lifted(const MeasuredScene& scene, const MeasuredScene::Spot& spot) {
  Eigen::Vector3d p_R = spot.p_R;
  for (const Obstacles::Ground& ground : scene.Get().Grounds()) {
    p_R = ground.X_RS.Apply(scene.Get().Stand(ground, p_R, spot.label));
  }
  return p_R;
}

// What a picture shows of one line. `only`: there are no rays.
void PutImage(MeasuredPictures& pictures, const MeasuredScene& scene,
              const MeasuredScene::Spot& from, const MeasuredScene::Spot& to, bool only,
              v1::LineOfSightReply::Sight& sight) {
  double reach = 0.0;
  const Eigen::Vector3d from_R = Lifted(scene, from);
  const Eigen::Vector3d to_R = Lifted(scene, to);
  const bool clear = pictures.Clear(from_R, to_R, &reach);
  sight.set_image_clear(clear);
  if (only) {
    sight.set_clear(clear);
    sight.set_distance(clear ? Infinity : reach);
    if (!clear) {
      Put(Eigen::Vector3d(from_R + reach * (to_R - from_R).normalized()), sight.mutable_point());
    }
  }
}

void FindSights(const Context& context, v1::LineOfSight& command) {
  const std::string name = "command line_of_sight";
  const Methods methods = MethodsOf(command.measuring(), name);
  if (command.pair_size() < 1 || command.pair_size() > MostPairs) {
    Reject(name, std::to_string(command.pair_size()) + " lines; accepted: 1 to 1,000,000");
  }
  const MeasuredScene scene(context, command.measuring(), command.without_object(), name);
  std::optional<MeasuredPictures> pictures;
  v1::LineOfSightReply reply;
  if (methods.image) {
    pictures.emplace(context, command.measuring(), scene, name);
    reply.set_image_pixel_deg(pictures->PixelAngle());
  }
  for (int i = 0; i < command.pair_size(); ++i) {
    const std::string number = std::to_string(i);
    const MeasuredScene::Spot from = StartOf(scene, command.pair(i), number);
    const MeasuredScene::Spot to = EndOf(scene, command.pair(i), number);
    if ((to.p_R - from.p_R).norm() <= 2.0 * Obstacles::Touch) {
      Reject("line " + number, "its start and its end are the same point, " + VectorText(from.p_R) +
                                   " in the root; accepted: two points that differ");
    }
    v1::LineOfSightReply::Sight* sight = reply.add_sight();
    sight->set_range((to.p_R - from.p_R).norm());
    sight->set_clearance(std::numeric_limits<double>::quiet_NaN());
    sight->set_clearance_deg(std::numeric_limits<double>::quiet_NaN());
    if (methods.exact) {
      PutExact(scene, command, from, to, *sight);
    }
    if (pictures) {
      scene.Get().Check();
      PutImage(*pictures, scene, from, to, !methods.exact, *sight);
    }
  }
  context.reply.mutable_line_of_sight()->Swap(&reply);
}

void FindHorizon(const Context& context, v1::Horizon& command) {
  const std::string name = "command horizon";
  const Methods methods = MethodsOf(command.measuring(), name);
  const MeasuredScene scene(context, command.measuring(), command.without_object(), name);
  MeasuredScene::Spot spot;
  switch (command.from_case()) {
  case v1::Horizon::kPlace:
    spot = scene.At(command.place(), "the place");
    break;
  case v1::Horizon::kSite:
    spot = scene.At(command.site(), "the place");
    break;
  default:
    Reject(name, "it names no place; accepted: place or site");
  }
  constexpr std::size_t Standard = 1440;
  const std::size_t count = command.azimuths() == 0 ? Standard : command.azimuths();
  const LevelAxes axes = scene.AxesAt(spot);
  v1::HorizonReply reply;
  if (methods.exact) {
    for (const HorizonPoint& point : ScanHorizon(scene.Get(), spot.p_R, axes, count, spot.label)) {
      reply.add_elevation_deg(point.elevation_deg);
      reply.add_distance(point.distance);
      reply.mutable_point()->Add(point.point.data(), point.point.data() + 3);
      reply.add_object(point.object);
    }
  }
  if (methods.image) {
    MeasuredPictures pictures(context, command.measuring(), scene, name);
    const MeasuredPictures::Skyline seen = pictures.Horizon(Lifted(scene, spot), axes, count);
    reply.mutable_image_elevation_deg()->Add(seen.elevation_deg.begin(), seen.elevation_deg.end());
    reply.mutable_image_distance()->Add(seen.distance.begin(), seen.distance.end());
    for (const Eigen::Vector3d& point : seen.point) {
      reply.mutable_image_point()->Add(point.data(), point.data() + 3);
    }
    for (const Pose& camera : seen.cameras) {
      Put(camera, reply.add_image_camera());
    }
    reply.set_image_pixel_deg(pictures.PixelAngle());
  }
  Put(spot.p_R, reply.mutable_from());
  if (const std::optional<double> north = scene.NorthAt(spot)) {
    reply.set_first_deg(*north);
  }
  context.reply.mutable_horizon()->Swap(&reply);
}

} // namespace

void AddSightRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kLineOfSight, &C::mutable_line_of_sight, FindSights);
  registry.Add(C::kHorizon, &C::mutable_horizon, FindHorizon);
}

} // namespace dspace::session
