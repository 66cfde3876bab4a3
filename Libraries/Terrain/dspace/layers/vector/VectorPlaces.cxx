#include <dspace/layers/vector/VectorPlaces.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <ogr_spatialref.h>

#include <dspace/crs/MapTurn.h>
#include <dspace/crs/ProjGrids.h>
#include <dspace/gdal/GdalErrors.h>
#include <dspace/gdal/OgrLock.h>
#include <dspace/layers/vector/VectorTurns.h>

namespace dspace {
namespace {

const Eigen::Vector2d Nowhere = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

// Whether a place of the file's CRS is within a shape, even-odd.
bool Contains(const VectorShape& shape, const Eigen::Vector2d& place) {
  bool inside = false;
  for (const VectorRing& ring : shape.rings) {
    for (std::size_t i = 1; i < ring.places.size(); ++i) {
      const Eigen::Vector2d &a = ring.places[i - 1], &b = ring.places[i];
      if ((a.y() > place.y()) != (b.y() > place.y()) &&
          place.x() < a.x() + (place.y() - a.y()) / (b.y() - a.y()) * (b.x() - a.x())) {
        inside = !inside;
      }
    }
  }
  return inside;
}

// Where that pole is in a file's CRS; nowhere where it goes once around, since areas are then
// closed over poles as they are read.
Eigen::Vector2d PoleIn(const Crs& crs, double latitude, const std::string& object) {
  if (!crs.HasGeographic() || MapTurn(crs) > 0.0) {
    return Nowhere;
  }
  const Crs degrees = crs.Geographic();
  return MapConversion(degrees, crs, object)
      .Apply({0.0, latitude / degrees.GetUnit() * NextToPole});
}

// A place a third of the way along each edge, where bends to one side and to both are seen.
double BendOf(const PlacedRing& placed, const MapConversion& conversion, double turn) {
  const std::vector<Eigen::Vector2d>& from = placed.ring->places;
  std::vector<Eigen::Vector2d> thirds;
  thirds.reserve(from.size());
  for (std::size_t i = 1; i < from.size(); ++i) {
    thirds.emplace_back((2.0 * from[i - 1] + from[i]) / 3.0);
  }
  conversion.Apply(thirds);
  double bend = 0.0;
  for (std::size_t i = 1; i < from.size(); ++i) {
    Eigen::Vector2d beside = thirds[i - 1] - (2.0 * placed.map[i - 1] + placed.map[i]) / 3.0;
    if (turn > 0.0) {
      beside.x() = std::remainder(beside.x(), turn);
    }
    bend = std::max(bend, beside.norm()); // NaN is passed over
  }
  return bend;
}

} // namespace

std::array<double, 2> PolesOf(const Crs& crs, const std::string& object) {
  const Crs degrees = crs.Geographic();
  const double right = 90.0 / degrees.GetUnit() * NextToPole;
  const MapConversion conversion(degrees, crs, object);
  return {conversion.Apply({0.0, -right}).y(), conversion.Apply({0.0, right}).y()};
}

MapConversion::MapConversion(const Crs& from, const Crs& to, const std::string& object) {
  if (!from.Ogr() || !to.Ogr()) {
    if (from.Ogr() || to.Ogr()) {
      throw Error(Error::Kind::Unsupported, object,
                  from.Ogr() ? "it is in '" + from.GetName() + "', but the terrain has no CRS"
                             : std::string("it has no CRS, but the terrain has one"));
    }
    return;
  }
  const std::lock_guard<std::mutex> lock(OgrMutex());
  if (from.GetWkt() == to.GetWkt() || from.Ogr()->IsSame(to.Ogr())) {
    return;
  }
  GdalErrors errors;
  this->Way_.reset(OGRCreateCoordinateTransformation(from.Ogr(), to.Ogr()));
  if (!this->Way_) {
    throw Error(Error::Kind::Unsupported, object,
                "it is in '" + from.GetName() + "', the terrain in '" + to.GetName() +
                    "': " + errors.Message("PROJ has no conversion; both must be of one body"));
  }
  NoteGrids(*from.Ogr(), *to.Ogr());
}

MapConversion::~MapConversion() = default;

void MapConversion::Apply(std::vector<Eigen::Vector2d>& places) const {
  if (!this->Way_ || places.empty()) {
    return;
  }
  std::vector<double> x(places.size()), y(places.size());
  for (std::size_t i = 0; i < places.size(); ++i) {
    x[i] = places[i].x();
    y[i] = places[i].y();
  }
  std::vector<int> done(places.size(), 0);
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    const GdalErrors quiet;
    this->Way_->Transform(int(places.size()), x.data(), y.data(), nullptr, nullptr, done.data());
  }
  for (std::size_t i = 0; i < places.size(); ++i) {
    const bool good = done[i] && std::isfinite(x[i]) && std::isfinite(y[i]);
    places[i] = good ? Eigen::Vector2d(x[i], y[i]) : Nowhere;
  }
}

