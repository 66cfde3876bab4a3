// Where the posts of a block lie in a patch.
#include <dspace/groups/PatchPlace.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dspace {
namespace {

constexpr int SquareSize = 64; // posts
const Eigen::Vector2d NoPixel = Eigen::Vector2d::Constant(std::numeric_limits<double>::quiet_NaN());

} // namespace

// Posts k..k+size-1, j..j+size-1 of a level, of which those of the block are wanted.
struct PatchPlace::Square {
  int level = 0;
  std::int64_t k = 0;
  std::int64_t j = 0;
  std::int64_t size = 0;
  std::int64_t kFrom = 0, kTo = 0, jFrom = 0, jTo = 0; // wanted
  std::int64_t kToColumn = 0, jToRow = 0;              // to places in the block
};

void PatchPlace::Fill(const Square& s, double tolerance, const PostBlock& block,
                      std::vector<Eigen::Vector2d>& pixels) const {
  const std::int64_t k0 = std::max(s.k, s.kFrom);
  const std::int64_t k1 = std::min(s.k + s.size, s.kTo);
  const std::int64_t j0 = std::max(s.j, s.jFrom);
  const std::int64_t j1 = std::min(s.j + s.size, s.jTo);
  const Eigen::Vector2d widened = std::ldexp(1.0, s.level) * this->Widening_;
  const PostLattice& lattice = this->Lattice_;
  const auto reachesColumn = [&](std::int64_t k) {
    return this->Columns_.Has(this->Unwrapped(double(lattice.ColumnPlace(s.level, k))),
                              widened.x());
  };
  const auto reachesRow = [&](std::int64_t j) {
    return this->Rows_.Has(double(lattice.RowPlace(s.level, j)), widened.y());
  };
  bool any = false;
  for (std::int64_t k = k0; k < k1 && !any; ++k) {
    any = reachesColumn(k);
  }
  bool anyRow = false;
  for (std::int64_t j = j0; j < j1 && any && !anyRow; ++j) {
    anyRow = reachesRow(j);
  }
  if (!any || !anyRow) {
    return;
  }
  const auto put = [&](std::int64_t k, std::int64_t j, const Eigen::Vector2d& pixel) {
    pixels[std::size_t(j + s.jToRow) * block.width + std::size_t(k + s.kToColumn)] = pixel;
  };
  if (s.size == 1) {
    put(s.k, s.j,
        this->PixelOfPost(
            {double(lattice.ColumnPlace(s.level, s.k)), double(lattice.RowPlace(s.level, s.j))}));
    return;
  }
  const double step = std::ldexp(1.0, s.level);
  const Eigen::Vector2d first(double(s.k) * step, double(s.j) * step);
  const double side = double(s.size) * step;
  const auto exact = [&](double u, double v) {
    return this->PixelOfPost(first + Eigen::Vector2d(u, v) * side);
  };
  const Eigen::Vector2d a = exact(0, 0);
  const Eigen::Vector2d b = exact(1, 0);
  const Eigen::Vector2d c = exact(0, 1);
  const Eigen::Vector2d d = exact(1, 1);
  const auto between = [&](double u, double v) -> Eigen::Vector2d {
    return (1.0 - v) * (a + u * (b - a)) + v * (c + u * (d - c));
  };
  bool good = true;
  for (const auto& [u, v] : {std::pair(0.5, 0.5), {0.5, 0.0}, {0.5, 1.0}, {0.0, 0.5}, {1.0, 0.5}}) {
    // Written so that what is not finite fails.
    good = good && (between(u, v) - exact(u, v)).norm() <= tolerance;
  }
  if (!good) {
    Square quarter = s;
    quarter.size = s.size / 2;
    for (const int y : {0, 1}) {
      for (const int x : {0, 1}) {
        quarter.k = s.k + x * quarter.size;
        quarter.j = s.j + y * quarter.size;
        this->Fill(quarter, tolerance, block, pixels);
      }
    }
    return;
  }
  for (std::int64_t j = j0; j < j1; ++j) {
    const double v = (double(lattice.RowPlace(s.level, j)) - first.y()) / side;
    for (std::int64_t k = k0; reachesRow(j) && k < k1; ++k) {
      if (reachesColumn(k)) {
        put(k, j, between((double(lattice.ColumnPlace(s.level, k)) - first.x()) / side, v));
      }
    }
  }
}

