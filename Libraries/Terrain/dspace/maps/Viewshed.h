// What is seen from places: a value for each cell of a map.
#ifndef DSPACE_MAPS_VIEWSHED_H
#define DSPACE_MAPS_VIEWSHED_H

#include <cstddef>
#include <limits>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/maps/MapCells.h>
#include <dspace/maps/MapGround.h>
#include <dspace/maps/MapWork.h>

namespace dspace {

class HeldPosts;

struct ViewshedObserver {
  Eigen::Vector2d post =
      Eigen::Vector2d::Zero(); // level-0 posts of the ground; may lie between them
  double height = 0.0;         // [m] above the ground
};

struct ViewshedOptions {
  enum class Quantity {
    Visible,     // 1: at least one observer sees the target of the cell; 0: none does
    LeastHeight, // [m] above the ground of the lowest target that at least one observer would see
    Count        // how many observers see the target
  };
  static constexpr std::size_t MostObservers = 10000;

  MapCells cells;
  std::vector<ViewshedObserver> observers; // 1 to MostObservers
  double targetHeight = 0.0;               // [m] above the ground of the cell, 0 to 1e6
  double radius = std::numeric_limits<double>::infinity(); // [m] along the ground, > 0
  std::vector<Quantity> quantities = {Quantity::Visible};  // a band each
};

// Writes the map: NaN where the cell has no data or is farther than the radius from every observer.
// Between an observer and a target are the triangles of level 0, followed at every edge that the
// line crosses, in double precision; a body's curvature counts. A target that the ground just
// touches is seen. Only this terrain is an obstacle.
//
// Continues, finishes and ends as WriteHorizonMap does. Throws what TileFile, FillTiles and Survey
// throw; Error(InvalidArgument) for an option out of range and an observer off the data; and
// Error(Resource) for ground of more than 2^28 posts, or 2^27 if it is periodic.
bool WriteViewshed(const MapGround& ground, const ViewshedOptions& options, const std::string& path,
                   const MapControl& control = {});

// The height [m] above the ground at the post `to` of the lowest target that the observer sees
// there, 0 or more; NaN where either has no data.
double LeastSeenHeight(const MapGround& ground, const HeldPosts& held,
                       const ViewshedObserver& observer, const Eigen::Vector2d& to);

} // namespace dspace

#endif
