// Single posts of level 0 of a terrain group, and bounds of their blocks.
#ifndef DSPACE_TERRAIN_GROUPPROBE_H
#define DSPACE_TERRAIN_GROUPPROBE_H

#include <array>
#include <cstdint>
#include <memory>
#include <vector>

#include <dspace/groups/PatchProbe.h>
#include <dspace/posts/PostProbe.h>

namespace dspace {

class GroupProbe : public PostProbe {
public:
  GroupProbe(const PostLattice& lattice, std::unique_ptr<PostProbe> base,
             std::vector<PatchProbe> patches);

  bool HasRows(std::int64_t first, std::int64_t last) const override {
    return this->Base_->HasRows(first, last);
  }
  float At(std::int64_t column, std::int64_t row) override;

  // Least and greatest height [m] over a block of 2^bits cells, (c, r) of such; bits <=
  // PatchProbe::Bits. `base()` gives those of the base, asked for if they count; least above
  // greatest is none, as in the result.
  template<typename Base>
  std::array<double, 2> Over(int bits, std::int64_t c, std::int64_t r, const Base& base);

private:
  float HeightOf(std::int64_t column, std::int64_t row);
  static std::array<double, 2> Blend(const std::array<double, 2>& under,
                                     const PatchProbe::Bounds& patch);

  struct Kept {
    std::int64_t column = -1;
    std::int64_t row = -1;
    float height = 0.0f;
  };

  const PostLattice& Lattice_;
  std::unique_ptr<PostProbe> Base_;
  std::vector<PatchProbe> Patches_;
  std::vector<PatchProbe::Bounds> Bounds_;
  std::vector<PatchProbe::Share> Shares_;
  std::array<Kept, 64> Kept_; // the latest of each place in squares of 8 x 8
};

template<typename Base>
std::array<double, 2> GroupProbe::Over(int bits, std::int64_t c, std::int64_t r, const Base& base) {
  this->Bounds_.clear();
  std::size_t from = 0; // the last that hides all below
  bool hides = false;
  for (PatchProbe& patch : this->Patches_) {
    this->Bounds_.push_back(patch.Over(bits, c, r));
    if (this->Bounds_.back().weights[0] >= 1.0) {
      from = this->Bounds_.size() - 1;
      hides = true;
    }
  }
  std::array<double, 2> range = hides ? this->Bounds_[from].heights : base();
  for (std::size_t i = from + (hides ? 1 : 0); i < this->Bounds_.size(); ++i) {
    range = Blend(range, this->Bounds_[i]);
  }
  return range;
}

} // namespace dspace

#endif
