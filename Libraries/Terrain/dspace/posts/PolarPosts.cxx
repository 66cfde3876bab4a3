#include <dspace/posts/PolarPosts.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include <dspace/posts/PostFacets.h>

namespace dspace {
namespace {

constexpr double Reach = 1.92; // of the square from the pole, in twice the radius: 35 degrees past
                               // the equator

// Levels and half a side in posts: as close as the base's rows, halved until the coarsest suits.
PostLattice LatticeAround(double step, int coarsest) {
  PostLattice lattice;
  // Whole cells of the coarsest level on each side: the pole is a post of every level.
  const auto cellsOf = [step](int levels) {
    return static_cast<std::int64_t>(std::ceil(std::ldexp(Reach / step, 1 - levels)));
  };
  lattice.levels = 1;
  while (2 * cellsOf(lattice.levels) > coarsest) {
    ++lattice.levels;
  }
  lattice.columns = lattice.rows =
      2 * cellsOf(lattice.levels) * (std::int64_t(1) << (lattice.levels - 1)) + 1;
  return lattice;
}

} // namespace

PolarPosts::PolarPosts(std::shared_ptr<const PostSource> base, const PostPlacement& placement,
                       int complete, bool south, int coarsest)
    : Base_(std::move(base)), Placement_(placement),
      Lattice_(LatticeAround(0.5 * std::abs(placement.Step().y()), coarsest)),
      Complete_(std::min(complete, Base_->GetLattice().levels - 1)) {
  this->Polar_ = PostPlacement::OnPole(south, placement.Radius() * std::abs(placement.Step().y()),
                                       0.5 * double(this->Lattice_.columns - 1), placement.Body());
}

void PolarPosts::Read(const PostBlock& block, float* heights) const {
  const PostLattice& base = this->Base_->GetLattice();
  const int level = std::clamp(block.level, this->Complete_, base.levels - 1);
  const double scale = std::ldexp(1.0, -level);
  const std::int64_t columns = base.ColumnsAt(level);
  const std::int64_t lastRow = base.RowsAt(level) - 1;
  const std::size_t count = std::size_t(block.width) * block.height;

  // Places of the posts in the base's level; columns unwrapped about the block's middle.
  std::vector<Eigen::Vector2d> places(count);
  Eigen::AlignedBox2d area;
  const auto placeOf = [&](std::int64_t c, std::int64_t r) {
    const Eigen::Vector2d post(double(this->Lattice_.ColumnPlace(block.level, c)),
                               double(this->Lattice_.RowPlace(block.level, r)));
    return Eigen::Vector2d(this->Placement_.PostAt(this->Polar_.Angles(post)) * scale);
  };
  const double middle = placeOf(block.column + block.width / 2, block.row + block.height / 2).x();
  for (int j = 0; j < block.height; ++j) {
    for (int i = 0; i < block.width; ++i) {
      Eigen::Vector2d& place = places[std::size_t(j) * block.width + i];
      place = placeOf(block.column + i, block.row + j);
      place.x() = middle + std::remainder(place.x() - middle, double(columns));
      place.y() = std::clamp(place.y(), 0.0, double(lastRow));
      area.extend(place);
    }
  }
  // About the pole all longitudes are needed, else those between.
  PostBlock needed;
  needed.level = level;
  needed.row = std::clamp<std::int64_t>(std::int64_t(std::floor(area.min().y())), 0, lastRow - 1);
  needed.height =
      int(std::min<std::int64_t>(std::int64_t(std::floor(area.max().y())) + 1, lastRow) -
          needed.row + 1);
  needed.column = std::int64_t(std::floor(area.min().x()));
  needed.width = int(std::int64_t(std::floor(area.max().x())) + 2 - needed.column);
  std::vector<float> posts(std::size_t(needed.width) * needed.height);
  this->Base_->Read(needed, posts.data());

  const auto at = [&](std::int64_t c, std::int64_t r) {
    return double(
        posts[std::size_t(r - needed.row) * needed.width + std::size_t(c - needed.column)]);
  };
  const std::int64_t columnsHere = this->Lattice_.ColumnsAt(block.level);
  const std::int64_t rowsHere = this->Lattice_.RowsAt(block.level);
  for (std::size_t i = 0; i < count; ++i) {
    const std::int64_t c = block.column + std::int64_t(i % std::size_t(block.width));
    const std::int64_t r = block.row + std::int64_t(i / std::size_t(block.width));
    heights[i] = std::numeric_limits<float>::quiet_NaN();
    if (c < 0 || r < 0 || c >= columnsHere || r >= rowsHere) {
      continue;
    }
    const Eigen::Vector2d& place = places[i];
    const auto cell = std::int64_t(std::floor(place.x()));
    const auto row = std::min(std::int64_t(std::floor(place.y())), lastRow - 1);
    const double u = place.x() - double(cell);
    const double v = place.y() - double(row);
    const HeightGrid::Facet facet = FacetOfCell(at, cell, row, v > u, u, v);
    if (facet.valid) {
      heights[i] = float(facet.height);
    }
  }
}

} // namespace dspace
