// Range sensors: lidars and altimeters.
#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <optional>
#include <set>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/camera/sensor/RangeSensor.h>
#include <dspace/commands/cameras/PlacedLens.h>
#include <dspace/commands/measure/MeasuredScene.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

using V = Eigen::Vector3d;
constexpr double Degree = M_PI / 180.0;
constexpr std::uint64_t MostBeams = 1000000; // of one request, as ranges.proto states it
constexpr std::uint32_t StandardRays = 19;
constexpr double StandardAlbedo = 0.2; // of terrain
const V NoVector = V::Constant(std::numeric_limits<double>::quiet_NaN());

// A beam in the root. Without a direction there is none.
struct Beam {
  V origin = V::Zero();
  std::optional<V> direction; // unit
};

// Where the sensor is, and its beams by their numbers.
struct Beams {
  V from_R = V::Zero();
  std::string label; // of the sensor
  Eigen::Matrix3d axes_R = Eigen::Matrix3d::Identity();
  std::uint64_t count = 0;
  std::function<Beam(std::uint64_t)> at;
};

RangeSettings SettingsOf(const v1::RangeSensor& from) {
  using Report = RangeSettings::Report;
  RangeSettings to;
  switch (from.report()) {
  case v1::RangeSensor::FIRST:
    to.report = Report::First;
    break;
  case v1::RangeSensor::LAST:
    to.report = Report::Last;
    break;
  case v1::RangeSensor::MEAN:
    to.report = Report::Mean;
    break;
  case v1::RangeSensor::LEAST:
    to.report = Report::Least;
    break;
  default:
    Reject("range sensor", "the report is " + std::to_string(int(from.report())) +
                               "; accepted: FIRST (0), LAST (1), MEAN (2), LEAST (3)");
  }
  to.minimumRange = from.minimum_range();
  if (from.has_maximum_range()) {
    to.maximumRange = from.maximum_range();
  }
  to.divergence = from.divergence_deg() * Degree;
  to.rays = ToInt(from.rays() == 0 ? StandardRays : from.rays());
  to.noise = from.noise();
  to.noiseFraction = from.noise_fraction();
  to.dropOut = from.drop_out();
  if (from.has_greatest_incidence_deg()) {
    to.greatestIncidence = from.greatest_incidence_deg() * Degree;
  }
  to.leastIntensity = from.least_intensity();
  to.seed = from.seed();
  to.scan = from.scan();
  return to;
}

// Axes of a sensor in the root: X right, Y forward, Z up.
struct Axes {
  Eigen::Matrix3d grid = Eigen::Matrix3d::Identity();       // for azimuths and elevations
  Eigen::Matrix3d directions = Eigen::Matrix3d::Identity(); // for directions
};

// The sensor's place in a camera's lens, and its axes. `placed`: with a lens.
CameraPose CameraOf(const Context& context, const v1::ScanRanges& command,
                    std::optional<PlacedLens>& placed) {
  const v1::CameraModel& camera = command.camera();
  if (command.beams_case() == v1::ScanRanges::kPixels || !camera.model().empty()) {
    placed = PlaceLens(context, camera);
    return placed->camera;
  }
  if (camera.own_pose()) {
    Reject("command scan_ranges", "own_pose is set without a model; accepted: a model with it");
  }
  const std::string vantage = camera.vantage().empty() ? DefaultVantage : camera.vantage();
  return context.GetScene().PlaceCamera(vantage, camera.camera());
}

void SetGrid(const v1::ScanRanges::Grid& grid, const Eigen::Matrix3d& axes, Beams& beams) {
  const auto check = [](double angle, double most, const char* what, const char* accepted) {
    Require(std::abs(angle) <= most, "range sensor", what, angle, accepted);
  };
  for (const double angle : grid.azimuth_deg()) {
    check(angle, 360.0, "an azimuth", "-360 to 360 degrees");
  }
  for (const double angle : grid.elevation_deg()) {
    check(angle, 90.0, "an elevation", "-90 to 90 degrees");
  }
  const std::uint64_t columns = std::uint64_t(grid.azimuth_deg_size());
  beams.count = columns * std::uint64_t(grid.elevation_deg_size());
  beams.at = [&grid, axes, columns, from = beams.from_R](std::uint64_t i) {
    const double azimuth = grid.azimuth_deg(int(i % columns)) * Degree;
    const double elevation = grid.elevation_deg(int(i / columns)) * Degree;
    const V direction(std::sin(azimuth) * std::cos(elevation),
                      std::cos(azimuth) * std::cos(elevation), std::sin(elevation));
    return Beam{from, V((axes * direction).normalized())};
  };
}

