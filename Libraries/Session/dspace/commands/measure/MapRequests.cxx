// Maps of horizons, viewsheds and illumination.
#include <algorithm>
#include <cmath>
#include <filesystem>
#include <memory>
#include <utility>

#include <dspace/Checks.h>
#include <dspace/commands/measure/MapJobs.h>
#include <dspace/crs/CrsTransform.h>
#include <dspace/ephemeris/BodyNames.h>
#include <dspace/ephemeris/Fallbacks.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/maps/Illumination.h>
#include <dspace/maps/Viewshed.h>
#include <dspace/orientation/BodyConstants.h>
#include <dspace/orientation/Site.h>
#include <dspace/proto/maps.pb.h>
#include <dspace/sky/KernelSet.h>
#include <dspace/sky/SkyEclipse.h>
#include <dspace/sky/SkyView.h>
#include <dspace/state/TerrainBody.h>
#include <dspace/time/TimeSteps.h>

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

MapCells CellsOf(const MapGround& ground, const v1::MapArea& area) {
  std::optional<std::array<double, 4>> extent;
  if (area.extent_size() == 4) {
    extent = {area.extent(0), area.extent(1), area.extent(2), area.extent(3)};
  } else if (area.extent_size() != 0) {
    Reject(ground.name, "the extent has " + std::to_string(area.extent_size()) +
                            " numbers; accepted: 4 (left, top, right, bottom), or none");
  }
  return FindCells(ground, extent, area.cell_size());
}

// Runs, awaits or cancels the work of a request on the file `path`.
using Begin = std::function<MapJobs::Job(const std::string& path)>;
template<class Command>
void RunJob(const Context& context, MapJobs& jobs, const Command& command, const Begin& begin) {
  const v1::MapFile& file = command.file();
  if (file.path().empty()) {
    Reject("command", "it names no file; accepted: the path of a new file");
  }
  const std::string path = std::filesystem::absolute(file.path()).lexically_normal().string();
  MapJobs::Status status;
  if (file.cancel()) {
    status = jobs.Cancel(path);
  } else {
    Command key = command;
    key.mutable_file()->clear_wait_s();
    MapControl control;
    control.threads = int(file.threads());
    control.replace = file.replace();
    status = jobs.Run(
        path, Command::descriptor()->name() + context.sceneName + key.SerializeAsString(), control,
        [&] { return begin(path); },
        file.has_wait_s() ? std::optional<double>(file.wait_s()) : std::nullopt);
  }
  v1::MapReply* reply = context.reply.mutable_map();
  reply->set_path(path);
  reply->set_columns(std::uint32_t(status.shape.columns));
  reply->set_rows(std::uint32_t(status.shape.rows));
  reply->set_bands(std::uint32_t(status.shape.bands));
  reply->set_cell_size(status.shape.cellSize);
  reply->set_complete(status.complete);
  reply->set_fraction(status.complete ? 1.0 : status.progress.fraction);
  reply->set_left_s(status.complete ? 0.0 : status.progress.left);
}

double CellSize(const MapGround& ground, const MapCells& cells) {
  return cells.every * std::sqrt(std::abs(ground.postToMap.linear().determinant()));
}

// Complete maps in the folder "PATH.parts", in the order of their names.
std::vector<std::string> PartsOf(const std::string& path) {
  std::vector<std::string> parts;
  std::error_code none; // there is no such folder
  for (const auto& entry : std::filesystem::directory_iterator(path + ".parts", none)) {
    if (entry.path().extension() == ".tif") {
      parts.push_back(entry.path().string());
    }
  }
  std::sort(parts.begin(), parts.end());
  return parts;
}

void MapHorizons(const Context& context, MapJobs& jobs, const v1::HorizonMap& command) {
  RunJob(context, jobs, command, [&](const std::string& path) {
    const auto ground = std::make_shared<const MapGround>(
        MapGroundOf(TerrainNamed(context, command.terrain()).Surface()));
    HorizonMapOptions options;
    options.cells = CellsOf(*ground, command.area());
    options.height = command.height();
    options.fast = command.fast();
    if (command.azimuths() != 0) {
      options.azimuths = int(command.azimuths());
    }
    options.parts = PartsOf(path);
    return MapJobs::Job{[ground, options, path](const MapControl& control) {
                          return WriteHorizonMap(*ground, options, path, control);
                        },
                        {options.cells.columns, options.cells.rows, options.azimuths,
                         CellSize(*ground, options.cells)}};
  });
}

