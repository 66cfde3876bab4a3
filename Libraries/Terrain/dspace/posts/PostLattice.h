// The lattice of posts that a terrain is drawn and queried on, and its coarser levels.
#ifndef DSPACE_TERRAIN_POSTLATTICE_H
#define DSPACE_TERRAIN_POSTLATTICE_H

#include <algorithm>
#include <cstdint>

namespace dspace {

// a / b rounded down; b > 0.
inline std::int64_t FloorDiv(std::int64_t a, std::int64_t b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

// Posts (c, r) of level 0, 0 <= c < columns, 0 <= r < rows. Post (k, j) of level l stands where
// post (k 2^l, j 2^l) of level 0 does, and the last one of each row and column, which need not be a
// multiple, at the lattice's edge: every level reaches exactly as far as level 0.
// A periodic lattice goes once around a body: column `columns` is column 0 again, and every level
// must divide it evenly.
struct PostLattice {
  std::int64_t columns = 0; // at least 2
  std::int64_t rows = 0;    // at least 2
  bool periodic = false;    // along c
  int levels = 1;

  // Posts along c and r at a level.
  std::int64_t ColumnsAt(int level) const {
    return this->periodic ? this->columns >> level : CountAt(this->columns, level);
  }
  std::int64_t RowsAt(int level) const { return CountAt(this->rows, level); }

  // Level-0 place of post k of a level; clamped to the lattice where it has an end.
  std::int64_t ColumnPlace(int level, std::int64_t k) const {
    return this->periodic ? k * (std::int64_t(1) << level) : Place(this->columns, level, k);
  }
  std::int64_t RowPlace(int level, std::int64_t k) const { return Place(this->rows, level, k); }

  // The column in 0..ColumnsAt(level)-1 that a column of a periodic lattice is.
  std::int64_t Wrapped(int level, std::int64_t k) const {
    const std::int64_t n = this->ColumnsAt(level);
    return this->periodic ? k - FloorDiv(k, n) * n : k;
  }

private:
  static std::int64_t CountAt(std::int64_t posts, int level) {
    const std::int64_t step = std::int64_t(1) << level;
    return (posts - 1 + step - 1) / step + 1;
  }
  static std::int64_t Place(std::int64_t posts, int level, std::int64_t k) {
    return std::clamp<std::int64_t>(k * (std::int64_t(1) << level), 0, posts - 1);
  }
};

} // namespace dspace

#endif
