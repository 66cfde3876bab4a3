// All posts of level 0 in memory, laid out for sweeps of every n-th post.
#ifndef DSPACE_TERRAIN_HELDPOSTS_H
#define DSPACE_TERRAIN_HELDPOSTS_H

#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <vector>

#include <dspace/horizon/HorizonKernel.h>
#include <dspace/pyramid/ElevationPyramid.h>

namespace dspace {

// Columns of the same remainder by `every` lie side by side. A periodic lattice is held from half a
// turn before its first column to half a turn after its last one. NaN: no data, or outside.
class HeldPosts {
public:
  // Places that this many rows or more outside the lattice are in no line of sight; as many more
  // are held above and below, for rows that are swept together with others' steps.
  static constexpr int RowsToSpare = HorizonRows + 4;

  // The number of heights that it would hold.
  static std::int64_t CountOf(const PostLattice& lattice);
  // `reach`: columns that are kept to spare to the left and right, as far as lanes reach. `proceed`
  // is called now and then; false gives null. Throws what ElevationPyramid::Read throws.
  static std::shared_ptr<const HeldPosts> Read(ElevationPyramid& pyramid, int every, int reach,
                                               const std::function<bool()>& proceed);

  const PostBlock& Place() const { return this->Place_; }
  int Every() const { return this->Every_; }
  const float* Heights() const { return this->Heights_.data(); }
  std::ptrdiff_t At(std::int64_t c, std::int64_t r) const {
    const auto column = std::ptrdiff_t(c - this->Place_.column);
    const std::ptrdiff_t row = std::ptrdiff_t(r - this->Place_.row) * this->Place_.width;
    return row + (this->Every_ == 1 ? column // divisions cost more than all else
                                    : column % this->Every_ * this->Share_ + column / this->Every_);
  }
  // Bounds of the heights of a block, or of a somewhat larger one; in constant time.
  HeightSpan SpanOf(const PostBlock& block) const;
  float GreatestOf(const PostBlock& block) const; // -infinity: no posts

private:
  // Bounds of squares of posts, whose side doubles from one level to the next.
  struct SpanLevel {
    int columns = 0;
    int rows = 0;
    std::vector<HeightSpan> spans;
  };
  static constexpr int SpanShift = 3;
  static constexpr int SpanSide = 1 << SpanShift; // posts, of the finest level
  // The squares that cover a block.
  template<typename Take> void ForEachSquare(const PostBlock& block, const Take& take) const;
  void AddSpanLevels();

  PostBlock Place_;
  int Every_ = 1;
  std::ptrdiff_t Share_ = 0; // columns of a remainder
  std::vector<float> Heights_;
  std::vector<SpanLevel> Spans_;
};

} // namespace dspace

#endif
