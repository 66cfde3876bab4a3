#include <dspace/rays/SurfaceRay.h>

#include <algorithm>
#include <chrono>
#include <cmath>

#include <dspace/groups/GroupProbe.h>

namespace dspace {
namespace {

using Clock = std::chrono::steady_clock;

// Where f, of opposite signs at a and b, is 0: the secant with Illinois' halving.
template<typename Function>
double RootOf(const Function& f, double a, double fa, double b, double fb) {
  for (int i = 0; i < 100 && std::abs(b - a) > 1e-10; ++i) {
    double t = b - fb * (b - a) / (fb - fa);
    if (!(t > std::min(a, b) && t < std::max(a, b)) || i % 10 == 9) {
      t = 0.5 * (a + b);
    }
    const double ft = f(t);
    if (std::abs(ft) < 1e-12) {
      return t;
    }
    if ((ft > 0.0) == (fb > 0.0)) {
      fa *= 0.5;
    } else {
      a = b;
      fa = fb;
    }
    b = t;
    fb = ft;
  }
  return std::abs(fa) < std::abs(fb) ? a : b;
}

} // namespace

// A ray's way, and what it has seen so far.
struct SurfaceRay::March {
  const RayPath& path;
  int side = 0; // +1 above ground, -1 below, 0 unknown (start, border, hole)
  Hit hit;
  RayLayer::Hold hold;      // of the surface
  RayLayer::Hold plainHold; // of the plain one
  std::unique_ptr<GroupProbe> probe;
  bool asked = false; // for the probe
  std::vector<double> crossings;