ViewshedOptions::Quantity QuantityOf(int quantity) {
  switch (quantity) {
  case v1::Viewshed::VISIBLE:
    return ViewshedOptions::Quantity::Visible;
  case v1::Viewshed::LEAST_HEIGHT:
    return ViewshedOptions::Quantity::LeastHeight;
  case v1::Viewshed::COUNT:
    return ViewshedOptions::Quantity::Count;
  default:
    Reject("command viewshed", "a quantity is " + std::to_string(quantity) +
                                   "; accepted: VISIBLE, LEAST_HEIGHT, COUNT");
  }
}

void MapViewshed(const Context& context, MapJobs& jobs, const v1::Viewshed& command) {
  RunJob(context, jobs, command, [&](const std::string& path) {
    const std::string name = "command viewshed";
    if (command.site_size() < 1 ||
        std::size_t(command.site_size()) > ViewshedOptions::MostObservers) {
      Reject(name, std::to_string(command.site_size()) + " sites; accepted: 1 to 10,000");
    }
    const TerrainObject& terrain = TerrainNamed(context, command.site(0).terrain());
    const TerrainSurface& surface = terrain.Surface();
    const auto ground = std::make_shared<const MapGround>(MapGroundOf(surface));
    const Eigen::Affine2d mapToPost = ground->postToMap.inverse();
    ViewshedOptions options;
    options.cells = CellsOf(*ground, command.area());
    for (int i = 0; i < command.site_size(); ++i) {
      const v1::Site& site = command.site(i);
      const std::string label = "site " + std::to_string(i) + " (" + NumberText(site.map_x()) +
                                ", " + NumberText(site.map_y()) + ") of terrain '" +
                                site.terrain() + "'";
      if (site.terrain() != command.site(0).terrain()) {
        Reject(label, "another site is of terrain '" + command.site(0).terrain() +
                          "'; accepted: sites of one terrain");
      }
      Require(site.height() >= 0.0 && site.height() <= 1e6, label, "its height above the ground",
              site.height(), "0 to 1e6 m");
      const Eigen::Vector2d map(site.map_x(), site.map_y());
      if (!map.allFinite() || !surface.SampleMap(map).valid) {
        Reject(label, "the terrain has no data there; accepted: map coordinates on its data");
      }
      options.observers.push_back({mapToPost * map, site.height()});
    }
    options.targetHeight = command.target_height();
    options.radius =
        command.radius() > 0.0 ? command.radius() : std::numeric_limits<double>::infinity();
    if (command.quantity_size() > 0) {
      options.quantities.clear();
    }
    for (const int quantity : command.quantity()) {
      options.quantities.push_back(QuantityOf(quantity));
    }
    return MapJobs::Job{[ground, options, path](const MapControl& control) {
                          return WriteViewshed(*ground, options, path, control);
                        },
                        {options.cells.columns, options.cells.rows, int(options.quantities.size()),
                         CellSize(*ground, options.cells)}};
  });
}

IlluminationOptions::Quantity IlluminationOf(int quantity) {
  using Q = IlluminationOptions::Quantity;
  switch (quantity) {
  case v1::IlluminationMap::LIT_FRACTION:
    return Q::LitFraction;
  case v1::IlluminationMap::LONGEST_NIGHT:
    return Q::LongestNight;
  case v1::IlluminationMap::EARTH_FRACTION:
    return Q::EarthFraction;
  case v1::IlluminationMap::PERMANENT_SHADOW:
    return Q::PermanentShadow;
  case v1::IlluminationMap::STATION_FRACTION:
    return Q::StationFraction;
  default:
    Reject("command illumination_map",
           "a quantity is " + std::to_string(quantity) +
               "; accepted: LIT_FRACTION, LONGEST_NIGHT, EARTH_FRACTION, PERMANENT_SHADOW, "
               "STATION_FRACTION");
  }
}

std::vector<Eigen::Vector3d> PointsOf(const google::protobuf::RepeatedField<double>& numbers,
                                      const char* what) {
  if (numbers.size() % 3 != 0) {
    Reject("command illumination_map", std::string(what) + " has " +
                                           std::to_string(numbers.size()) +
                                           " numbers; accepted: x y z a step");
  }
  std::vector<Eigen::Vector3d> points;
  for (int i = 0; i < numbers.size(); i += 3) {
    points.emplace_back(numbers[i], numbers[i + 1], numbers[i + 2]);
  }
  return points;
}

