#include <dspace/layers/vector/VectorTracer.h>

#include <cmath>

namespace dspace {
namespace {

constexpr double Margin = 2.0; // texels beyond what a pen reaches

// The part of a - b within a box, as shares of the way; empty: first > second.
std::pair<double, double> Within(const Eigen::Vector2d& a, const Eigen::Vector2d& b,
                                 const Eigen::AlignedBox2d& box) {
  double from = 0.0, to = 1.0;
  for (int axis = 0; axis < 2; ++axis) {
    const double step = b[axis] - a[axis];
    const double low = box.min()[axis] - a[axis], high = box.max()[axis] - a[axis];
    if (step == 0.0) {
      if (low > 0.0 || high < 0.0) {
        return {1.0, 0.0};
      }
    } else {
      from = std::max(from, std::min(low / step, high / step));
      to = std::min(to, std::max(low / step, high / step));
    }
  }
  return {from, to};
}

// Sutherland and Hodgman, one side of the box after the other: which texels within it are inside
// of the ring, even-odd, does not change.
TexelChain Clipped(TexelChain ring, const Eigen::AlignedBox2d& box) {
  for (int side = 0; side < 4 && !ring.empty(); ++side) {
    const int axis = side & 1;
    const double sign = side < 2 ? 1.0 : -1.0;
    const double bound = side < 2 ? box.min()[axis] : box.max()[axis];
    TexelChain result;
    result.reserve(ring.size() + 8);
    Eigen::Vector2d before = ring.back();
    double outsideBefore = sign * (bound - before[axis]);
    for (const Eigen::Vector2d& place : ring) {
      const double outside = sign * (bound - place[axis]);
      if ((outside > 0.0) != (outsideBefore > 0.0)) {
        Eigen::Vector2d cut =
            before + (place - before) * (outsideBefore / (outsideBefore - outside));
        cut[axis] = bound;
        result.push_back(cut);
      }
      if (!(outside > 0.0)) {
        result.push_back(place);
      }
      before = place;
      outsideBefore = outside;
    }
    ring = std::move(result);
  }
  return ring;
}

} // namespace

VectorTracer::VectorTracer(const ColorGrid& grid, const ColorBlock& block, double turn)
    : Grid_(grid), Sides_(grid, block.zoom), TexelToPost_(grid.TexelToPost(block.zoom)),
      Size_(block.width, block.height), Turn_(turn) {
  const Eigen::Translation2d first(double(block.column), double(block.row));
  this->TexelToPost_ = this->TexelToPost_ * first;
  // From whole numbers: what two blocks share is the same in both.
  this->MapToTexel_ = first.inverse() * grid.TexelToMap(block.zoom).inverse();
}

Eigen::AlignedBox2d VectorTracer::Window(double reach) const {
  const Eigen::Vector2d more = Eigen::Vector2d::Constant(reach + Margin);
  return {Eigen::Vector2d(-more), Eigen::Vector2d(this->Size_ + more)};
}

Eigen::Vector2d VectorTracer::PenAt(const Eigen::Vector2d& texel, const Width& width) const {
  constexpr double Thinnest = 1.0 / 32.0; // of a texel's height: its width next to a pole
  Eigen::Vector2d sides = this->Sides_.At(this->TexelToPost_ * texel);
  sides.x() = std::max(sides.x(), Thinnest * sides.y());
  const double metres = width.metres > 0.0 ? width.metres : width.pixels * sides.maxCoeff();
  Eigen::Vector2d pen = 0.5 * metres * sides.cwiseInverse();
  if (this->Grid_.placement.OnBody()) {
    constexpr double Steps = 50.0; // of a logarithm: lines are cut where their pen changes
    pen = ((pen.array().log() * Steps).round() / Steps).exp();
  }
  // Thinner ones vanish in coverage anyhow; wider ones would reach beyond what cairo counts.
  return pen.cwiseMax(1e-3).cwiseMin(1e5);
}

double VectorTracer::Reach(const Width& width) const {
  double reach = 0.0;
  for (const double u : {0.0, 0.5, 1.0}) {
    for (const double v : {0.0, 0.5, 1.0}) {
      const Eigen::Vector2d texel(u * this->Size_.x(), v * this->Size_.y());
      reach = std::max(reach, this->PenAt(texel, width).maxCoeff());
    }
  }
  return 1.05 * reach;
}

std::vector<Eigen::Vector2d> VectorTracer::Turns(const Eigen::AlignedBox2d& map,
                                                 double reach) const {
  Eigen::AlignedBox2d box;
  for (const auto corner : {Eigen::AlignedBox2d::BottomLeft, Eigen::AlignedBox2d::BottomRight,
                            Eigen::AlignedBox2d::TopLeft, Eigen::AlignedBox2d::TopRight}) {
    box.extend(this->ToTexel(map.corner(corner)));
  }
  const Eigen::AlignedBox2d window = this->Window(reach);
  const double turn = std::abs(this->MapToTexel_.linear()(0, 0) * this->Turn_);
  std::vector<Eigen::Vector2d> offsets;
  double first = 0.0, last = 0.0;
  if (turn > 0.0) {
    first = std::ceil((window.min().x() - box.max().x()) / turn);
    last = std::floor((window.max().x() - box.min().x()) / turn);
  }
  for (double n = first; n <= last; n += 1.0) {
    const Eigen::Vector2d offset(n * turn, 0.0);
    if (window.intersects(Eigen::AlignedBox2d(Eigen::Vector2d(box.min() + offset),
                                              Eigen::Vector2d(box.max() + offset)))) {
      offsets.push_back(offset);
    }
  }
  return offsets;
}

void VectorTracer::Refine(const Place& a, const Place& b, const MapConversion& conversion,
                          const Eigen::AlignedBox2d& window, const Eigen::Vector2d& offset,
                          int depth, TexelChain& chain) const {
  constexpr int Deepest = 48; // each step leaves at most two thirds
  // A third of the way along: there a bend to one side is seen, and one that turns.
  Place m;
  m.from = (2.0 * a.from + b.from) / 3.0;
  m.map = conversion.Apply(m.from);
  if (depth == Deepest || !m.map.allFinite()) {
    chain.push_back(b.texel);
    return;
  }
  if (this->Turn_ > 0.0) {
    const double chord = (2.0 * a.map.x() + b.map.x()) / 3.0;
    m.map.x() -= this->Turn_ * std::round((m.map.x() - chord) / this->Turn_);
  }
  m.texel = this->ToTexel(m.map) + offset;
  const double beside = (m.texel - (2.0 * a.texel + b.texel) / 3.0).norm();
  if (beside <= 0.2) {
    chain.push_back(b.texel);
    return;
  }
  Eigen::AlignedBox2d box(a.texel);
  box.extend(b.texel);
  box.extend(m.texel);
  const Eigen::Vector2d more = Eigen::Vector2d::Constant(2.0 * beside);
  if (!window.intersects(Eigen::AlignedBox2d(Eigen::Vector2d(box.min() - more),
                                             Eigen::Vector2d(box.max() + more)))) {
    chain.push_back(m.texel);
    chain.push_back(b.texel);
    return;
  }
  this->Refine(a, m, conversion, window, offset, depth + 1, chain);
  this->Refine(m, b, conversion, window, offset, depth + 1, chain);
}

// The first `count` places of a ring, unclipped; NaN where it has no place on the map.
TexelChain VectorTracer::Follow(const PlacedRing& ring, std::size_t count,
                                const MapConversion& conversion, const Eigen::Vector2d& offset,
                                double reach) const {
  const Eigen::AlignedBox2d window = this->Window(reach);
  const std::vector<Eigen::Vector2d>& from = ring.ring->places;
  const double bend = ring.bend * this->MapToTexel_.linear().cwiseAbs().maxCoeff();
  const Eigen::Vector2d more = Eigen::Vector2d::Constant(2.0 * bend);
  TexelChain chain;
  chain.reserve(count);
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d texel = this->ToTexel(ring.map[i]) + offset;
    if (i > 0 && i < from.size() && bend > 0.2 && texel.allFinite() && chain.back().allFinite()) {
      Eigen::AlignedBox2d box(chain.back());
      box.extend(texel);
      if (window.intersects(Eigen::AlignedBox2d(Eigen::Vector2d(box.min() - more),
                                                Eigen::Vector2d(box.max() + more)))) {
        this->Refine({from[i - 1], ring.map[i - 1], chain.back()}, {from[i], ring.map[i], texel},
                     conversion, window, offset, 0, chain);
        continue;
      }
    }
    chain.push_back(texel);
  }
  return chain;
}

