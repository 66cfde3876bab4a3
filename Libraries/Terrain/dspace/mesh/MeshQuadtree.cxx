#include <dspace/mesh/MeshQuadtree.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/RowThreads.h>

namespace dspace {

MeshQuadtree::MeshQuadtree(const HeightGrid& grid, int top)
    : Grid_(grid), Top_(top), Levels_(static_cast<std::size_t>(top) + 1) {
  for (int level = 0; level <= top; ++level)
    this->BuildLevel(level);
}

void MeshQuadtree::BuildLevel(int k) {
  const int cells = 1 << k;
  Level& level = this->Levels_[k];
  level.columns = (this->Grid_.GetColumns() - 1 + cells - 1) / cells;
  level.rows = (this->Grid_.GetRows() - 1 + cells - 1) / cells;
  const std::size_t count = static_cast<std::size_t>(level.columns) * level.rows;
  level.state.assign(count, Empty);
  if (k == 0) {
    for (int r = 0; r < level.rows; ++r)
      for (int c = 0; c < level.columns; ++c) {
        const int triangles = this->Grid_.HasA(c, r) + this->Grid_.HasB(c, r);
        level.state[level.Index(c, r)] = triangles == 2 ? Full : triangles == 1 ? Mixed : Empty;
        this->FinestTriangles_ += static_cast<std::size_t>(triangles);
      }
    return;
  }
  level.split.assign(count, 0);
  level.zone.assign(count, 0);
  level.pinned.assign(count, 0);
  level.error.assign(count, 0.0f);
  ForRows(level.rows, level.columns << k, // each looks at all posts
          [&](int first, int last) { this->BuildRows(k, first, last); });
  for (const float error : level.error)
    this->GreatestError_ = std::max(this->GreatestError_, static_cast<double>(error));
}

void MeshQuadtree::BuildRows(int k, int first, int last) {
  const int cells = 1 << k;
  Level& level = this->Levels_[k];
  const Level& finer = this->Levels_[k - 1];
  for (int r = first; r < last; ++r)
    for (int c = 0; c < level.columns; ++c) {
      int full = 0, empty = 0;
      float error = 0.0f;
      for (int i = 0; i < 4; ++i) {
        const int cc = 2 * c + (i & 1), rr = 2 * r + (i >> 1);
        const bool inside = finer.Inside(cc, rr);
        const std::uint8_t state =
            inside ? finer.state[finer.Index(cc, rr)] : static_cast<std::uint8_t>(Empty);
        full += state == Full;
        empty += state == Empty;
        if (inside && k > 1)
          error = std::max(error, finer.error[finer.Index(cc, rr)]);
      }
      const std::size_t i = level.Index(c, r);
      level.state[i] = full == 4 ? Full : empty == 4 ? Empty : Mixed;
      if (level.state[i] == Full) {
        // Rounded up: a tolerance never lets pass what exceeds it.
        const float own = static_cast<float>(this->LeafError({k, c * cells, r * cells, 0}));
        error = std::max(error, std::nextafter(own, std::numeric_limits<float>::infinity()));
      }
      level.error[i] = error;
    }
}

void MeshQuadtree::ClearZone() {
  for (Level& level : this->Levels_)
    std::fill(level.zone.begin(), level.zone.end(), std::uint8_t{0});
}

void MeshQuadtree::MarkZone(double c0, double r0, double c1, double r1,
                            const std::function<bool(int c, int r)>& touches) {
  const Level& finest = this->Levels_[1];
  if (!(c1 >= 0.0 && r1 >= 0.0 && c0 < 2.0 * finest.columns && r0 < 2.0 * finest.rows))
    return;
  const auto square = [](double cell, int count) {
    return static_cast<int>(std::clamp(std::floor(0.5 * cell), 0.0, count - 1.0));
  };
  const int lastC = square(c1, finest.columns), lastR = square(r1, finest.rows);
  for (int r = square(r0, finest.rows); r <= lastR; ++r)
    for (int c = square(c0, finest.columns); c <= lastC; ++c) {
      if (finest.zone[finest.Index(c, r)] || !touches(2 * c, 2 * r))
        continue;
      for (int k = 1; k <= this->Top_; ++k) {
        Level& level = this->Levels_[k];
        level.zone[level.Index(c >> (k - 1), r >> (k - 1))] = 1;
      }
    }
}

void MeshQuadtree::ClearPins() {
  for (Level& level : this->Levels_)
    std::fill(level.pinned.begin(), level.pinned.end(), std::uint8_t{0});
}

void MeshQuadtree::Pin(int c, int r) {
  for (const int cc : {c - 1, c})
    for (const int rr : {r - 1, r})
      for (int k = 1; k <= this->Top_; ++k) {
        Level& level = this->Levels_[k];
        if (!level.Inside(cc >> k, rr >> k))
          break;
        std::uint8_t& pinned = level.pinned[level.Index(cc >> k, rr >> k)];
        if (pinned)
          break; // as are those around it
        pinned = 1;
      }
}

void MeshQuadtree::Refine(double tolerance, bool pins) {
  for (Level& level : this->Levels_)
    std::fill(level.split.begin(), level.split.end(), std::uint8_t{0});
  for (int r = 0; r < this->GetRootRows(); ++r)
    for (int c = 0; c < this->GetRootColumns(); ++c)
      this->RefineNode(this->Top_, c, r, tolerance, pins);
}

void MeshQuadtree::RefineNode(int k, int c, int r, double tolerance, bool pins) {
  Level& level = this->Levels_[k];
  if (k == 0 || !level.Inside(c, r))
    return;
  const std::size_t i = level.Index(c, r);
  if (level.state[i] == Empty)
    return;
  // Errors are nested (a square's holds for all within it), so that what is not split here need
  // not be looked into.
  if (level.state[i] == Full && level.error[i] <= tolerance && !level.zone[i] &&
      !(pins && level.pinned[i]))
    return;
  this->Split(k, c, r);
  for (int q = 0; q < 4; ++q)
    this->RefineNode(k - 1, 2 * c + (q & 1), 2 * r + (q >> 1), tolerance, pins);
}

// Splits a square, and whatever must be split so that its neighbours are at most one level coarser
// than its quarters.
void MeshQuadtree::Split(int k, int c, int r) {
  Level& level = this->Levels_[k];
  std::uint8_t& split = level.split[level.Index(c, r)];
  if (split)
    return;
  this->Require(k, c, r);
  split = 1;
  this->Require(k, c - 1, r);
  this->Require(k, c + 1, r);
  this->Require(k, c, r - 1);
  this->Require(k, c, r + 1);
}

// Makes the square exist, as a leaf or split: its parent must be split.
void MeshQuadtree::Require(int k, int c, int r) {
  const Level& level = this->Levels_[k];
  if (k < this->Top_ && level.Inside(c, r) && level.state[level.Index(c, r)] != Empty)
    this->Split(k + 1, c / 2, r / 2);
}

unsigned MeshQuadtree::FanOf(int k, int c, int r) const {
  if (k == 0)
    return 0;
  const Level& level = this->Levels_[k];
  const auto finer = [&](int cc, int rr) {
    return level.Inside(cc, rr) && level.split[level.Index(cc, rr)] != 0;
  };
  return (finer(c - 1, r) ? 1u : 0u) | (finer(c, r + 1) ? 2u : 0u) | (finer(c + 1, r) ? 4u : 0u) |
         (finer(c, r - 1) ? 8u : 0u);
}

template<typename Visitor>
void MeshQuadtree::VisitLeaves(int k, int c, int r, Visitor&& visit) const {
  const Level& level = this->Levels_[k];
  if (!level.Inside(c, r))
    return;
  const std::size_t i = level.Index(c, r);
  if (level.state[i] == Empty)
    return;
  if (k == 0 || !level.split[i]) {
    visit(Leaf{k, c << k, r << k, this->FanOf(k, c, r)});
    return;
  }
  for (int q = 0; q < 4; ++q)
    this->VisitLeaves(k - 1, 2 * c + (q & 1), 2 * r + (q >> 1), visit);
}

std::size_t MeshQuadtree::CountTriangles() const {
  std::size_t count = 0;
  const auto add = [&](const Leaf& leaf) {
    if (leaf.level == 0)
      count += this->Levels_[0].state[this->Levels_[0].Index(leaf.c, leaf.r)] == Full ? 2 : 1;
    else
      count += leaf.fan ? 4 + ((leaf.fan & 1) + (leaf.fan >> 1 & 1) + (leaf.fan >> 2 & 1) +
                               (leaf.fan >> 3 & 1))
                        : 2;
  };
  for (int r = 0; r < this->GetRootRows(); ++r)
    for (int c = 0; c < this->GetRootColumns(); ++c)
      this->VisitLeaves(this->Top_, c, r, add);
  return count;
}

std::vector<MeshQuadtree::Leaf> MeshQuadtree::Leaves(int rootColumn, int rootRow) const {
  std::vector<Leaf> leaves;
  this->VisitLeaves(this->Top_, rootColumn, rootRow,
                    [&](const Leaf& leaf) { leaves.push_back(leaf); });
  return leaves;
}

double MeshQuadtree::LeafError(const Leaf& leaf) const {
  if (leaf.level == 0)
    return 0.0;
  const HeightGrid& g = this->Grid_;
  const int n = 1 << leaf.level, h = n / 2;
  const auto at = [&](int i, int j) { return g.At(leaf.c + i, leaf.r + j); };
  const double nw = at(0, 0), ne = at(n, 0), sw = at(0, n), se = at(n, n);
  double worst = 0.0;
  if (!leaf.fan) {
    // Its diagonal runs along the grid's: edges cross at posts only.
    const double* heights = g.GetHeights().data();
    const double share = 1.0 / n; // exact
    for (int j = 0; j <= n; ++j) {
      const double* row = heights + static_cast<std::size_t>(leaf.r + j) * g.GetColumns() + leaf.c;
      const double v = j * share;
      const double west = nw + v * (sw - nw), south = share * (se - sw);
      const double start = nw + v * (se - ne), north = share * (ne - nw);
      for (int i = 0; i < j; ++i)
        worst = std::max(worst, std::abs(west + i * south - row[i]));
      for (int i = j; i <= n; ++i)
        worst = std::max(worst, std::abs(start + i * north - row[i]));
    }
    return worst;
  }
  const double middle = at(h, h);
  // Height of the fan at (x, y) half-widths from the middle: the triangle's side carries b, its
  // vertex the middle.
  const auto side = [](double first, double last, bool bent, double mid, double s) {
    if (!bent)
      return first + (s + 1.0) * 0.5 * (last - first);
    return s < 0.0 ? mid + s * (mid - first) : mid + s * (last - mid);
  };
  const auto fan = [&](double x, double y) {
    const double d = std::max(std::abs(x), std::abs(y));
    if (d == 0.0)
      return middle;
    double b;
    if (std::abs(x) >= std::abs(y))
      b = x < 0.0 ? side(nw, sw, leaf.fan & 1, at(0, h), y / d)
                  : side(ne, se, leaf.fan & 4, at(n, h), y / d);
    else
      b = y > 0.0 ? side(sw, se, leaf.fan & 2, at(h, n), x / d)
                  : side(nw, ne, leaf.fan & 8, at(h, 0), x / d);
    return middle + d * (b - middle);
  };
  for (int j = 0; j <= n; ++j)
    for (int i = 0; i <= n; ++i)
      worst = std::max(
          worst, std::abs(fan((i - h) / static_cast<double>(h), (j - h) / static_cast<double>(h)) -
                          at(i, j)));
  // The two spokes across the grid's diagonals cross them in the middle of cells.
  for (int i = 0; i < n; ++i) {
    const int j = n - 1 - i;
    const double x = (i + 0.5 - h) / h, y = (j + 0.5 - h) / h;
    worst = std::max(worst, std::abs(fan(x, y) - 0.5 * (at(i, j) + at(i + 1, j + 1))));
  }
  return worst;
}

} // namespace dspace
