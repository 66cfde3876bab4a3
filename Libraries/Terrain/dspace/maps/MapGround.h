// The ground that a map is computed on, apart from the terrain that a scene shows.
#ifndef DSPACE_MAPS_MAP_GROUND_H
#define DSPACE_MAPS_MAP_GROUND_H

#include <array>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include <dspace/crs/Crs.h>
#include <dspace/posts/PostPlacement.h>
#include <dspace/pyramid/ElevationPyramid.h>
#include <dspace/surface/TerrainSurface.h>

namespace dspace {

// Holds what it needs of a terrain: other threads may read it while the terrain is drawn or closed.
struct MapGround {
  std::string name; // of the terrain, for messages: "terrain 'gale.tif'"
  std::shared_ptr<ElevationPyramid> pyramid;
  PostPlacement placement;
  Eigen::Affine2d postToMap = Eigen::Affine2d::Identity(); // level-0 posts to map coordinates
  Crs crs;
  Eigen::Vector2d firstPixel = Eigen::Vector2d::Zero(); // the post at its centre
  int postsAPixel = 1;
};

// Of a terrain that is streamed or held as a grid, whose heights are then copied. Throws
// Error(Unsupported) for another one.
MapGround MapGroundOf(const TerrainSurface& surface);

// What one walk over the posts finds.
struct GroundSurvey {
  std::array<double, 2> heights = {0.0, 0.0}; // [m] all ground lies between
  bool exact = true;      // false: a guess from coarser posts, widened (more than 2^28 posts)
  std::uint64_t hash = 0; // of the posts' heights and places
};
// `proceed` is called now and then; false ends the walk, and the result is empty. Throws what
// ElevationPyramid::Read throws, and Error(InvalidArgument) for ground without any data.
std::optional<GroundSurvey> Survey(const MapGround& ground, const std::function<bool()>& proceed);

// Mixes values into a hash of 64 bits: a difference is found, an intended collision is not.
class InputHash {
public:
  void Add(std::uint64_t value);
  void Add(double value);
  void Add(const std::string& text);
  std::uint64_t Get() const { return this->State_; }

private:
  std::uint64_t State_ = 0x9e3779b97f4a7c15ull;
};

} // namespace dspace

#endif