void SetDirections(const v1::ScanRanges::Directions& from, const Eigen::Matrix3d& axes,
                   std::uint64_t first, Beams& beams) {
  const std::uint64_t count = RowsOf(from.direction_size(), 3, "range sensor", "direction");
  const double* data = from.direction().data();
  if (first > std::numeric_limits<std::uint64_t>::max() - count) {
    Reject("range sensor",
           "the first beam is " + std::to_string(first) +
               "; accepted: a number to which those of the directions can be added");
  }
  beams.count = count == 0 ? 0 : first + count;
  for (std::uint64_t i = 0; i < count; ++i) {
    const V direction(data + 3 * i);
    if (!direction.allFinite() || direction.isZero(0.0) || !std::isfinite(direction.norm())) {
      Reject("range sensor", "direction " + std::to_string(i) + " is " + VectorText(direction) +
                                 "; accepted: finite vectors that are not zero");
    }
  }
  beams.at = [data, axes, first, from = beams.from_R](std::uint64_t i) {
    const V direction(data + 3 * (i - first));
    return Beam{from, V((axes * direction.stableNormalized()).normalized())};
  };
}

void SetPixels(const Context& context, const PlacedLens& placed, Beams& beams) {
  const Pose X_RC = context.Frames().WorldPose(placed.camera.frame) * placed.camera.X_FC;
  const std::uint64_t width = std::uint64_t(placed.model.width);
  beams.count = width * std::uint64_t(placed.model.height);
  beams.at = [X_RC, width, lens = placed.model.lens](std::uint64_t i) {
    LensRay ray;
    const Eigen::Vector2d pixel(double(i % width), double(i / width));
    if (!lens->Unproject(pixel, ray)) {
      return Beam{};
    }
    return Beam{X_RC.Apply(ray.origin), V((X_RC.rotation * ray.direction).normalized())};
  };
}

Beams BeamsOf(const Context& context, const MeasuredScene& scene, const v1::ScanRanges& command) {
  const std::string name = "command scan_ranges";
  Beams beams;
  Axes axes;
  std::optional<PlacedLens> placed;
  switch (command.from_case()) {
  case v1::ScanRanges::kPlace: {
    const MeasuredScene::Spot spot = scene.At(command.place(), "the range sensor");
    beams.from_R = spot.p_R;
    beams.label = spot.label;
    axes.grid = axes.directions =
        context.Frames().WorldPose(spot.frame).rotation.toRotationMatrix();
    break;
  }
  case v1::ScanRanges::kSite: {
    const MeasuredScene::Spot spot = scene.At(command.site(), "the range sensor");
    const LevelAxes level = scene.AxesAt(spot);
    beams.from_R = spot.p_R;
    beams.label = spot.label;
    axes.grid << level.east, level.north, level.up;
    axes.directions = axes.grid;
    break;
  }
  case v1::ScanRanges::kCamera: {
    const CameraPose camera = CameraOf(context, command, placed);
    const Pose X_RC = context.Frames().WorldPose(camera.frame) * camera.X_FC;
    beams.from_R = X_RC.position;
    beams.label = "the range sensor at its camera";
    axes.directions = X_RC.rotation.toRotationMatrix();
    axes.grid << axes.directions.col(0), axes.directions.col(2), -axes.directions.col(1);
    break;
  }
  default:
    Reject(name, "it names no place of the sensor; accepted: place, site or camera");
  }
  beams.axes_R = axes.directions;
  switch (command.beams_case()) {
  case v1::ScanRanges::kGrid:
    beams.axes_R = axes.grid;
    SetGrid(command.grid(), axes.grid, beams);
    break;
  case v1::ScanRanges::kDirections:
    SetDirections(command.directions(), axes.directions, command.first_beam(), beams);
    break;
  case v1::ScanRanges::kPixels:
    if (!placed || !command.pixels()) {
      Reject(name, "pixels are beams of a camera; accepted: a camera, and pixels set to true");
    }
    SetPixels(context, *placed, beams);
    break;
  default:
    break;
  }
  if (beams.count == 0) {
    Reject("range sensor", "it has no beams; accepted: a grid with azimuths and elevations, "
                           "directions, or a camera's pixels");
  }
  return beams;
}

