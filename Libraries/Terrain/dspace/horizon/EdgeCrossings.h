// Where a line over the posts crosses the edges of their triangles.
#ifndef DSPACE_TERRAIN_EDGECROSSINGS_H
#define DSPACE_TERRAIN_EDGECROSSINGS_H

#include <cmath>
#include <cstdint>

namespace dspace {

// std::floor for what a std::int64_t holds, without a call.
inline std::int64_t FloorOf(double value) {
  const auto whole = std::int64_t(value);
  return whole - (value < double(whole));
}

// Calls visit(t, c, r, right, down, share) for each edge that the straight line from (ax, ay) to
// (bx, by) crosses, in posts, after its first and up to its last place: at `t` of its length,
// between the posts (c, r) and (c + right, r + down), at `share` of the edge from the first one.
// Columns first, then rows, then diagonals.
template<typename Visit>
void ForEachCrossing(double ax, double ay, double bx, double by, const Visit& visit) {
  const double dx = bx - ax;
  const double dy = by - ay;
  // Whole numbers in (from, to], or [to, from) downwards.
  const auto whole = [](double from, double to, const auto& take) {
    if (to > from) {
      for (double v = std::floor(from) + 1.0; v <= to; ++v) {
        take(v);
      }
    } else if (to < from) {
      for (double v = std::ceil(from) - 1.0; v >= to; --v) {
        take(v);
      }
    }
  };
  whole(ax, bx, [&](double x) {
    const double t = (x - ax) / dx;
    const double y = ay + t * dy;
    const std::int64_t r = FloorOf(y);
    visit(t, std::int64_t(x), r, 0, 1, y - double(r));
  });
  whole(ay, by, [&](double y) {
    const double t = (y - ay) / dy;
    const double x = ax + t * dx;
    const std::int64_t c = FloorOf(x);
    visit(t, c, std::int64_t(y), 1, 0, x - double(c));
  });
  whole(ax - ay, bx - by, [&](double d) {
    const double t = (d - (ax - ay)) / (dx - dy);
    const double x = ax + t * dx;
    const std::int64_t c = FloorOf(x);
    visit(t, c, c - std::int64_t(d), 1, 1, x - double(c));
  });
}

} // namespace dspace

#endif
