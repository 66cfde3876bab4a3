#include <dspace/groups/GroupPosts.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/groups/GroupProbe.h>
#include <dspace/groups/Patch.h>
#include <dspace/posts/PostFacets.h>
#include <dspace/raster/RandomPixels.h>

namespace dspace {
namespace {

constexpr int MaximumSubdivisions = 24;

} // namespace

OpenPatches::OpenPatches(const ElevationInfo& base, const std::vector<TerrainPatch>& patches) {
  for (const TerrainPatch& options : patches) {
    const auto patch = std::make_shared<Patch>(base, options, this->Warnings_);
    const double ratio = std::max(1.0, patch->Place().BasePixel());
    const int needed = int(std::ceil(std::log2(ratio) - 1e-6));
    if (needed > MaximumSubdivisions) {
      this->Warnings_.push_back(patch->Object() + ": its pixels are " + std::to_string(ratio) +
                                " times finer than those of the raster below; posts stand only 2^" +
                                std::to_string(MaximumSubdivisions) + " times closer");
    }
    this->Subdivisions_ = std::max(this->Subdivisions_, std::min(needed, MaximumSubdivisions));
    this->Patches_.push_back(patch);
  }
}

OpenPatches::OpenPatches(OpenPatches&&) noexcept = default;
OpenPatches::~OpenPatches() = default;

GroupPosts::GroupPosts(std::shared_ptr<const PostSource> base, const Eigen::Affine2d& postToMap,
                       bool poles, OpenPatches patches, std::shared_ptr<const PostSource> data)
    : Base_(std::move(base)), Data_(std::move(data)), Name_(Base_->GetName()) {
  this->Report_.warnings = patches.Warnings_;
  for (const std::shared_ptr<Patch>& opened : patches.Patches_) {
    if (opened->Attach(this->GetLattice(), postToMap, poles, this->Report_.warnings)) {
      this->Patches_.push_back(opened);
      this->Measure(this->Patches_.size() - 1, opened->Report());
    }
    this->Report_.patches.push_back(opened->Report());
  }
}

GroupPosts::GroupPosts(std::shared_ptr<const PostSource> base,
                       std::shared_ptr<const PostSource> data)
    : Base_(std::move(base)), Data_(std::move(data)), Name_(Base_->GetName()) {}

GroupPosts::~GroupPosts() = default;

std::shared_ptr<const GroupPosts>
GroupPosts::WithBase(std::shared_ptr<const PostSource> posts, const Crs& crs,
                     const Eigen::Affine2d& postToMap,
                     std::shared_ptr<const PostSource> data) const {
  const std::shared_ptr<GroupPosts> group(new GroupPosts(std::move(posts), std::move(data)));
  ElevationInfo info;
  info.crs = crs;
  info.pixelToMap = postToMap; // for sizes
  for (const std::shared_ptr<Patch>& patch : this->Patches_) {
    const auto again = std::make_shared<Patch>(*patch, info);
    if (again->Reattach(group->GetLattice(), postToMap)) {
      group->Patches_.push_back(again);
    }
  }
  group->Report_ = this->Report_;
  return group;
}

void GroupPosts::ReadUpTo(std::size_t count, const PostBlock& block, float* heights) const {
  this->Base_->Read(block, heights);
  std::vector<char> made;
  Patch::FilledMask filledMask;
  if (this->Data_) {
    filledMask = [&]() -> std::vector<char>& {
      if (made.empty()) {
        std::vector<float> data(std::size_t(block.width) * block.height);
        this->Data_->Read(block, data.data());
        made.resize(data.size());
        std::transform(data.begin(), data.end(), made.begin(),
                       [](float height) { return char(std::isnan(height)); });
      }
      return made;
    };
  }
  for (std::size_t i = 0; i < count; ++i) {
    this->Patches_[i]->Blend(block, heights, filledMask);
  }
}

void GroupPosts::Read(const PostBlock& block, float* heights) const {
  this->ReadUpTo(this->Patches_.size(), block, heights);
}

std::unique_ptr<GroupProbe> GroupPosts::MakeGroupProbe() const {
  std::unique_ptr<PostProbe> base = this->Data_ ? nullptr : this->Base_->MakeProbe();
  if (!base) {
    return nullptr;
  }
  std::vector<PatchProbe> patches;
  for (const std::shared_ptr<Patch>& patch : this->Patches_) {
    if (!PatchProbe::Reads(*patch)) {
      return nullptr;
    }
    patches.emplace_back(*patch);
  }
  return std::make_unique<GroupProbe>(this->GetLattice(), std::move(base), std::move(patches));
}

std::unique_ptr<PostProbe> GroupPosts::MakeProbe() const {
  return this->MakeGroupProbe();
}

bool GroupPosts::Reaches(const Eigen::Vector2d& post, int level) const {
  // Weights reach two sides beyond a patch, and a cell's posts are one side away.
  return std::any_of(this->Patches_.begin(), this->Patches_.end(),
                     [&](const auto& patch) { return patch->Place().Reaches(post, level, 4.0); });
}

bool GroupPosts::Reaches(const Eigen::AlignedBox2d& posts) const {
  return std::any_of(this->Patches_.begin(), this->Patches_.end(),
                     [&](const auto& patch) { return patch->Place().Touches(posts); });
}

std::array<double, 2> GroupPosts::PatchHeights(const Eigen::AlignedBox2d& posts) const {
  constexpr double Infinity = std::numeric_limits<double>::infinity();
  std::array<double, 2> all = {Infinity, -Infinity};
  for (const std::shared_ptr<Patch>& patch : this->Patches_) {
    const std::array<double, 2> heights = patch->HeightsIn(posts);
    all = {std::min(all[0], heights[0]), std::max(all[1], heights[1])};
  }
  return all;
}

// At posts of the patch near a number of places, so that few of its tiles are read.
void GroupPosts::Measure(std::size_t index, PatchReport& report) const {
  const Patch& patch = *this->Patches_[index];
  double squares = 0.0;
  AtRandomPixels(patch.Source(), [&](int c, int r, double own) {
    const double height = own + report.addedTo;
    const Eigen::Vector2d pixel(c + 0.5, r + 0.5);
    const Eigen::Vector2d post = patch.Place().PostOf(pixel);
    if (std::isnan(height) || !post.allFinite() || patch.Weight().At(pixel, 0) < 1.0 - 1e-6) {
      return;
    }
    const Eigen::Vector2d cell = post.array().floor();
    const PostBlock block{0, std::int64_t(cell.x()), std::int64_t(cell.y()), 2, 2};
    std::array<float, 4> posts = {};
    this->ReadUpTo(index + 1, block, posts.data());
    const auto at = [&](std::int64_t k, std::int64_t j) -> double {
      return posts[std::size_t(2 * (j - block.row) + k - block.column)];
    };
    const Eigen::Vector2d place = post - cell;
    const HeightGrid::Facet facet =
        FacetOfCell(at, block.column, block.row, place.y() > place.x(), place.x(), place.y());
    if (facet.valid) {
      const double error = facet.height - height;
      squares += error * error;
      report.greatestError = std::max(report.greatestError, std::abs(error));
      ++report.posts;
    }
  });
  report.rmsError = report.posts > 0 ? std::sqrt(squares / report.posts) : 0.0;
}

} // namespace dspace
