// One patch of a terrain group: its source, place, posts and weight.
#ifndef DSPACE_TERRAIN_PATCH_H
#define DSPACE_TERRAIN_PATCH_H

#include <array>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>
#include <vector>

#include <dspace/groups/GroupPosts.h>
#include <dspace/posts/RasterPosts.h>
#include <dspace/raster/LruCache.h>

#include <dspace/groups/PatchPlace.h>
#include <dspace/groups/PatchWeight.h>

namespace dspace {

class Patch {
public:
  static constexpr double Whole = 1.0 - 1e-9; // from this weight on, it is shown alone
  static constexpr double Tolerance = 0.005;  // pixels, at the places that are looked at

  // Throws what OpenPatches throws. Appends doubts to `warnings`.
  Patch(const ElevationInfo& base, const TerrainPatch& options, std::vector<std::string>& warnings);

  // One that was settled, on another base of the same body.
  Patch(const Patch& other, const ElevationInfo& on);

  const std::string& Object() const { return this->Object_; } // "patch 'name'"
  const ElevationSource& Source() const { return *this->Source_; }
  const PatchPlace& Place() const { return this->Place_; }
  const PatchWeight& Weight() const { return *this->Weight_; }
  PatchReport& Report() { return this->Report_; }
  const RasterPosts& Posts() const { return *this->Posts_; } // its own
  double AddedTo() const { return this->Report_.addedTo; }   // its heights [m]
  // The level of its own posts that are about as far apart as those of a level of the lattice.
  int LevelFor(int level) const;
  // The square of level 0 that pixels are interpolated in; kept where it is costly.
  PatchPlace::Corners CornersAbout(std::int64_t column, std::int64_t row) const;

  // Sets the lattice and, if the patch lies within, reads it for its weights. Returns false, with a
  // warning, if the patch adds nothing.
  bool Attach(const PostLattice& lattice, const Eigen::Affine2d& postToMap, bool poles,
              std::vector<std::string>& warnings);
  // The range of its heights in a box of places of level 0; least above greatest where it does
  // not reach, infinite where nothing is known.
  std::array<double, 2> HeightsIn(const Eigen::AlignedBox2d& posts) const;
  // Returns which posts of a block are filled; called by the first patch that reaches the block.
  using FilledMask = std::function<std::vector<char>&()>;
  // Over the heights of a block of that lattice, alone where they are none or made up. `filledMask`
  // may be empty: nothing is.
  void Blend(const PostBlock& block, float* heights, const FilledMask& filledMask) const;
  // Of one that was settled elsewhere: its weights are known. False where it does not lie within.
  bool Reattach(const PostLattice& lattice, const Eigen::Affine2d& postToMap);

private:
  class Heights;

  std::string Object_;
  std::shared_ptr<const ElevationSource> Source_;
  PatchPlace Place_;
  PatchReport Report_;
  std::shared_ptr<const RasterPosts> Posts_;
  std::shared_ptr<const PatchWeight> Weight_;
  double PostPixels_ = 1.0;  // of the patch, between level-0 posts
  mutable std::mutex Mutex_; // of what follows
  // By size and first post; none where places are not interpolated. 4 MB.
  mutable LruCache<std::array<std::int64_t, 3>, std::optional<PatchPlace::Corners>> Corners_{16384};
};

} // namespace dspace

#endif
