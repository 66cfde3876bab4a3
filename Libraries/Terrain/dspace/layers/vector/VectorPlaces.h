// Shapes on the map of one chart of a terrain. Not for public headers.
#ifndef DSPACE_LAYERS_VECTORPLACES_H
#define DSPACE_LAYERS_VECTORPLACES_H

#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dspace/layers/vector/VectorShapes.h>

class OGRCoordinateTransformation;

namespace dspace {

// Map coordinates of one CRS to those of another; from any thread.
class MapConversion {
public:
  // None where both are the same or one is unknown. Throws Error(Unsupported) naming `object` where
  // PROJ has no way between the two, as between two bodies.
  MapConversion(const Crs& from, const Crs& to, const std::string& object);
  ~MapConversion();
  bool None() const { return !this->Way_; }
  // In place; what has no value in `to` becomes NaN.
  void Apply(std::vector<Eigen::Vector2d>& places) const;
  Eigen::Vector2d Apply(const Eigen::Vector2d& place) const;

private:
  mutable std::mutex Mutex_;
  std::unique_ptr<OGRCoordinateTransformation> Way_;
};

// Map y of the south and the north pole, or all but, of a CRS in which x goes once around.
std::array<double, 2> PolesOf(const Crs& crs, const std::string& object);

struct PlacedRing {
  const VectorRing* ring = nullptr;
  std::vector<Eigen::Vector2d> map; // of ring->places, then what closes it over a pole of the map
  std::size_t outline = 0;
  double bend = 0.0; // how far an edge of the file's CRS lies beside the chord on the map, about
};

struct PlacedShape {
  const VectorShape* shape = nullptr;
  std::vector<PlacedRing> rings;
  Eigen::AlignedBox2d box; // of all of it, on the map
  bool outside = false;    // contains what the map has infinitely far out: all outside of its rings
};

struct PlacedGroup {
  std::unique_ptr<const MapConversion> conversion;
  std::vector<PlacedShape> shapes;
};

// Keeps pointers into `file`, which must stay.
struct VectorPlaces {
  // `far`: the latitude [deg] of the pole that the map has infinitely far out, if it has one.
  VectorPlaces(const VectorFile& file, const Crs& map, std::optional<double> far,
               const std::string& object);

  double turn = 0.0; // after how much of map x it repeats; 0: never
  std::vector<PlacedGroup> groups;
  std::size_t lost = 0; // shapes that have no place on the map, at least in part
};

} // namespace dspace

#endif
