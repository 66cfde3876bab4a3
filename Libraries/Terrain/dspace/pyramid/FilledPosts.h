// The posts of a raster with holes filled from the surrounding ground.
#ifndef DSPACE_TERRAIN_FILLEDPOSTS_H
#define DSPACE_TERRAIN_FILLEDPOSTS_H

#include <array>
#include <limits>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include <dspace/posts/RasterPosts.h>

namespace dspace {

template<typename Key, typename Value> class LruCache;

// Posts with data are the raster's, to the bit. A hole is filled from coarse to fine: a level's
// posts without data start as the straight line between those of the next coarser level, and are
// then drawn towards the mean of their four neighbours eight times, so that they join on to the
// data at the rim; the coarsest level solves for that mean (a membrane over the hole). A coarser
// post whose cell has data in part counts by that part: not up to three quarters, wholly where all
// of it has. On a plane the filled ground is the plane but for what such cells lean to their data's
// side, a thirtieth of a post's spacing times the slope; curved ground is seen from some pixels
// outside the rim, in the middle of a hole from a tenth of its radius; where a hole reaches the
// raster's edge, it runs out level there. What a post is depends on the raster and its overviews
// alone, which must stay the same. Where the
// coarsest level has no data, or nothing is within reach, holes stay.
class FilledPosts : public PostSource {
public:
  // `reach`: no post further from data than so many of the raster's pixels is filled, to within a
  // sixtieth of that; > 0. Throws Error(InvalidArgument).
  explicit FilledPosts(std::shared_ptr<const RasterPosts> posts,
                       double reach = std::numeric_limits<double>::infinity());
  ~FilledPosts() override;

  const std::string& GetName() const override { return this->Posts_->GetName(); }
  const PostLattice& GetLattice() const override { return this->Posts_->GetLattice(); }
  void Read(const PostBlock& block, float* heights) const override;

private:
  using Key = std::array<std::int64_t, 3>; // level, tile column, tile row
  using Heights = std::shared_ptr<const std::vector<float>>;
  std::vector<float> Fill(const PostBlock& block) const;
  std::vector<float> FromTiles(const PostBlock& block) const;
  Heights TileOf(const Key& key) const;
  Heights Top() const;
  void StartFromCoarser(const PostBlock& block, const std::vector<float>& weights,
                        std::vector<double>& heights) const;

  std::shared_ptr<const RasterPosts> Posts_;
  double Reach_;
  mutable std::mutex Mutex_; // of what follows
  mutable Heights Top_;
  mutable std::unique_ptr<LruCache<Key, Heights>> Tiles_; // of levels above the full one
};

} // namespace dspace

#endif