// From body-fixed axes to those of a plane's scene: east, north and up at the middle of the map,
// turned about the vertical to the map's X and Y.
struct PlaneAxes {
  Eigen::Matrix3d toMap = Eigen::Matrix3d::Identity();
  Eigen::Vector3d middle = Eigen::Vector3d::Zero();
};
PlaneAxes AxesOfPlane(const HorizonMap& horizons) {
  const Crs& crs = horizons.GetCrs();
  if (!crs.HasGeographic()) {
    throw Error(Error::Kind::Unsupported, "file '" + horizons.Path() + "'",
                "the map has no longitudes and latitudes; accepted: a map with a CRS on a body, or "
                "positions of the Sun");
  }
  const CrsTransform transform(crs, crs.Geographic());
  const Eigen::Vector2d middle =
      horizons.CellToMap() * Eigen::Vector2d(0.5 * horizons.Columns(), 0.5 * horizons.Rows());
  const Eigen::Vector2d place = transform.Apply(middle);
  const double radius = crs.GetAxes().semiMajor;
  const LocalAxes axes = AxesAt({place.x(), place.y(), 0.0, LatitudeKind::Geodetic},
                                Eigen::Vector3d(radius, radius, crs.GetAxes().semiMinor));
  // Where the meridian leads on the map, away from the nearer pole.
  const double step = place.y() > 0.0 ? -1e-4 : 1e-4;
  const Eigen::Vector2d there = transform.ApplyInverse({place.x(), place.y() + step});
  const Eigen::Vector2d north = ((there - middle) / step).normalized();
  Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
  turn.topLeftCorner<2, 2>() << north.y(), north.x(), -north.x(), north.y();
  return {turn * axes.toLocal, axes.position};
}

// The stations of the command that see the middle of the map over their masks, at each time.
void FindStations(const Context& context, const v1::IlluminationMap& command,
                  const HorizonMap& horizons, int body, const std::vector<double>& times,
                  IlluminationOptions& options) {
  const SkyMotions& sky = context.scene->sky;
  const Ephemeris& ephemeris = sky.kernels->GetEphemeris();
  const Frames& frames = sky.kernels->GetFrames();
  const PlaneAxes middle = AxesOfPlane(horizons);
  dspace::SkyPlace place;
  place.body = body;
  place.frame = frames.Table().BodyFixed(body).name;
  place.axes.position = middle.middle;
  std::vector<dspace::SkyPlace> stations;
  for (const v1::CelestialPlace::Site& site : command.station()) {
    v1::CelestialPlace at;
    at.set_body("earth");
    *at.mutable_site() = site;
    stations.push_back(SkyPlaceOf(*sky.kernels, sky.PlaceOf(at), Pose()));
  }
  for (const double tdb : times) {
    FallbackScope::Begin(tdb);
    std::vector<Eigen::Vector3d>& seen = options.stations_S.emplace_back();
    for (const dspace::SkyPlace& station : stations) {
      const SightedPoint point = SightPoint(
          ephemeris, frames, place, [&](double) { return station; }, tdb);
      if (ElevationFrom(frames, point, tdb) >= command.station_mask_deg()) {
        const Eigen::Vector3d away = frames.Rotation("J2000", place.frame, tdb) *
                                     Aberrated(point.away, point.observer.velocity);
        seen.push_back(horizons.Placement().OnBody() ? Eigen::Vector3d(middle.middle + away)
                                                     : Eigen::Vector3d(middle.toMap * away));
      }
    }
  }
}

void FindBodies(const Context& context, const v1::IlluminationMap& command,
                const HorizonMap& horizons, bool earth, IlluminationOptions& options) {
  const std::string name = "command illumination_map";
  const double span = command.end_s() - command.start_s();
  RequireFinite(name, "the start", command.start_s());
  Require(span > 0.0 && std::isfinite(span), name, "the span from the start to the end", span,
          "more than 0 s");
  Require(span / command.step_s() < double(IlluminationOptions::MostSteps), name,
          "the number of steps", span / command.step_s(), "up to 10,000,000");
  const KernelSet& kernels = *context.scene->sky.kernels;
  const Ephemeris& ephemeris = kernels.GetEphemeris();
  const std::string label = "file '" + command.horizon_path() + "'";
  const int body =
      BodyFor(kernels, horizons.GetCrs(), command.body(), label, [&](const std::string&) {
        const int own = *FindBody(kernels, horizons.GetCrs());
        Reject(label, "it is a horizon map of body '" + ephemeris.Names().NameOf(own) +
                          "', and the command names '" + command.body() +
                          "'; accepted: the body of its ground, or none");
      });
  std::vector<double> times;
  const std::int64_t steps = StepsBefore(command.start_s(), command.end_s(), command.step_s());
  for (std::int64_t i = 0; i < steps; ++i) {
    times.push_back(command.start_s() + double(i) * command.step_s());
  }
  const PlaneAxes plane = horizons.Placement().OnBody() ? PlaneAxes() : AxesOfPlane(horizons);
  const auto find = [&](int target, std::vector<Eigen::Vector3d>& places) {
    Ephemeris::Query query;
    query.target = target;
    query.observer = body;
    query.frame = kernels.GetFrames().Table().BodyFixed(body).name;
    query.correction = Correction::ConvergedStar;
    std::vector<Ephemeris::Result> results(times.size());
    ephemeris.FindMany(query, times.data(), times.size(), results.data());
    for (const Ephemeris::Result& result : results) {
      places.emplace_back(plane.toMap * (result.state.position - plane.middle));
    }
  };
  const BodyNames& names = ephemeris.Names();
  find(BodySun, options.sun_S);
  if (earth) {
    find(names.IdOf("earth"), options.earth_S);
  }
  const std::optional<int> eclipser = EclipserOver(body);
  if (eclipser && (!command.has_eclipses() || command.eclipses())) {
    find(*eclipser, options.eclipser_S);
    options.eclipserRadius = BodyRadii(kernels.GetFrames().Pool(), *eclipser).maxCoeff();
  }
  if (command.station_size() > 0) {
    if (body == names.IdOf("earth")) {
      Reject(name, "the map is of the Earth, and its stations are on it; accepted: another body");
    }
    FindStations(context, command, horizons, body, times, options);
  }
}

