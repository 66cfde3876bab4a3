// The triangles between posts, wherever the posts are kept.
#ifndef DSPACE_TERRAIN_POSTFACETS_H
#define DSPACE_TERRAIN_POSTFACETS_H

#include <algorithm>
#include <cmath>
#include <cstdint>

#include <dspace/posts/HeightGrid.h>

namespace dspace {

constexpr double BorderTolerance = 1e-9; // cells; what conversions to post coordinates round off

// Triangle A (`below` the diagonal) or B of cell (c, r), and its height at (u, v) of the cell; see
// HeightGrid. `at(c, r)` is a post's height, NaN for none.
template<typename At>
HeightGrid::Facet FacetOfCell(const At& at, std::int64_t c, std::int64_t r, bool below, double u,
                              double v) {
  HeightGrid::Facet facet;
  const double nw = at(c, r);
  const double se = at(c + 1, r + 1);
  const double third = below ? at(c, r + 1) : at(c + 1, r);
  facet.valid = !(std::isnan(nw) || std::isnan(se) || std::isnan(third));
  if (!facet.valid) {
    return facet;
  }
  facet.dc = below ? se - third : third - nw;
  facet.dr = below ? third - nw : se - third;
  facet.height = nw + u * facet.dc + v * facet.dr;
  return facet;
}

// The cells that there are, each last one included.
struct CellRange {
  std::int64_t firstColumn = 0;
  std::int64_t lastColumn = 0;
  std::int64_t firstRow = 0;
  std::int64_t lastRow = 0;
};

// The triangle at a place; on an edge or post, one of those there that exist. `cell(c, r, below, u,
// v)` is one of them.
template<typename Cell>
HeightGrid::Facet FacetNear(const CellRange& cells, const Eigen::Vector2d& g, const Cell& cell) {
  const auto firstC = double(cells.firstColumn);
  const auto lastC = double(cells.lastColumn + 1);
  const auto firstR = double(cells.firstRow);
  const auto lastR = double(cells.lastRow + 1);
  // Written so that NaN is outside.
  if (!(g.x() >= firstC - BorderTolerance && g.x() <= lastC + BorderTolerance &&
        g.y() >= firstR - BorderTolerance && g.y() <= lastR + BorderTolerance)) {
    return {};
  }
  const double x = std::clamp(g.x(), firstC, lastC);
  const double y = std::clamp(g.y(), firstR, lastR);
  const std::int64_t c = std::min(static_cast<std::int64_t>(std::floor(x)), cells.lastColumn);
  const std::int64_t r = std::min(static_cast<std::int64_t>(std::floor(y)), cells.lastRow);
  const double u = x - double(c);
  const double v = y - double(r);
  const HeightGrid::Facet facet = cell(c, r, v > u, u, v);
  if (facet.valid) {
    return facet;
  }
  // On the rim of a hole the triangle across the edge, or another around the post, may exist.
  const auto on = [](double a) { return std::abs(a) <= BorderTolerance; };
  for (int dc = on(u) && c > cells.firstColumn ? -1 : 0;
       dc <= (on(u - 1.0) && c < cells.lastColumn ? 1 : 0); ++dc) {
    for (int dr = on(v) && r > cells.firstRow ? -1 : 0;
         dr <= (on(v - 1.0) && r < cells.lastRow ? 1 : 0); ++dr) {
      for (const bool below : {true, false}) {
        const double uu = u - dc;
        const double vv = v - dr;
        if (below ? vv < uu - BorderTolerance : vv > uu + BorderTolerance) {
          continue;
        }
        const HeightGrid::Facet other = cell(c + dc, r + dr, below, uu, vv);
        if (other.valid) {
          return other;
        }
      }
    }
  }
  return {};
}

} // namespace dspace

#endif