Eigen::Vector2d MapConversion::Apply(const Eigen::Vector2d& place) const {
  if (!this->Way_) {
    return place;
  }
  double x = place.x(), y = place.y();
  int done = 0;
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  const GdalErrors quiet;
  this->Way_->Transform(1, &x, &y, nullptr, nullptr, &done);
  return done && std::isfinite(x) && std::isfinite(y) ? Eigen::Vector2d(x, y) : Nowhere;
}

VectorPlaces::VectorPlaces(const VectorFile& file, const Crs& map, std::optional<double> far,
                           const std::string& object)
    : turn(MapTurn(map)) {
  std::array<double, 2> poles = {0.0, 0.0};
  if (this->turn > 0.0) {
    poles = PolesOf(map, object);
  }
  for (const VectorGroup& group : file.groups) {
    PlacedGroup placed;
    placed.conversion = std::make_unique<const MapConversion>(group.crs, map, object);
    std::array<Eigen::Vector2d, 2> ends = {Nowhere, Nowhere}; // the poles
    if (this->turn > 0.0) {
      ends = {PoleIn(group.crs, -90.0, object), PoleIn(group.crs, 90.0, object)};
    }
    const Eigen::Vector2d pole = far ? PoleIn(group.crs, *far, object) : Nowhere;
    for (const VectorShape& shape : group.shapes) {
      PlacedShape on;
      on.shape = &shape;
      bool lost = false;
      for (const VectorRing& ring : shape.rings) {
        VectorRing moved{ring.places, ring.outline};
        placed.conversion->Apply(moved.places);
        lost |= std::any_of(moved.places.begin(), moved.places.end(),
                            [](const Eigen::Vector2d& place) { return !place.allFinite(); });
        Unwrap(moved.places, this->turn, false);
        if (this->turn > 0.0 && !lost && !on.rings.empty()) {
          BesideOf(on.rings.front().map, this->turn, moved.places);
        }
        if (shape.kind == VectorShape::Kind::Area && this->turn > 0.0) {
          const bool south = ends[0].allFinite() && Contains(shape, ends[0]);
          const bool north = ends[1].allFinite() && Contains(shape, ends[1]);
          CloseOverPole(moved, this->turn,
                        {north && !south ? poles[1] : poles[0],
                         south && !north ? poles[0] : poles[1]}); // the nearer where neither is
        }
        PlacedRing result;
        result.ring = &ring;
        result.map = std::move(moved.places);
        result.outline = ring.outline;
        if (!placed.conversion->None()) {
          result.bend = BendOf(result, *placed.conversion, this->turn);
        }
        const Eigen::Vector2d bend = Eigen::Vector2d::Constant(2.0 * result.bend);
        for (const Eigen::Vector2d& place : result.map) {
          if (place.allFinite()) {
            on.box.extend(Eigen::Vector2d(place - bend));
            on.box.extend(Eigen::Vector2d(place + bend));
          }
        }
        on.rings.push_back(std::move(result));
      }
      this->lost += lost;
      if (shape.kind == VectorShape::Kind::Area && pole.allFinite() && Contains(shape, pole)) {
        on.outside = true;
        on.box.extend(Eigen::Vector2d::Constant(-1e15));
        on.box.extend(Eigen::Vector2d::Constant(1e15));
      }
      // Of an area a part would be another area; of a path its parts are what there is.
      if (!on.box.isEmpty() && !(lost && shape.kind == VectorShape::Kind::Area)) {
        placed.shapes.push_back(std::move(on));
      }
    }
    this->groups.push_back(std::move(placed));
  }
}

} // namespace dspace
