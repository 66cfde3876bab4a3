// The posts that a piece of a sweep looks over.
#ifndef DSPACE_TERRAIN_SWEPTPOSTS_H
#define DSPACE_TERRAIN_SWEPTPOSTS_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include <dspace/horizon/HeldPosts.h>
#include <dspace/horizon/HorizonKernel.h>

namespace dspace {

// Posts that were read, with a row and a column to spare for every lane, or those that are held.
struct SweptPosts {
  PostBlock place;
  std::vector<float> heights;
  const HeldPosts* held = nullptr;
  HeightSpan span = {std::numeric_limits<float>::infinity(),
                     -std::numeric_limits<float>::infinity()};
  int every = 1; // columns between lanes; those of the same remainder lie side by side

  const float* Heights() const { return this->held ? this->held->Heights() : this->heights.data(); }
  std::ptrdiff_t At(std::int64_t c, std::int64_t r) const {
    if (this->held) {
      return this->held->At(c, r);
    }
    const auto row = std::ptrdiff_t(r - this->place.row) * this->place.width;
    const auto column = std::ptrdiff_t(c - this->place.column);
    return row + (this->every == 1 ? column
                                   : column % this->every * (this->place.width / this->every) +
                                         column / this->every);
  }
  // `width` must be a multiple of `every`.
  void Part() {
    std::vector<float> row(std::size_t(this->place.width));
    for (int r = 0; r < this->place.height; ++r) {
      float* heights = &this->heights[std::size_t(r) * this->place.width];
      std::copy_n(heights, row.size(), row.begin());
      const int share = this->place.width / this->every;
      for (int c = 0; c < this->place.width; ++c) {
        heights[c % this->every * share + c / this->every] = row[std::size_t(c)];
      }
    }
  }
  // Whether it has (c, r) to (c + 1 + lanes, r + 1).
  bool Has(std::int64_t c, std::int64_t r, int lanes) const {
    const int spare = this->held ? HeldPosts::RowsToSpare : 0;
    return r >= this->place.row + spare && r + 1 < this->place.row + this->place.height - spare &&
           c >= this->place.column && c + 1 + lanes < this->place.column + this->place.width;
  }
};

} // namespace dspace

#endif
