#include <dspace/posts/PostsBetween.h>

#include <vector>

namespace dspace {

double OnTriangles(double a, double b, double c, double d, double u, double v) {
  if (u == 0.0 && v == 0.0) {
    return a;
  }
  if (u == v) { // the diagonal needs only its ends
    return a + u * (d - a);
  }
  if (v > u) {
    return u == 0.0 ? a + v * (c - a) : a + u * (d - c) + v * (c - a);
  }
  return v == 0.0 ? a + u * (b - a) : a + u * (b - a) + v * (d - b);
}

void ReadBetweenPosts(const PostLattice& lattice, bool poles, int full,
                      const std::function<void(const PostBlock&, float*)>& read,
                      const PostBlock& block, float* heights) {
  const int step = 1 << (full - block.level);
  PostBlock around{full, FloorDiv(block.column, step), FloorDiv(block.row, step), 0, 0};
  around.width = int(FloorDiv(block.column + block.width - 1, step) - around.column) + 2;
  around.height = int(FloorDiv(block.row + block.height - 1, step) - around.row) + 2;
  std::vector<float> posts(std::size_t(around.width) * around.height);
  read(around, posts.data());
  const std::int64_t last = lattice.RowsAt(full) - 2;
  for (int j = 0; j < block.height; ++j) {
    const std::int64_t r = FloorDiv(block.row + j, step);
    const double v = double(block.row + j - r * step) / step;
    const bool ruled = poles && (r == 0 || r == last) && v > 0.0;
    for (int i = 0; i < block.width; ++i) {
      const std::int64_t c = FloorDiv(block.column + i, step);
      const double u = double(block.column + i - c * step) / step;
      const float* p = posts.data() + (r - around.row) * around.width + (c - around.column);
      const float* q = p + around.width;
      float& height = heights[std::size_t(j) * block.width + i];
      if (!ruled) {
        height = float(OnTriangles(p[0], p[1], q[0], q[1], u, v));
        continue;
      }
      const double pole = r == 0 ? p[0] : q[0];
      const float* side = r == 0 ? q : p;
      const double along = u == 0.0 ? side[0] : side[0] + u * (double(side[1]) - side[0]);
      height = float(pole + (r == 0 ? v : 1.0 - v) * (along - pole));
    }
  }
}

} // namespace dspace
