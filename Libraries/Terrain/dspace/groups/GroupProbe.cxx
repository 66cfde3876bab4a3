#include <dspace/groups/GroupProbe.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <dspace/groups/Patch.h>

namespace dspace {

GroupProbe::GroupProbe(const PostLattice& lattice, std::unique_ptr<PostProbe> base,
                       std::vector<PatchProbe> patches)
    : Lattice_(lattice), Base_(std::move(base)), Patches_(std::move(patches)) {}

float GroupProbe::At(std::int64_t column, std::int64_t row) {
  column = this->Lattice_.Wrapped(0, column);
  Kept& kept = this->Kept_[std::size_t((column & 7) + 8 * (row & 7))];
  if (kept.column == column && kept.row == row) {
    return kept.height;
  }
  const bool inside =
      row >= 0 && row < this->Lattice_.rows && column >= 0 && column < this->Lattice_.columns;
  kept = {column, row, inside ? this->HeightOf(column, row) : this->Base_->At(column, row)};
  return kept.height;
}

// From the top: what lies under a patch that is shown alone does not count.
float GroupProbe::HeightOf(std::int64_t column, std::int64_t row) {
  this->Shares_.clear();
  bool alone = false;
  for (auto patch = this->Patches_.rbegin(); patch != this->Patches_.rend() && !alone; ++patch) {
    this->Shares_.push_back(patch->At(column, row));
    alone = this->Shares_.back().weight >= Patch::Whole;
  }
  float height = alone ? 0.0f : this->Base_->At(column, row);
  for (auto share = this->Shares_.rbegin(); share != this->Shares_.rend(); ++share) {
    if (share->weight > 0.0) {
      const double under = height;
      height = float(share->weight >= Patch::Whole || std::isnan(under)
                         ? share->height
                         : under + share->weight * (share->height - under));
    }
  }
  return height;
}

// A blend is linear in each of its three; where there is nothing below, the patch is alone.
std::array<double, 2> GroupProbe::Blend(const std::array<double, 2>& under,
                                        const PatchProbe::Bounds& patch) {
  if (!(patch.weights[1] > 0.0) || patch.heights[0] > patch.heights[1]) {
    return under;
  }
  return {std::min(under[0], patch.heights[0]), std::max(under[1], patch.heights[1])};
}

} // namespace dspace
