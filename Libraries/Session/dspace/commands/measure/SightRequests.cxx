// Lines of sight and horizons.
#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

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

struct Wanted {
  bool clearance = true;
  std::optional<double> wavelength; // [m]
};

// What rays find of one line.
void PutExact(const Obstacles& obstacles, const Wanted& wanted, const MeasuredScene::Spot& from,
              const MeasuredScene::Spot& to, v1::LineOfSightReply::Sight& sight) {
  const SightLine line(obstacles, from.p_R, to.p_R, from.label, to.label);
  const Obstacles::Hit& first = line.First();
  sight.set_clear(!first.hit);
  sight.set_terrain(first.terrain);
  sight.set_object(first.object);
  sight.set_distance(first.hit ? first.distance : Infinity);
  if (first.hit) {
    Put(first.point, sight.mutable_point());
  }
  if (wanted.clearance) {
    PutClearance(line, sight);
  }
  if (wanted.wavelength) {
    const double free = line.Fresnel(*wanted.wavelength);
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
  struct Line {
    MeasuredScene::Spot from, to;
  };
  std::vector<Line> lines;
  auto sights = std::make_shared<v1::LineOfSightReply>();
  for (int i = 0; i < command.pair_size(); ++i) {
    const std::string number = std::to_string(i);
    const Line& line = lines.emplace_back(
        Line{StartOf(scene, command.pair(i), number), EndOf(scene, command.pair(i), number)});
    const Eigen::Vector3d way = line.to.p_R - line.from.p_R;
    if (way.norm() <= 2.0 * Obstacles::Touch) {
      Reject("line " + number, "its start and its end are the same point, " +
                                   VectorText(line.from.p_R) +
                                   " in the root; accepted: two points that differ");
    }
    v1::LineOfSightReply::Sight* sight = sights->add_sight();
    sight->set_range(way.norm());
    sight->set_clearance(std::numeric_limits<double>::quiet_NaN());
    sight->set_clearance_deg(std::numeric_limits<double>::quiet_NaN());
  }
  if (methods.image) {
    MeasuredPictures pictures(context, command.measuring(), scene, name);
    sights->set_image_pixel_deg(pictures.PixelAngle());
    for (int i = 0; i < command.pair_size(); ++i) {
      scene.Get().Check();
      const Line& line = lines[std::size_t(i)];
      PutImage(pictures, scene, line.from, line.to, !methods.exact, *sights->mutable_sight(i));
    }
  }
  if (!methods.exact) {
    context.reply.mutable_line_of_sight()->Swap(sights.get());
    return;
  }
  const Wanted wanted{!command.no_clearance(), command.has_wavelength()
                                                   ? std::optional<double>(command.wavelength())
                                                   : std::nullopt};
  scene.Measure([lines = std::move(lines), sights, wanted](
                    const Obstacles& obstacles, v1::Reply& reply, const Works::Proceed& proceed) {
    for (std::size_t i = 0; i < lines.size(); ++i) {
      proceed(double(i) / double(lines.size()));
      PutExact(obstacles, wanted, lines[i].from, lines[i].to, *sights->mutable_sight(int(i)));
    }
    reply.mutable_line_of_sight()->Swap(sights.get());
  });
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
  auto horizon = std::make_shared<v1::HorizonReply>();
  if (methods.image) {
    MeasuredPictures pictures(context, command.measuring(), scene, name);
    const MeasuredPictures::Skyline seen = pictures.Horizon(Lifted(scene, spot), axes, count);
    horizon->mutable_image_elevation_deg()->Add(seen.elevation_deg.begin(),
                                                seen.elevation_deg.end());
    horizon->mutable_image_distance()->Add(seen.distance.begin(), seen.distance.end());
    for (const Eigen::Vector3d& point : seen.point) {
      horizon->mutable_image_point()->Add(point.data(), point.data() + 3);
    }
    for (const Pose& camera : seen.cameras) {
      Put(camera, horizon->add_image_camera());
    }
    horizon->set_image_pixel_deg(pictures.PixelAngle());
  }
  Put(spot.p_R, horizon->mutable_from());
  if (const std::optional<double> north = scene.NorthAt(spot)) {
    horizon->set_first_deg(*north);
  }
  if (!methods.exact) {
    context.reply.mutable_horizon()->Swap(horizon.get());
    return;
  }
  scene.Measure([spot, axes, count, horizon](const Obstacles& obstacles, v1::Reply& reply,
                                             const Works::Proceed& proceed) {
    for (const HorizonPoint& point :
         ScanHorizon(obstacles, spot.p_R, axes, count, spot.label, proceed)) {
      horizon->add_elevation_deg(point.elevation_deg);
      horizon->add_distance(point.distance);
      horizon->mutable_point()->Add(point.point.data(), point.point.data() + 3);
      horizon->add_object(point.object);
    }
    reply.mutable_horizon()->Swap(horizon.get());
  });
}

} // namespace

void AddSightRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kLineOfSight, &C::mutable_line_of_sight, FindSights);
  registry.Add(C::kHorizon, &C::mutable_horizon, FindHorizon);
}

} // namespace dspace::session