bool PatchPlace::PixelsOf(const PostBlock& block, double tolerance,
                          std::vector<Eigen::Vector2d>& pixels) const {
  const PostLattice& lattice = this->Lattice_;
  const std::int64_t columns = lattice.ColumnsAt(block.level);
  const std::int64_t rows = lattice.RowsAt(block.level);
  const Eigen::Vector2d widened = std::ldexp(1.0, block.level) * this->Widening_;
  bool reached = false;
  for (int i = 0; i < block.width && !reached; ++i) {
    const std::int64_t k = lattice.Wrapped(block.level, block.column + i);
    reached = this->Columns_.Has(this->Unwrapped(double(lattice.ColumnPlace(block.level, k))),
                                 widened.x());
  }
  const auto rowPlace = [&](std::int64_t j) { return double(lattice.RowPlace(block.level, j)); };
  if (!this->Inside_ || !reached ||
      (rowPlace(block.row) > this->Rows_.to + widened.y() ||
       rowPlace(block.row + block.height - 1) < this->Rows_.from - widened.y())) {
    return false;
  }
  pixels.assign(std::size_t(block.width) * block.height, NoPixel);
  Square square;
  square.level = block.level;
  square.size = SquareSize;
  for (int i = 0; i < block.width;) { // runs of columns within one square
    const std::int64_t k = lattice.Wrapped(block.level, block.column + i);
    square.k = FloorDiv(k, SquareSize) * SquareSize;
    std::int64_t run = std::min<std::int64_t>(square.k + SquareSize - k, block.width - i);
    if (lattice.periodic) {
      run = std::min(run, columns - k);
    }
    square.kFrom = std::max<std::int64_t>(k, 0);
    square.kTo = std::min(k + run, columns);
    square.kToColumn = i - k;
    const std::int64_t last = std::min(block.row + block.height, rows);
    square.jToRow = -block.row;
    for (std::int64_t j = std::max<std::int64_t>(block.row, 0); j < last;) {
      square.j = FloorDiv(j, SquareSize) * SquareSize;
      square.jFrom = j;
      square.jTo = std::min(square.j + SquareSize, last);
      this->Fill(square, tolerance, block, pixels);
      j = square.jTo;
    }
    i += int(run);
  }
  for (const std::int64_t j : {std::int64_t(0), rows - 1}) { // one place, one height
    if (this->Poles_ && j >= block.row && j < block.row + block.height) {
      std::fill_n(pixels.begin() + std::ptrdiff_t(j - block.row) * block.width, block.width,
                  this->Columns_.all ? this->PixelOfPost({0.0, rowPlace(j)}) : NoPixel);
    }
  }
  return true;
}

Eigen::AlignedBox2d PatchPlace::PixelBox(const Eigen::AlignedBox2d& posts) const {
  constexpr int Parts = 4;
  const Eigen::Vector2d endless =
      Eigen::Vector2d::Constant(std::numeric_limits<double>::infinity());
  std::array<Eigen::Vector2d, (Parts + 1) * (Parts + 1)> places;
  const auto at = [&places](int i, int j) -> Eigen::Vector2d& {
    return places[std::size_t(j) * (Parts + 1) + i];
  };
  Eigen::AlignedBox2d box;
  for (int j = 0; j <= Parts; ++j) {
    for (int i = 0; i <= Parts; ++i) {
      const Eigen::Vector2d share(double(i) / Parts, double(j) / Parts);
      at(i, j) = this->PixelOfPost(posts.min() + share.cwiseProduct(posts.sizes()));
      if (!at(i, j).allFinite()) {
        return {-endless, endless};
      }
      box.extend(at(i, j));
    }
  }
  // Between places a distance h apart straight lines are off by at most h^2 / 8 of the second
  // derivatives, of which the second differences are h^2: taken eightfold they are safe.
  double bend = 0.0;
  for (int j = 0; j <= Parts; ++j) {
    for (int i = 1; i < Parts; ++i) {
      bend = std::max(bend, (at(i - 1, j) - 2.0 * at(i, j) + at(i + 1, j)).norm());
      bend = std::max(bend, (at(j, i - 1) - 2.0 * at(j, i) + at(j, i + 1)).norm());
    }
  }
  if (bend > 0.25 * box.sizes().norm() + 1.0) {
    return {-endless, endless};
  }
  const Eigen::Vector2d more = Eigen::Vector2d::Constant(bend);
  return {box.min() - more, box.max() + more};
}

} // namespace dspace