  void Meet(double t, const HeightGrid::Facet& facet) {
    this->hit.hit = true;
    this->hit.fromBelow = this->side != 0 ? this->side < 0 : this->path.Rises(t);
    this->hit.distance = this->path.Distance(t);
    this->hit.facet = facet;
  }
};

SurfaceRay::SurfaceRay(const PostSurface& surface, const PostSurface* plain,
                       std::unique_ptr<const RayCover> cover)
    : Layer_(std::make_unique<RayLayer>(surface)),
      Plain_(plain ? std::make_unique<RayLayer>(*plain) : nullptr), Cover_(std::move(cover)) {}

SurfaceRay::Hit SurfaceRay::Intersect(const RayPath& path) const {
  const Clock::time_point start = Clock::now();
  const auto remaining = [start, deadline = this->Layer_->Surface().Deadline()] {
    return std::max(0.0, deadline - std::chrono::duration<double>(Clock::now() - start).count());
  };
  March march{path, 0, {}, {nullptr, remaining}, {nullptr, remaining}, nullptr, false, {}};
  this->Layer_->Refresh();
  if (this->Plain_) {
    this->Plain_->Refresh();
  }
  if (path.First() > path.Last()) {
    return {};
  }
  // Pieces that lie wholly within the lattice or outside it.
  const PostLattice& lattice = this->Layer_->Surface().Lattice();
  const double lastColumn = double(lattice.columns - (lattice.periodic ? 0 : 1));
  const auto lastRow = double(lattice.rows - 1);
  std::vector<double> cuts = {path.Nearest()};
  path.ColumnCrossings(0.0, cuts);
  path.ColumnCrossings(lastColumn, cuts);
  path.RowCrossings(0.0, cuts);
  path.RowCrossings(lastRow, cuts);
  for (double& t : cuts) {
    t = std::clamp(t, path.First(), path.Last());
  }
  cuts.push_back(path.First());
  cuts.push_back(path.Last());
  std::sort(cuts.begin(), cuts.end());
  int bits = 0;
  while ((std::int64_t(1) << bits) < std::max(lattice.columns, lattice.rows)) {
    ++bits;
  }
  const double border = 1e-8; // a ray along the border is inside
  for (std::size_t i = 0; i + 1 < cuts.size(); ++i) {
    if (cuts[i] == cuts[i + 1] && i + 2 < cuts.size()) {
      continue;
    }
    const Eigen::Vector2d g = path.Post(0.5 * (cuts[i] + cuts[i + 1]), 0.5 * lastColumn);
    const bool inside = g.x() >= -border && g.x() <= lastColumn + border && g.y() >= -border &&
                        g.y() <= lastRow + border;
    if (!inside) {
      march.side = 0;
    } else if (this->Visit(march, bits, 0, 0, cuts[i], cuts[i + 1], Way::Tiles)) {
      return march.hit;
    }
  }
  return {};
}

// Whether the ray passes a block wholly above or below, as far as that is known without its cells.
bool SurfaceRay::Misses(March& march, int bits, std::int64_t c, std::int64_t r, double t0,
                        double t1, Way way) const {
  const RayPath& path = march.path;
  const auto [low, high] = path.Heights(t0, t1);
  const auto misses = [&, low = low, high = high](const RayTile::Range& range) {
    return low - path.Slack() > range.greatest || high + path.Slack() < range.least;
  };
  const auto plain = [&] { return this->Plain_->RangeOf(march.plainHold, bits, c, r); };
  if (way == Way::Plain) {
    return bits <= this->Plain_->Bits() && misses(plain());
  }
  if (way == Way::Single) {
    return misses(this->Cover_->Over(*march.probe, bits, c, r, plain));
  }
  if (bits < this->Layer_->Bits()) {
    return misses(this->Layer_->RangeOf(march.hold, bits, c, r));
  }
  // What the cover says spares reading the tile.
  if (this->Plain_ && bits <= this->Plain_->Bits() &&
      misses(this->Cover_->Over(bits, c, r, plain()))) {
    return true;
  }
  return bits == this->Layer_->Bits() && misses(this->Layer_->RangeOf(march.hold, bits, c, r));
}

// Of a block as wide as a tile of the surface, or wider.
SurfaceRay::Way SurfaceRay::WayOf(March& march, int bits, std::int64_t c, std::int64_t r) const {
  if (!this->Cover_->Reaches(bits, c, r)) {
    return Way::Plain;
  }
  if (bits > PatchProbe::Bits || this->Cover_->ReachedByTracks(bits, c, r)) {
    return Way::Tiles;
  }
  if (!march.asked) {
    march.asked = true;
    march.probe = this->Cover_->MakeProbe();
  }
  const std::int64_t size = std::int64_t(1) << bits;
  const bool reads = march.probe && march.probe->HasRows(r * size, (r + 1) * size) &&
                     this->Layer_->Surface().Level() == 0;
  return reads ? Way::Single : Way::Tiles;
}

// (c, r) counts blocks of 2^bits cells. True once something is hit.
bool SurfaceRay::Visit(March& march, int bits, std::int64_t c, std::int64_t r, double t0, double t1,
                       Way way) const {
  const PostLattice& lattice = this->Layer_->Surface().Lattice();
  // A ray along the last line belongs to the last cells.
  const std::int64_t lastColumn = lattice.columns - (lattice.periodic ? 1 : 2);
  c = std::clamp<std::int64_t>(c, 0, lastColumn >> bits);
  r = std::clamp<std::int64_t>(r, 0, (lattice.rows - 2) >> bits);
  if (way == Way::Tiles && this->Plain_ && bits >= this->Layer_->Bits()) {
    way = this->WayOf(march, bits, c, r);
  }
  if (bits == 0) {
    return this->VisitCell(march, c, r, t0, t1, way);
  }
  const RayPath& path = march.path;
  if (this->Misses(march, bits, c, r, t0, t1, way)) {
    march.side = 0; // known without looking, or there is only a hole
    return false;
  }
  // Split where the ray crosses the block's middle lines; each piece lies in one quarter.
  const std::int64_t half = std::int64_t(1) << (bits - 1);
  const auto middleColumn = double((2 * c + 1) * half);
  const auto middleRow = double((2 * r + 1) * half);
  std::vector<double>& crossings = march.crossings;
  crossings.clear();
  path.ColumnCrossings(middleColumn, crossings);
  path.RowCrossings(middleRow, crossings);
  std::array<double, 6> cuts = {t0, t1, t1, t1, t1, t1};
  int count = 1;
  for (const double t : crossings) { // four at most, put where they belong
    if (t > t0 && t < t1) {
      int at = count++;
      for (; at > 1 && cuts[at - 1] > t; --at) {
        cuts[at] = cuts[at - 1];
      }
      cuts[at] = t;
    }
  }
  cuts[count] = t1;
  const double near = 0.5 * double(lastColumn + 1);
  for (int k = 0; k < count; ++k) {
    const Eigen::Vector2d g = path.Post(0.5 * (cuts[k] + cuts[k + 1]), near);
    const std::int64_t cc = 2 * c + (g.x() >= middleColumn ? 1 : 0);
    const std::int64_t rr = 2 * r + (g.y() >= middleRow ? 1 : 0);
    if (this->Visit(march, bits - 1, cc, rr, cuts[k], cuts[k + 1], way)) {
      return true;
    }
  }
  return false;
}

bool SurfaceRay::VisitCell(March& march, std::int64_t c, std::int64_t r, double t0, double t1,
                           Way way) const {
  if (way == Way::Single) { // level 0
    const auto at = [&](std::int64_t i, std::int64_t j) -> double { return march.probe->At(i, j); };
    return this->Follow(march, this->Layer_->Surface(), at, c, r, t0, t1);
  }
  RayLayer& layer = way == Way::Plain ? *this->Plain_ : *this->Layer_;
  const int level = layer.Surface().Level() + RayTile::Bits;
  return this->Follow(
      march, layer.Surface(),
      layer.TileOf(way == Way::Plain ? march.plainHold : march.hold, c >> level, r >> level), c, r,
      t0, t1);
}

// Through a cell of level 0; `posts(c, r)` are the surface's.
template<typename Posts>
bool SurfaceRay::Follow(March& march, const PostSurface& surface, const Posts& posts,
                        std::int64_t c, std::int64_t r, double t0, double t1) const {
  const RayPath& path = march.path;
  // The cell between posts that it is part of, and its place in it.
  const int level = surface.Level();
  const std::int64_t column = c >> level;
  const std::int64_t row = r >> level;
  const double size = std::ldexp(1.0, -level);
  const Eigen::Vector2d corner = {double(c), double(r)};
  const Eigen::Vector2d within = {double(c - (column << level)) * size,
                                  double(r - (row << level)) * size};
  const auto placeAt = [&](double t) {
    return Eigen::Vector2d(path.Post(t, corner.x() + 0.5) - corner);
  };
  // Where the ray changes from one triangle of the cell to the other.
  std::array<double, 3> ends = {t0, t1, t1};
  int pieces = 1;
  const bool onDiagonal = within.x() == within.y() && !surface.AtPole(row);
  if (onDiagonal) {
    const auto gap = [&](double t) {
      const Eigen::Vector2d g = placeAt(t);
      return g.x() - g.y();
    };
    const double g0 = gap(t0);
    const double g1 = gap(t1);
    if ((g0 > 0.0 && g1 < 0.0) || (g0 < 0.0 && g1 > 0.0)) {
      ends[1] = path.Curved() ? RootOf(gap, t0, g0, t1, g1) : t0 + (t1 - t0) * g0 / (g0 - g1);
      pieces = 2;
    }
  }
  for (int k = 0; k < pieces; ++k) {
    const double a = ends[k];
    const double b = ends[k + 1];
    const Eigen::Vector2d middle = onDiagonal ? placeAt(0.5 * (a + b)) : within;
    const bool below = middle.y() > middle.x(); // triangle A
    HeightGrid::Facet facet;
    const auto over = [&](double t) {
      const Eigen::Vector2d g = within + placeAt(t).cwiseMax(0.0).cwiseMin(1.0) * size;
      facet = surface.OfCell(posts, column, row, below, g.x(), g.y());
      return path.Height(t) - facet.height;
    };
    const double fa = over(a);
    if (!facet.valid) {
      march.side = 0;
      continue;
    }
    const int side = fa > 0.0 ? 1 : fa < 0.0 ? -1 : 0;
    if (side == 0 || side == -march.side) {
      march.Meet(a, facet);
      return true;
    }
    march.side = side;
    // Places to look at after a, in their order.
    std::array<double, 3> at = {b, b, b};
    int count = 1;
    if (path.Curved() && b > a) {
      const double m = 0.5 * (a + b);
      const double fm = over(m);
      const double fb = over(b);
      // The parabola through the three has its extreme at m + x (b - a) / 2.
      const double bend = fa - 2.0 * fm + fb;
      const double x = bend != 0.0 ? 0.5 * (fa - fb) / bend : 2.0;
      const double extreme = fm - 0.25 * (fa - fb) * x;
      if (std::abs(x) < 1.0 && (extreme > 0.0) != (side > 0) && (fm > 0.0) == (side > 0)) {
        at = {m, m + 0.5 * x * (b - a), b};
        if (at[1] < at[0]) {
          std::swap(at[0], at[1]);
        }
        count = 3;
      } else {
        at = {m, b, b};
        count = 2;
      }
    }
    double from = a;
    double before = fa;
    for (int i = 0; i < count; ++i) {
      const double f = over(at[i]);
      if (f == 0.0 || (f > 0.0) != (before > 0.0)) {
        const double t = path.Curved() ? RootOf(over, from, before, at[i], f)
                                       : from + (at[i] - from) * before / (before - f);
        over(t);
        march.Meet(t, facet);
        return true;
      }
      from = at[i];
      before = f;
    }
  }
  return false;
}

} // namespace dspace
