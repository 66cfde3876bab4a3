// Where the posts of a terrain lie among its wheel tracks. Not for public headers.
#ifndef DSPACE_TERRAIN_TRACKMAP_H
#define DSPACE_TERRAIN_TRACKMAP_H

#include <memory>
#include <optional>

#include <Eigen/Geometry>

#include <dspace/posts/PostPlacement.h>
#include <dspace/tracks/TrackChart.h>

namespace dspace {

class WheelTracks;

// Tracks lie in the scene's XY plane, or on a body in the plane of a TrackChart. Posts count those
// of level 0.
class TrackMap {
public:
  // The vertical at a longitude and a latitude [rad].
  static Eigen::Vector3d UpOf(const Eigen::Vector2d& angles);

  // None on a body where there are no tracks yet, and thus no chart.
  static std::optional<TrackMap> Of(const PostPlacement& placement, const WheelTracks& tracks);

  Eigen::Vector2d ToTracks(const Eigen::Vector2d& post) const;
  // Metres of the tracks' plane per metre on the ground at a height.
  double Scale(const Eigen::Vector2d& post, double height) const;
  // A box among the tracks that holds all of a box of posts.
  Eigen::AlignedBox2d BoxOf(const Eigen::AlignedBox2d& posts) const;
  // A box of posts that holds all of a box among the tracks; around a body in the turn that is
  // nearest to a column.
  Eigen::AlignedBox2d PostsIn(const Eigen::AlignedBox2d& box, double column) const;

private:
  TrackMap(const PostPlacement& placement, std::shared_ptr<const TrackChart> chart)
      : Placement_(placement), Chart_(std::move(chart)) {}
  Eigen::Vector3d UpAt(const Eigen::Vector2d& post) const;

  PostPlacement Placement_;
  std::shared_ptr<const TrackChart> Chart_; // null on a plane
};

} // namespace dspace

#endif
