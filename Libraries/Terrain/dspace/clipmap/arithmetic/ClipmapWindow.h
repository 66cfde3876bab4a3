// Index arithmetic of a geometry clipmap: which posts each level shows, and where its texture
// holds them (Losasso and Hoppe 2004; Asirvatham and Hoppe 2005).
#ifndef DSPACE_TERRAIN_CLIPMAPWINDOW_H
#define DSPACE_TERRAIN_CLIPMAPWINDOW_H

#include <cstdint>
#include <optional>
#include <vector>

#include <Eigen/Core>

namespace dspace {

// A square of posts of one level: columns column..column+cells, rows row..row+cells, and one post
// of border all around for slopes. `column` and `row` are even, so that a window's outline lies on
// posts of the next coarser level.
struct ClipmapWindow {
  std::int64_t column = 0;
  std::int64_t row = 0;
  bool operator==(const ClipmapWindow& o) const {
    return this->column == o.column && this->row == o.row;
  }
  bool operator!=(const ClipmapWindow& o) const { return !(*this == o); }
};

// Posts that go to one rectangle of a level's texture.
struct ClipmapUpdate {
  int x = 0; // texel
  int y = 0;
  int width = 0; // texels
  int height = 0;
  std::int64_t column = 0; // post at (x, y)
  std::int64_t row = 0;
};

// Cells a side of every level's window and texels a side of its texture. A post (c, r) stands at
// texel (c mod texels, r mod texels) wherever the window is: moving it uploads only what is new.
class ClipmapGeometry {
public:
  // Throws Error(InvalidArgument) unless `cells` is a multiple of 4 from 12 to 1020.
  explicit ClipmapGeometry(int cells);

  int Cells() const { return this->Cells_; }
  int Texels() const { return this->Texels_; } // the power of two that holds cells + 3 posts

  // The window of a level about a place given in posts of level 0, below 2^62 in size. Windows
  // about one place nest: that of level l lies within that of level l + 1, at least cells / 4 - 1
  // cells from its outline.
  ClipmapWindow WindowAt(const Eigen::Vector2d& place, int level) const;

  // First cell, in the window of level l + 1 about the same place, that that of level l covers:
  // cells / 4 or one more, along c and r. It covers cells / 2 cells from there.
  Eigen::Vector2i InnerCell(const ClipmapWindow& finer, const ClipmapWindow& coarser) const;

  // Distance from the place, in posts, at which a level begins to turn into the next coarser one
  // and at which it has done so: before its outline by more than two cells wherever it is snapped.
  double BlendFrom() const {
    const int blended = this->Cells_ / 8; // whole cells
    return this->BlendTo() - blended;
  }
  double BlendTo() const {
    const int half = this->Cells_ / 2;
    return half - 5;
  }

  int Texel(std::int64_t post) const {
    return static_cast<int>(post & (this->Texels_ - 1)); // two's complement: also below 0
  }

  // The posts to upload, border included, when the window `from` (none: nothing is there yet)
  // becomes `to`: the L-shaped news, cut where the texture wraps.
  std::vector<ClipmapUpdate> Updates(const std::optional<ClipmapWindow>& from,
                                     const ClipmapWindow& to) const;

  // Posts of a rectangle, cut where the texture wraps.
  void Cut(std::int64_t column, std::int64_t row, std::int64_t width, std::int64_t height,
           std::vector<ClipmapUpdate>& updates) const;

private:
  int Cells_;
  int Texels_;
};

// The most cells a side that the coarsest level may have in a clipmap of `cells` cells a side: one
// window then shows all of the level from any place in it.
int CoarsestFor(int cells);

} // namespace dspace

#endif
