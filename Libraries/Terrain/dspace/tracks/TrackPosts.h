// Posts with the ruts of wheels in them.
#ifndef DSPACE_TERRAIN_TRACKPOSTS_H
#define DSPACE_TERRAIN_TRACKPOSTS_H

#include <array>
#include <cstdint>
#include <memory>
#include <mutex>
#include <vector>

#include <dspace/posts/PostPlacement.h>
#include <dspace/posts/PostSource.h>
#include <dspace/tracks/WheelTracks.h>

namespace dspace {

class TrackMap;
template<typename Key, typename Value> class LruCache;

// A post of level 0 is lowered by the depth where it stands; one of a coarser level by
// the mean over its cell, of 2^level x 2^level places up to 8 x 8, evenly apart. A level whose
// posts are more than four times as far apart as a rut is wide, rims included, does not show that
// rut. What the source has where ruts are is kept (8 MiB, the latest): new ones do not read it
// again.
class TrackPosts : public PostSource {
public:
  // `postToScene` takes level-0 posts to the tracks' coordinates; invertible.
  TrackPosts(std::shared_ptr<const PostSource> source, std::shared_ptr<const WheelTracks> tracks,
             const Eigen::Affine2d& postToScene);
  // On a plane or on a body.
  TrackPosts(std::shared_ptr<const PostSource> source, std::shared_ptr<const WheelTracks> tracks,
             const PostPlacement& placement);
  ~TrackPosts() override;

  const std::string& GetName() const override { return this->Source_->GetName(); }
  const PostLattice& GetLattice() const override { return this->Source_->GetLattice(); }
  void Read(const PostBlock& block, float* heights) const override;
  bool ReadWithTracks(const PostBlock& block, float* heights, float* tracks) const override;
  std::unique_ptr<PostProbe> MakeProbe() const override;
  // Whether a rut may reach into the cells of a block.
  bool Reaches(const PostBlock& block) const;

  // Lowers heights of the bare ground where posts of a level stand by the ruts there, as at level
  // 0: no means are taken. Where a rut or its rim reaches, `tracks`, unless null, gets how much was
  // rolled over, 0 to 1.
  void Lower(const PostBlock& block, float* heights, float* tracks = nullptr) const;

  // The rectangles to invalidate in a pyramid.
  std::vector<PostRectangle> RectanglesOf(const std::vector<TrackReach>& changed) const;

private:
  using Key = std::array<std::int64_t, 3>; // level, tile column, tile row
  double Spacing(int level) const;         // [m] of posts, the lesser of the two
  Eigen::AlignedBox2d Around(const PostBlock& block, const TrackMap& map) const;
  std::vector<TrackSegment> Near(const PostBlock& block, const TrackMap& map,
                                 double width) const; // ruts as wide [m]
  void ReadSource(const PostBlock& block, float* heights) const;
  std::shared_ptr<const std::vector<float>> TileOf(const Key& key) const;

  std::shared_ptr<const PostSource> Source_;
  std::shared_ptr<const WheelTracks> Tracks_;
  PostPlacement Placement_;
  mutable std::mutex Mutex_; // of what follows
  mutable std::unique_ptr<LruCache<Key, std::shared_ptr<const std::vector<float>>>> Tiles_;
};

} // namespace dspace

#endif
