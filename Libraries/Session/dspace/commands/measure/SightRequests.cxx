// Lines of sight and horizons.
#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Checks.h>
#include <dspace/commands/measure/MeasuredScene.h>
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

void FindSights(const Context& context, v1::LineOfSight& command) {
  const std::string name = "command line_of_sight";
  if (RejectMethod(context, command.measuring(), name)) {
    return;
  }
  if (command.pair_size() < 1 || command.pair_size() > MostPairs) {
    Reject(name, std::to_string(command.pair_size()) + " lines; accepted: 1 to 1,000,000");
  }
  const MeasuredScene scene(context, command.measuring(), command.without_object(), name);
  v1::LineOfSightReply reply;
  for (int i = 0; i < command.pair_size(); ++i) {
    const std::string number = std::to_string(i);
    const MeasuredScene::Spot from = StartOf(scene, command.pair(i), number);
    const MeasuredScene::Spot to = EndOf(scene, command.pair(i), number);
    if ((to.p_R - from.p_R).norm() <= 2.0 * Obstacles::Touch) {
      Reject("line " + number, "its start and its end are the same point, " + VectorText(from.p_R) +
                                   " in the root; accepted: two points that differ");
    }
    const SightLine line(scene.Get(), from.p_R, to.p_R, from.label, to.label);
    const Obstacles::Hit& first = line.First();
    v1::LineOfSightReply::Sight* sight = reply.add_sight();
    sight->set_clear(!first.hit);
    sight->set_terrain(first.terrain);
    sight->set_object(first.object);
    sight->set_range(line.Range());
    sight->set_distance(first.hit ? first.distance : Infinity);
    if (first.hit) {
      Put(first.point, sight->mutable_point());
    }
    if (command.no_clearance()) {
      sight->set_clearance(std::numeric_limits<double>::quiet_NaN());
      sight->set_clearance_deg(std::numeric_limits<double>::quiet_NaN());
    } else {
      PutClearance(line, *sight);
    }
    if (command.has_wavelength()) {
      const double free = line.Fresnel(command.wavelength());
      sight->set_fresnel_free(first.object != 0 ? std::min(free, 0.0) : free);
    }
  }
  context.reply.mutable_line_of_sight()->Swap(&reply);
}

void FindHorizon(const Context& context, v1::Horizon& command) {
  const std::string name = "command horizon";
  if (RejectMethod(context, command.measuring(), name)) {
    return;
  }
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
  v1::HorizonReply reply;
  for (const HorizonPoint& point :
       ScanHorizon(scene.Get(), spot.p_R, scene.AxesAt(spot), count, spot.label)) {
    reply.add_elevation_deg(point.elevation_deg);
    reply.add_distance(point.distance);
    reply.mutable_point()->Add(point.point.data(), point.point.data() + 3);
    reply.add_object(point.object);
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
