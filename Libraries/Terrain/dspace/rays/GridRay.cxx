#include <dspace/rays/GridRay.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace dspace {

namespace {

constexpr float FloatInfinity = std::numeric_limits<float>::infinity();

float RoundedDown(double v) {
  const float f = static_cast<float>(v);
  return static_cast<double>(f) <= v ? f : std::nextafter(f, -FloatInfinity);
}

float RoundedUp(double v) {
  const float f = static_cast<float>(v);
  return static_cast<double>(f) >= v ? f : std::nextafter(f, FloatInfinity);
}

// Narrows [t0, t1] to where low <= o + t d <= high; false when nothing is left.
bool Clip(double o, double d, double low, double high, double& t0, double& t1) {
  if (d == 0.0)
    return o >= low && o <= high;
  double a = (low - o) / d, b = (high - o) / d;
  if (a > b)
    std::swap(a, b);
  t0 = std::max(t0, a);
  t1 = std::min(t1, b);
  return t0 <= t1;
}

} // namespace

// The ray in grid coordinates, and what it has seen so far.
struct GridRay::March {
  Eigen::Vector3d o; // (c, r, height)
  Eigen::Vector3d d;
  double slack = 0.0; // what heights along the ray may be off by through rounding
  int side = 0;       // +1 above ground, -1 below, 0 unknown (start, border, hole)
  double t = 0.0;     // where `side` was last seen
  double above = 0.0; // and by how much
  Hit hit;

  double C(double s) const { return this->o.x() + s * this->d.x(); }
  double R(double s) const { return this->o.y() + s * this->d.y(); }
  double Z(double s) const { return this->o.z() + s * this->d.z(); }
};

GridRay::GridRay(const HeightGrid& grid) : Grid_(grid) {
  int columns = grid.GetColumns() - 1, rows = grid.GetRows() - 1; // cells
  do {
    Level level;
    level.columns = columns = (columns + 1) / 2;
    level.rows = rows = (rows + 1) / 2;
    const std::size_t count = static_cast<std::size_t>(level.columns) * level.rows;
    level.least.resize(count);
    level.greatest.resize(count);
    this->Levels_.push_back(std::move(level));
    this->Build(this->Levels_.size() - 1, 0, 0, columns - 1, rows - 1);
  } while (columns > 1 || rows > 1);
}

// Blocks c0..c1, r0..r1 of a level, from those of the finer one.
void GridRay::Build(std::size_t index, int c0, int r0, int c1, int r1) {
  Level& level = this->Levels_[index];
  const Level* finer = index == 0 ? nullptr : &this->Levels_[index - 1];
  const int columns = this->Grid_.GetColumns() - 1, rows = this->Grid_.GetRows() - 1; // cells
  for (int r = r0; r <= r1; ++r)
    for (int c = c0; c <= c1; ++c) {
      float& least = level.least[static_cast<std::size_t>(r) * level.columns + c];
      float& greatest = level.greatest[static_cast<std::size_t>(r) * level.columns + c];
      least = FloatInfinity;
      greatest = -FloatInfinity;
      if (!finer) {
        for (int rr = 2 * r; rr <= std::min(2 * r + 2, rows); ++rr)
          for (int cc = 2 * c; cc <= std::min(2 * c + 2, columns); ++cc)
            if (this->Grid_.HasPost(cc, rr)) {
              least = std::min(least, RoundedDown(this->Grid_.At(cc, rr)));
              greatest = std::max(greatest, RoundedUp(this->Grid_.At(cc, rr)));
            }
        continue;
      }
      for (int rr = 2 * r; rr < std::min(2 * r + 2, finer->rows); ++rr)
        for (int cc = 2 * c; cc < std::min(2 * c + 2, finer->columns); ++cc) {
          const std::size_t i = static_cast<std::size_t>(rr) * finer->columns + cc;
          least = std::min(least, finer->least[i]);
          greatest = std::max(greatest, finer->greatest[i]);
        }
    }
}

void GridRay::Update(const Eigen::Vector2i& first, const Eigen::Vector2i& last) {
  // Cells that have the posts as corners, then the blocks that hold them.
  int c0 = first.x() - 1, r0 = first.y() - 1, c1 = last.x(), r1 = last.y();
  for (std::size_t k = 0; k < this->Levels_.size(); ++k) {
    c0 = std::max(c0, 0) / 2;
    r0 = std::max(r0, 0) / 2;
    c1 = std::min(c1 / 2, this->Levels_[k].columns - 1);
    r1 = std::min(r1 / 2, this->Levels_[k].rows - 1);
    this->Build(k, c0, r0, c1, r1);
  }
}

