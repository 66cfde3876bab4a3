// A terrain group: the posts of a raster with patches of higher resolution on it.
#ifndef DSPACE_TERRAIN_GROUPPOSTS_H
#define DSPACE_TERRAIN_GROUPPOSTS_H

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>

#include <dspace/posts/PostSource.h>
#include <dspace/raster/ElevationSource.h>

namespace dspace {

class GroupProbe;
class Patch;

struct TerrainPatch {
  std::string path;
  ElevationOptions elevation;
  // [m] on the ground, over which it is blended into what lies under it, inward from its edge and
  // its holes. > 0; absent: a tenth of its shorter side.
  std::optional<double> margin;
  std::string name; // for messages; empty: the path
};

// The result for one patch. Heights are above the base's vertical datum.
struct PatchReport {
  std::string name;
  bool used = false;    // false: it has no data, or none on the base; there is a warning
  double pixel = 0.0;   // [m] the longer side of its pixels on the ground, in its middle
  double margin = 0.0;  // [m]
  double addedTo = 0.0; // [m] its datum's zero above the base's, added to its heights
  std::array<double, 2> heights = {0.0, 0.0}; // least and greatest [m]
  bool heightsAreExact = false;               // every pixel was read
  // Resampling: the group's surface against the patch's own heights at its posts, at `posts` of
  // them taken at random where nothing is blended and before later patches. 0 posts: not measured.
  int posts = 0;
  double rmsError = 0.0;      // [m]
  double greatestError = 0.0; // [m]
};

struct GroupReport {
  std::vector<PatchReport> patches; // in their order
  std::vector<std::string> warnings;
};

// Patches of one base, opened; before there is a lattice.
class OpenPatches {
public:
  // Throws what ElevationSource throws, and Error(InvalidArgument) naming the patch where it is of
  // another body than the base, only one of the two has a CRS, or the margin is out of range.
  OpenPatches(const ElevationInfo& base, const std::vector<TerrainPatch>& patches);
  OpenPatches(OpenPatches&&) noexcept;
  ~OpenPatches();
  // How often the base's pixels are to be halved so that posts are no further apart than the finest
  // patch's pixels; 0 to 24.
  int Subdivisions() const { return this->Subdivisions_; }

private:
  friend class GroupPosts;
  std::vector<std::shared_ptr<Patch>> Patches_;
  int Subdivisions_ = 0;
  std::vector<std::string> Warnings_;
};

// On the base's posts, in the order of the patches: height = under + weight (patch - under). The
// weight is PatchWeight's, hence across a border the height changes by at most 1.5 sqrt(2) / margin
// times |patch - under| a metre more than the two themselves do. A patch's height between its own
// posts is that of HeightGrid's triangles; on level l it is that of the level of its own
// RasterPosts whose posts are about as far apart, and the weight is the mean over as many pixels.
// Its posts are found by PROJ to within 0.01 of a pixel (of that level). Where the
// ground below has no data or is filled, the patch is shown alone.
class GroupPosts : public PostSource {
public:
  // `postToMap` takes level-0 posts of `base` to its map; with `poles` its first and last rows are
  // a pole each. `data` is the base without filled posts; null: no post is filled. Reads the
  // patches once, for their weights and errors.
  GroupPosts(std::shared_ptr<const PostSource> base, const Eigen::Affine2d& postToMap, bool poles,
             OpenPatches patches, std::shared_ptr<const PostSource> data = nullptr);
  ~GroupPosts() override;

  const std::string& GetName() const override { return this->Name_; }
  const PostLattice& GetLattice() const override { return this->Base_->GetLattice(); }
  void Read(const PostBlock& block, float* heights) const override;

  // Null where only blocks are read: the base has no probe, holes are filled, or a patch is finer
  // than the posts.
  std::unique_ptr<PostProbe> MakeProbe() const override;
  std::unique_ptr<GroupProbe> MakeGroupProbe() const;

  // Whether any patch may change the cell of a level that a place in level 0 is in: elsewhere the
  // posts of the base are all there is.
  bool Reaches(const Eigen::Vector2d& post, int level) const;

  // Whether any patch may change posts of level 0 in a box of such places; and what the heights of
  // all patches lie between there [m]: least above greatest for none, infinite where it is not
  // known.
  bool Reaches(const Eigen::AlignedBox2d& posts) const;
  std::array<double, 2> PatchHeights(const Eigen::AlignedBox2d& posts) const;

  // The same patches over other posts of the same body, of another map; `data` as above.
  std::shared_ptr<const GroupPosts>
  WithBase(std::shared_ptr<const PostSource> posts, const Crs& crs,
           const Eigen::Affine2d& postToMap,
           std::shared_ptr<const PostSource> data = nullptr) const;
  const std::shared_ptr<const PostSource>& Base() const { return this->Base_; }
  const std::shared_ptr<const PostSource>& Data() const { return this->Data_; } // may be null

  const GroupReport& Report() const { return this->Report_; }

private:
  GroupPosts(std::shared_ptr<const PostSource> base, std::shared_ptr<const PostSource> data);
  void ReadUpTo(std::size_t count, const PostBlock& block, float* heights) const;
  void Measure(std::size_t index, PatchReport& report) const;

  std::shared_ptr<const PostSource> Base_;
  std::shared_ptr<const PostSource> Data_;
  std::string Name_;
  std::vector<std::shared_ptr<Patch>> Patches_; // those that are used
  GroupReport Report_;
};

} // namespace dspace

#endif