void MapIllumination(const Context& context, MapJobs& jobs, const v1::IlluminationMap& command) {
  RunJob(context, jobs, command, [&](const std::string& path) {
    const std::string name = "command illumination_map";
    const auto horizons = std::make_shared<const HorizonMap>(command.horizon_path());
    Require(command.step_s() > 0.0, name, "the step", command.step_s(), "more than 0 s");
    auto options = std::make_shared<IlluminationOptions>();
    options->step_s = command.step_s();
    bool earth = false;
    bool links = false;
    if (command.quantity_size() > 0) {
      options->quantities.clear();
    }
    for (const int quantity : command.quantity()) {
      options->quantities.push_back(IlluminationOf(quantity));
      earth |= options->quantities.back() == IlluminationOptions::Quantity::EarthFraction;
      links |= options->quantities.back() == IlluminationOptions::Quantity::StationFraction;
    }
    constexpr int MostStations = 100;
    if (links != (command.station_size() > 0) || command.station_size() > MostStations) {
      Reject(name, "it has " + std::to_string(command.station_size()) + " stations; accepted: " +
                       (links ? "1 to 100 for STATION_FRACTION" : "none without STATION_FRACTION"));
    }
    if (links && command.sun_position_size() > 0) {
      Reject(name, "it has stations and positions of the Sun; accepted: stations with times");
    }
    std::shared_ptr<const MapGround> ground;
    if (!command.terrain().empty()) {
      ground = std::make_shared<const MapGround>(
          MapGroundOf(TerrainNamed(context, command.terrain()).Surface()));
    }
    options->sun_S = PointsOf(command.sun_position(), "sun_position");
    options->earth_S = PointsOf(command.earth_position(), "earth_position");
    if (options->sun_S.empty()) {
      if (!options->earth_S.empty()) {
        Reject(name,
               "it has positions of the Earth without those of the Sun; accepted: both, those "
               "of the Sun, or none");
      }
      FindBodies(context, command, *horizons, earth, *options);
    }
    return MapJobs::Job{
        [horizons, options, ground, path](const MapControl& control) {
          if (ground) {
            const std::optional<GroundSurvey> survey =
                Survey(*ground, [&] { return !control.progress || control.progress({}); });
            if (!survey) {
              return false;
            }
            if (survey->hash != horizons->TerrainHash()) {
              Reject("file '" + horizons->Path() + "'",
                     "it is a horizon map of other ground (" + horizons->Terrain() + ") than " +
                         ground->name + "; accepted: a map of this terrain as it is now");
            }
          }
          return WriteIllumination(*horizons, *options, path, control);
        },
        {horizons->Columns(), horizons->Rows(), int(options->quantities.size()), 0.0}};
  });
}

} // namespace

void AddMapRequests(Registry& registry) {
  using C = v1::Command;
  const auto jobs = std::make_shared<MapJobs>();
  registry.Add(C::kHorizonMap, &C::mutable_horizon_map,
               [jobs](const Context& context, v1::HorizonMap& command) {
                 MapHorizons(context, *jobs, command);
               });
  registry.Add(C::kViewshed, &C::mutable_viewshed,
               [jobs](const Context& context, v1::Viewshed& command) {
                 MapViewshed(context, *jobs, command);
               });
  registry.Add(C::kIlluminationMap, &C::mutable_illumination_map,
               [jobs](const Context& context, v1::IlluminationMap& command) {
                 MapIllumination(context, *jobs, command);
               });
}

} // namespace dspace::session
