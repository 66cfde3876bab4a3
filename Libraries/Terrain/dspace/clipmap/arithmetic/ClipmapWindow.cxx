#include <dspace/clipmap/arithmetic/ClipmapWindow.h>

#include <algorithm>
#include <cmath>
#include <string>

#include <dspace/Error.h>

namespace dspace {

int CoarsestFor(int cells) {
  return cells / 2 - 2;
}

ClipmapGeometry::ClipmapGeometry(int cells) : Cells_(cells), Texels_(1) {
  if (cells < 12 || cells > 1020 || cells % 4 != 0) {
    throw Error(Error::Kind::InvalidArgument, "clipmap",
                "level size " + std::to_string(cells) +
                    " is rejected; accepted is a multiple of 4 from 12 to 1020 cells");
  }
  while (this->Texels_ < cells + 3) {
    this->Texels_ *= 2;
  }
}

ClipmapWindow ClipmapGeometry::WindowAt(const Eigen::Vector2d& place, int level) const {
  // Rounded down, not to the nearest: then windows nest in only two ways an axis. In integers,
  // since a place on a post must be rounded the same way in every level. Shifts round down, below 0
  // too.
  const auto first = [&](double x) {
    const std::int64_t post = static_cast<std::int64_t>(std::floor(x)) >> level;
    return ((post - this->Cells_ / 2) >> 1) * 2;
  };
  return {first(place.x()), first(place.y())};
}

Eigen::Vector2i ClipmapGeometry::InnerCell(const ClipmapWindow& finer,
                                           const ClipmapWindow& coarser) const {
  return {static_cast<int>(finer.column / 2 - coarser.column),
          static_cast<int>(finer.row / 2 - coarser.row)};
}

void ClipmapGeometry::Cut(std::int64_t column, std::int64_t row, std::int64_t width,
                          std::int64_t height, std::vector<ClipmapUpdate>& updates) const {
  for (std::int64_t r = row; r < row + height;) {
    const int y = this->Texel(r);
    const auto h = static_cast<int>(std::min<std::int64_t>(this->Texels_ - y, row + height - r));
    for (std::int64_t c = column; c < column + width;) {
      const int x = this->Texel(c);
      const auto w =
          static_cast<int>(std::min<std::int64_t>(this->Texels_ - x, column + width - c));
      updates.push_back({x, y, w, h, c, r});
      c += w;
    }
    r += h;
  }
}

std::vector<ClipmapUpdate> ClipmapGeometry::Updates(const std::optional<ClipmapWindow>& from,
                                                    const ClipmapWindow& to) const {
  std::vector<ClipmapUpdate> updates;
  const std::int64_t posts = this->Cells_ + 3; // with the border
  const std::int64_t dc = from ? to.column - from->column : posts;
  const std::int64_t dr = from ? to.row - from->row : posts;
  const std::int64_t left = to.column - 1;
  const std::int64_t top = to.row - 1;
  if (std::abs(dc) >= posts || std::abs(dr) >= posts) {
    this->Cut(left, top, posts, posts, updates);
    return updates;
  }
  // Whole rows first, then the columns that are new in the rows that stay.
  if (dr != 0) {
    this->Cut(left, dr > 0 ? top + posts - dr : top, posts, std::abs(dr), updates);
  }
  if (dc != 0) {
    this->Cut(dc > 0 ? left + posts - dc : left, dr > 0 ? top : top - dr, std::abs(dc),
              posts - std::abs(dr), updates);
  }
  return updates;
}

} // namespace dspace