TexelChain VectorTracer::Block() const {
  const Eigen::AlignedBox2d window = this->Window(0.0);
  return {window.corner(Eigen::AlignedBox2d::BottomLeft),
          window.corner(Eigen::AlignedBox2d::BottomRight),
          window.corner(Eigen::AlignedBox2d::TopRight),
          window.corner(Eigen::AlignedBox2d::TopLeft)};
}

TexelChain VectorTracer::Area(const PlacedRing& ring, const MapConversion& conversion,
                              const Eigen::Vector2d& offset) const {
  return Clipped(this->Follow(ring, ring.map.size(), conversion, offset, 0.0), this->Window(0.0));
}

void VectorTracer::Path(const PlacedRing& ring, const MapConversion& conversion,
                        const Eigen::Vector2d& offset, const Width& width,
                        std::vector<TexelStroke>& strokes) const {
  const double reach = this->Reach(width);
  const Eigen::AlignedBox2d window = this->Window(reach);
  const TexelChain chain = this->Follow(ring, ring.outline, conversion, offset, reach);
  for (std::size_t i = 1; i < chain.size(); ++i) {
    if (!chain[i - 1].allFinite() || !chain[i].allFinite()) {
      continue;
    }
    const auto [from, to] = Within(chain[i - 1], chain[i], window);
    if (from <= to) {
      const Eigen::Vector2d step = chain[i] - chain[i - 1];
      const Eigen::Vector2d a = from > 0.0 ? chain[i - 1] + from * step : chain[i - 1];
      const Eigen::Vector2d b = to < 1.0 ? chain[i - 1] + to * step : chain[i];
      this->Stroke(a, b, width, 0, strokes);
    }
  }
}

// A straight piece, divided where its pen changes.
void VectorTracer::Stroke(const Eigen::Vector2d& a, const Eigen::Vector2d& b, const Width& width,
                          int depth, std::vector<TexelStroke>& strokes) const {
  const Eigen::Vector2d pen = this->PenAt(a, width);
  if (depth < 12 && pen != this->PenAt(b, width) && (b - a).norm() > 1.0) {
    const Eigen::Vector2d middle = 0.5 * (a + b);
    this->Stroke(a, middle, width, depth + 1, strokes);
    this->Stroke(middle, b, width, depth + 1, strokes);
    return;
  }
  if (!strokes.empty() && strokes.back().pen == pen && strokes.back().chain.back() == a) {
    strokes.back().chain.push_back(b);
  } else {
    strokes.push_back({{a, b}, pen});
  }
}

} // namespace dspace