GridRay::Hit GridRay::Intersect(const Eigen::Vector3d& origin, const Eigen::Vector3d& direction,
                                double maximum) const {
  March march;
  march.o << this->Grid_.ToGrid(origin.head<2>()), origin.z();
  march.d << this->Grid_.GetGridToScene().linear().inverse() * direction.head<2>(), direction.z();

  const double lastC = this->Grid_.GetColumns() - 1, lastR = this->Grid_.GetRows() - 1;
  double t0 = 0.0, t1 = maximum;
  const std::array<double, 2> range = this->Range();
  const double pad = 1e-6 * (1.0 + range[1] - range[0]);
  const double low = range[0] - pad, high = range[1] + pad;
  if (march.d.head<2>().isZero(0.0)) {
    Hit hit;
    hit.facet = this->Grid_.FacetAt(march.o.head<2>());
    hit.distance = (hit.facet.height - march.o.z()) / march.d.z();
    hit.hit = hit.facet.valid && hit.distance >= 0.0 && hit.distance <= maximum;
    hit.fromBelow = direction.z() > 0.0;
    return hit;
  }
  // The border is as wide as that of HeightGrid::ToGrid: a ray that ends on it meets it.
  constexpr double border = 1e-9;
  if (!Clip(march.o.x(), march.d.x(), -border, lastC + border, t0, t1) ||
      !Clip(march.o.y(), march.d.y(), -border, lastR + border, t0, t1) ||
      !Clip(march.o.z(), march.d.z(), low, high, t0, t1) || !std::isfinite(t1))
    return {};
  // From where it enters the box, so that a far origin costs no digits inside.
  const double entry = t0;
  march.o += entry * march.d;
  t1 -= entry;
  march.slack = 1e-12 * (std::abs(march.o.z()) + std::abs(march.d.z()) * t1 + 1.0);
  this->Visit(march, static_cast<int>(this->Levels_.size()), 0, 0, 0.0, t1);
  march.hit.distance += entry;
  if (march.hit.hit && march.hit.distance > maximum)
    return {};
  return march.hit;
}

// Blocks of 2^level cells; (c, r) counts blocks. True once something is hit.
bool GridRay::Visit(March& march, int level, int c, int r, double t0, double t1) const {
  if (level == 0)
    return this->VisitCell(march, c, r, t0, t1);
  const Level& blocks = this->Levels_[level - 1];
  // A ray along the last grid line belongs to the last cells.
  c = std::min(c, blocks.columns - 1);
  r = std::min(r, blocks.rows - 1);
  const std::size_t i = static_cast<std::size_t>(r) * blocks.columns + c;
  const double z0 = march.Z(t0), z1 = march.Z(t1);
  // Wholly to one side: the sign there is known without looking, or there is only a hole.
  const bool above = std::min(z0, z1) - march.slack > blocks.greatest[i];
  const bool below = std::max(z0, z1) + march.slack < blocks.least[i];
  if (above || below) {
    march.side = 0;
    return false;
  }
  // Split where the ray crosses the block's middle lines; each piece lies in one quarter.
  const int half = 1 << (level - 1);
  const double middleC = (2.0 * c + 1.0) * half, middleR = (2.0 * r + 1.0) * half;
  std::array<double, 4> cuts = {t0, t0, t1, t1};
  int count = 1;
  std::array<double, 2> crossings = {
      march.d.x() != 0.0 ? (middleC - march.o.x()) / march.d.x() : -1.0,
      march.d.y() != 0.0 ? (middleR - march.o.y()) / march.d.y() : -1.0};
  if (crossings[0] > crossings[1])
    std::swap(crossings[0], crossings[1]);
  for (double t : crossings)
    if (t > t0 && t < t1)
      cuts[count++] = t;
  cuts[count] = t1;
  for (int k = 0; k < count; ++k) {
    const double middle = 0.5 * (cuts[k] + cuts[k + 1]);
    const int cc = 2 * c + (march.C(middle) >= middleC ? 1 : 0);
    const int rr = 2 * r + (march.R(middle) >= middleR ? 1 : 0);
    if (this->Visit(march, level - 1, cc, rr, cuts[k], cuts[k + 1]))
      return true;
  }
  return false;
}

bool GridRay::VisitCell(March& march, int c, int r, double t0, double t1) const {
  c = std::min(c, this->Grid_.GetColumns() - 2);
  r = std::min(r, this->Grid_.GetRows() - 2);
  // Where the ray changes from one triangle of the cell to the other.
  const double slide = march.d.x() - march.d.y();
  const double gap = (march.o.x() - c) - (march.o.y() - r);
  double cut = slide != 0.0 ? -gap / slide : t1;
  cut = cut > t0 && cut < t1 ? cut : t1;
  const std::array<double, 3> ends = {t0, cut, t1};
  for (int k = 0; k < (cut < t1 ? 2 : 1); ++k) {
    const double a = ends[k], b = ends[k + 1], middle = 0.5 * (a + b);
    const bool below = march.R(middle) - r > march.C(middle) - c; // triangle A
    if (!(below ? this->Grid_.HasA(c, r) : this->Grid_.HasB(c, r))) {
      march.side = 0;
      continue;
    }
    HeightGrid::Facet facet;
    facet.valid = true;
    const double nw = this->Grid_.At(c, r), se = this->Grid_.At(c + 1, r + 1);
    const double third = below ? this->Grid_.At(c, r + 1) : this->Grid_.At(c + 1, r);
    facet.dc = below ? se - third : third - nw;
    facet.dr = below ? third - nw : se - third;
    for (double t : {a, b}) {
      facet.height = nw + (march.C(t) - c) * facet.dc + (march.R(t) - r) * facet.dr;
      if (this->Observe(march, t, march.Z(t) - facet.height, facet))
        return true;
    }
  }
  return false;
}

bool GridRay::Observe(March& march, double t, double above, const HeightGrid::Facet& facet) const {
  const int side = above > 0.0 ? 1 : above < 0.0 ? -1 : 0;
  const bool touches = side == 0;
  const bool crosses = march.side != 0 && side == -march.side;
  if (touches || crosses) {
    Hit& hit = march.hit;
    hit.hit = true;
    hit.fromBelow = march.side != 0 ? march.side < 0 : march.d.z() > 0.0;
    // Between the two places seen the function is linear.
    hit.distance = crosses ? march.t + (t - march.t) * march.above / (march.above - above) : t;
    hit.facet = facet;
    return true;
  }
  march.side = side;
  march.t = t;
  march.above = above;
  return false;
}

} // namespace dspace