// The beams that are asked for: from the first to before the last.
std::pair<std::uint64_t, std::uint64_t> PartOf(const v1::ScanRanges& command, std::uint64_t count) {
  const std::uint64_t first = command.first_beam();
  if (first >= count) {
    Reject("range sensor", "the first beam is " + std::to_string(first) + "; accepted: 0 to " +
                               std::to_string(count - 1));
  }
  const std::uint64_t left = count - first;
  const std::uint64_t part = command.beam_count() == 0 ? left : command.beam_count();
  if (part > left || part > MostBeams) {
    Reject("range sensor", std::to_string(part) + " beams are asked for; accepted: up to " +
                               std::to_string(std::min(left, MostBeams)));
  }
  return {first, first + part};
}

void AddVector(const V& v, google::protobuf::RepeatedField<double>* to) {
  to->Add(v.data(), v.data() + 3);
}

void AddEcho(const Beam& beam, const RangeEcho& echo, v1::RangesReply& reply) {
  const V direction = beam.direction.value_or(NoVector);
  reply.add_range(echo.range);
  reply.add_true_range(echo.trueRange);
  AddVector(direction, reply.mutable_direction());
  AddVector(beam.origin + echo.range * direction, reply.mutable_point());
  AddVector(echo.normal, reply.mutable_normal());
  reply.add_incidence_deg(echo.incidence / Degree);
  reply.add_intensity(echo.intensity);
  reply.add_object(echo.label);
  reply.add_outcome(std::uint32_t(echo.outcome)); // in the same order
}

void NameThings(const Context& context, v1::RangesReply& reply) {
  std::set<ObjectId> ids(reply.object().begin(), reply.object().end());
  ids.erase(0);
  for (const ObjectId id : ids) {
    const GraphicsObject& object = context.GetScene().Object(id);
    v1::RangesReply::Thing* thing = reply.add_thing();
    thing->set_object(id);
    thing->set_name(object.name);
    thing->set_fragment(object.fragment);
    if (const TerrainObject* terrain = context.scene->TerrainOf(id)) {
      thing->set_terrain(terrain->Name());
    }
  }
}

void ScanRanges(const Context& context, v1::ScanRanges& command, RayTrees& trees) {
  const std::string name = "command scan_ranges";
  if (MethodsOf(command.measuring(), name).image) {
    Reject(name, "the method is one of pictures; accepted: EXACT");
  }
  if (command.measuring().has_wait_s()) {
    Reject(name, "it has wait_s; accepted: none, since a sensor's beams are measured at once");
  }
  const RangeSensor sensor(SettingsOf(command.sensor()));
  const double terrainAlbedo =
      command.sensor().has_terrain_albedo() ? command.sensor().terrain_albedo() : StandardAlbedo;
  const MeasuredScene scene(context, command.measuring(), command.without_object(), name, &trees);
  const Beams beams = BeamsOf(context, scene, command);
  const auto [first, last] = PartOf(command, beams.count);
  const Obstacles& obstacles = scene.Get();
  Obstacles::Start start = obstacles.StartAt(beams.from_R, beams.label);
  const RangeSensor::Meet meet = [&](const V&, const V& direction, double most) {
    const Obstacles::Met met = obstacles.Meet(start, direction, most);
    RangeMeeting meeting;
    meeting.range = met.distance;
    meeting.normal = met.normal;
    if (met.ground) {
      meeting.albedo = terrainAlbedo;
      meeting.label = met.ground->id;
    } else if (met.solid) {
      meeting.albedo = met.solid->albedo;
      meeting.label = met.solid->id;
    }
    return meeting;
  };
  v1::RangesReply reply;
  for (std::uint64_t i = first; i < last; ++i) {
    const Beam beam = beams.at(i);
    RangeEcho echo;
    if (beam.direction) {
      if (beam.origin != start.p_R) { // of a lens with a moving pupil
        start = obstacles.StartAt(beam.origin, beams.label);
      }
      echo = sensor.Measure(beam.origin, *beam.direction, i, meet);
    }
    AddEcho(beam, echo, reply);
  }
  NameThings(context, reply);
  Pose X_RS;
  X_RS.position = beams.from_R;
  X_RS.rotation = Eigen::Quaterniond(beams.axes_R);
  Put(X_RS, reply.mutable_pose());
  reply.set_beams(beams.count);
  context.reply.mutable_ranges()->Swap(&reply);
}

} // namespace

void AddRangeRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(
      C::kScanRanges, &C::mutable_scan_ranges,
      [trees = std::make_shared<RayTrees>()](const Context& context, v1::ScanRanges& command) {
        ScanRanges(context, command, *trees);
      });
}

} // namespace dspace::session
