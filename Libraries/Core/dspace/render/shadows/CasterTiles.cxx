#include <dspace/render/shadows/CasterTiles.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace dspace {
namespace {

// How far below a place, in texels, a caster may still darken the texels about it (Shadow.glsl), on
// surfaces that the light does not graze.
constexpr double Below = 16.0;
constexpr double Grazing = 1e-3; // sine of the light's elevation over planes that say nothing more

// The sides of the convex hull of points (A. M. Andrew 1979), moved outwards by a radius. Returns
// how many there are: none of too many points, which a box must do for.
template<std::size_t Most>
int SidesOf(const std::vector<Eigen::Vector3d>& given, double radius,
            std::array<Eigen::Vector3d, Most>& sides) {
  std::array<Eigen::Vector2d, Most> points;
  if (given.size() > Most) {
    return 0;
  }
  const auto end = std::transform(given.begin(), given.end(), points.begin(),
                                  [](const Eigen::Vector3d& p) { return p.head<2>(); });
  const auto before = [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  };
  for (auto p = points.begin(); p != end; ++p) { // there are few
    std::rotate(std::upper_bound(points.begin(), p, *p, before), p, p + 1);
  }
  int count = 0;
  for (const double turn : {1.0, -1.0}) { // the lower half, and the upper one
    std::array<Eigen::Vector2d, Most> chain;
    std::size_t length = 0;
    for (auto p = points.begin(); p != end; ++p) {
      while (length > 1) {
        const Eigen::Vector2d a = chain[length - 1] - chain[length - 2];
        const Eigen::Vector2d b = *p - chain[length - 1];
        if (turn * (a.x() * b.y() - a.y() * b.x()) > 0.0) {
          break;
        }
        --length;
      }
      chain[length++] = *p;
    }
    for (std::size_t i = 1; i < length && count < int(Most); ++i) {
      const Eigen::Vector2d along = chain[i] - chain[i - 1];
      const double distance = along.norm();
      if (distance > 0.0) {
        const Eigen::Vector2d out = turn / distance * Eigen::Vector2d(along.y(), -along.x());
        sides[std::size_t(count++)] = {out.x(), out.y(), out.dot(chain[i]) + radius};
      }
    }
  }
  return count;
}

} // namespace

CasterTiles::CasterTiles(const CascadeFit& fit, const CascadeFit::Cascade& cascade)
    : Axes_(fit.sun.axes), Corner_(cascade.center - Eigen::Vector2d::Constant(cascade.radius)),
      Texel_(cascade.Texel(fit.size)), Tile_(2.0 * cascade.radius / Side), Size_(fit.size),
      Tops_(Side * Side, Nothing), Lows_(Side * Side, Everything) {}

CasterTiles::Extent CasterTiles::ExtentOf(const LightHull& hull) const {
  Extent extent;
  thread_local std::vector<Eigen::Vector3d> places;
  places.clear();
  for (const Eigen::Vector3d& point : hull.points) {
    places.push_back(this->Axes_ * point);
    extent.box.extend(places.back());
  }
  extent.box.min().array() -= hull.radius;
  extent.box.max().array() += hull.radius;
  const auto along = [this](const Eigen::Vector4d& plane) -> std::optional<Eigen::Vector3d> {
    const Eigen::Vector3d normal = this->Axes_ * plane.head<3>();
    if (normal.z() < Grazing) {
      return std::nullopt;
    }
    return Eigen::Vector3d(-plane[3], -normal.x(), -normal.y()) / normal.z();
  };
  extent.floor = hull.floor ? along(*hull.floor) : std::nullopt;
  extent.ceiling = hull.ceiling ? along(*hull.ceiling) : std::nullopt;
  const Eigen::Vector2d sizes = extent.box.sizes().head<2>();
  if (sizes.maxCoeff() > this->Tile_) { // the box does of what fills few tiles
    extent.sideCount = SidesOf(places, hull.radius, extent.sides);
  }
  return extent;
}

std::optional<std::array<int, 4>> CasterTiles::TilesOf(const Eigen::AlignedBox3d& box,
                                                       double room) const {
  std::array<int, 4> tiles;
  for (const int axis : {0, 1}) {
    const double from = std::floor((box.min()[axis] - room - this->Corner_[axis]) / this->Tile_);
    const double to = std::floor((box.max()[axis] + room - this->Corner_[axis]) / this->Tile_);
    tiles[axis] = int(std::clamp(from, 0.0, double(Side)));
    tiles[axis + 2] = int(std::clamp(to + 1.0, 0.0, double(Side)));
    if (tiles[axis] >= tiles[axis + 2]) {
      return std::nullopt;
    }
  }
  return tiles;
}

std::array<int, 2> CasterTiles::SpanOf(const Extent& extent, int row, int left, int right,
                                       double room) const {
  constexpr double Rounding = 1e-9; // tiles
  const double half = 0.5 * this->Tile_ + room;
  const double v = this->Corner_.y() + this->Tile_ * (row + 0.5);
  double from = left;
  double to = right;
  for (int i = 0; i < extent.sideCount; ++i) {
    const Eigen::Vector3d& side = extent.sides[std::size_t(i)];
    // side.x times the middle of a tile is no more.
    const double most = side.z() + half * side.head<2>().lpNorm<1>() - side.y() * v;
    const double at = (most / side.x() - this->Corner_.x()) / this->Tile_ - 0.5;
    if (side.x() > 0.0) {
      to = std::min(to, std::floor(at + Rounding) + 1.0);
    } else if (side.x() < 0.0) {
      from = std::max(from, std::ceil(at - Rounding));
    } else if (most < 0.0) {
      to = from;
    }
  }
  return to > from ? std::array<int, 2>{int(from), int(to)} : std::array<int, 2>{left, left};
}

template<class Taken>
bool CasterTiles::AnyTile(const Extent& extent, const std::array<int, 4>& tiles, double room,
                          const Taken& taken) const {
  const double highest = extent.box.max().z();
  const double lowest = extent.box.min().z();
  for (int j = tiles[1]; j < tiles[3]; ++j) {
    const auto [first, end] = this->SpanOf(extent, j, tiles[0], tiles[2], room);
    for (int i = first; i < end; ++i) {
      const double high = extent.ceiling
                              ? std::min(highest, this->Extreme(*extent.ceiling, i, j, room, 1.0))
                              : highest;
      const double low =
          extent.floor ? std::max(lowest, this->Extreme(*extent.floor, i, j, room, -1.0)) : lowest;
      if (taken(std::size_t(j) * Side + std::size_t(i), high, low)) {
        return true;
      }
    }
  }
  return false;
}

double CasterTiles::Extreme(const Eigen::Vector3d& plane, int i, int j, double room,
                            double sign) const {
  const Eigen::Vector2d middle = this->Corner_ + this->Tile_ * Eigen::Vector2d(i + 0.5, j + 0.5);
  return plane[0] + plane.tail<2>().dot(middle) +
         sign * (0.5 * this->Tile_ + room) * plane.tail<2>().lpNorm<1>();
}

void CasterTiles::Add(const Extent& extent) {
  const double room = Margin * this->Texel_;
  const auto tiles = this->TilesOf(extent.box, room);
  if (!tiles) {
    return;
  }
  this->AnyTile(extent, *tiles, room, [this](std::size_t at, double high, double low) {
    // A float of which neither is beyond.
    if (high > double(this->Tops_[at])) {
      this->Tops_[at] = std::nextafter(float(high), Everything);
    }
    if (low < double(this->Lows_[at])) {
      this->Lows_[at] = std::nextafter(float(low), Nothing);
    }
    return false;
  });
  const auto& [left, bottom, right, top] = *tiles;
  this->Tiles_ = {std::min(this->Tiles_[0], left), std::min(this->Tiles_[1], bottom),
                  std::max(this->Tiles_[2], right), std::max(this->Tiles_[3], top)};
}

void CasterTiles::Add(const LightHull& hull) {
  if (hull.points.empty()) {
    this->AddEverywhere();
  } else if (!this->InParts(hull)) {
    this->Add(this->ExtentOf(hull));
  } else {
    for (const Eigen::AlignedBox3f& part : *hull.parts) {
      this->AddBox(part.cast<double>(), hull.X_VM);
    }
  }
}

CasterTiles::Extent CasterTiles::ExtentOf(const Eigen::AlignedBox3d& box,
                                          const Eigen::Matrix<double, 3, 4>& X_VB) const {
  const Eigen::Vector3d center = this->Axes_ * (X_VB * box.center().homogeneous());
  const Eigen::Vector3d half = (this->Axes_ * X_VB.leftCols<3>()).cwiseAbs() * (0.5 * box.sizes());
  Extent extent;
  extent.box = Eigen::AlignedBox3d(center - half, center + half);
  return extent;
}

void CasterTiles::AddBox(const Eigen::AlignedBox3d& box, const Eigen::Matrix<double, 3, 4>& X_VB) {
  if (!box.isEmpty()) {
    this->Add(this->ExtentOf(box, X_VB));
  }
}

void CasterTiles::AddEverywhere() {
  std::fill(this->Tops_.begin(), this->Tops_.end(), Everything);
  std::fill(this->Lows_.begin(), this->Lows_.end(), Nothing);
  this->Tiles_ = {0, 0, Side, Side};
}

bool CasterTiles::InParts(const LightHull& hull) const {
  constexpr int Few = 9; // tiles
  if (!hull.parts || hull.parts->empty()) {
    return false;
  }
  const auto tiles = this->TilesOf(this->ExtentOf(hull).box, Margin * this->Texel_);
  return tiles && ((*tiles)[2] - (*tiles)[0]) * ((*tiles)[3] - (*tiles)[1]) > Few;
}

bool CasterTiles::Shade(const LightHull& place) const {
  return place.points.empty() ? !this->Empty() : this->Shade(this->ExtentOf(place));
}

bool CasterTiles::Shade(const Extent& extent) const {
  const auto tiles = this->TilesOf(extent.box, 0.0);
  if (!tiles) {
    return false;
  }
  const double room = Below * this->Texel_;
  return this->AnyTile(extent, *tiles, 0.0, [&](std::size_t at, double, double low) {
    return double(this->Tops_[at]) > low - room;
  });
}

bool CasterTiles::TakeShadows(const LightHull& caster, double above) const {
  if (caster.points.empty()) {
    return !this->Empty();
  }
  if (!this->TakeShadows(this->ExtentOf(caster), above)) {
    return false;
  }
  return !this->InParts(caster) ||
         std::any_of(
             caster.parts->begin(), caster.parts->end(), [&](const Eigen::AlignedBox3f& part) {
               return this->TakeShadows(this->ExtentOf(part.cast<double>(), caster.X_VM), above);
             });
}

bool CasterTiles::TakeShadows(const Extent& extent, double above) const {
  const auto tiles = this->TilesOf(extent.box, 0.0);
  if (!tiles) {
    return false;
  }
  const double lower = above - Below * this->Texel_;
  return this->AnyTile(extent, *tiles, 0.0, [&](std::size_t at, double high, double) {
    return double(this->Lows_[at]) < high - lower;
  });
}

bool CasterTiles::Empty() const {
  return this->Tiles_[0] >= this->Tiles_[2];
}

std::array<int, 4> CasterTiles::Texels() const {
  if (this->Empty()) {
    return {0, 0, 0, 0};
  }
  // A tile holds what is up to a margin beside it; the search of a place in it goes another beyond.
  std::array<int, 4> texels;
  for (const int axis : {0, 1}) {
    texels[axis] = std::max(0, this->Tiles_[axis] * this->Size_ / Side - Margin);
    const int last = (this->Tiles_[axis + 2] * this->Size_ + Side - 1) / Side + Margin;
    texels[axis + 2] = std::min(this->Size_, last);
  }
  return texels;
}

bool MayBeShaded(const CascadeFit& fit, const std::vector<CasterTiles>& tiles,
                 const LightHull& place) {
  double nearest = place.points.empty() ? 0.0 : std::numeric_limits<double>::infinity();
  for (const Eigen::Vector3d& point : place.points) {
    nearest = std::min(nearest, -point.z() - place.radius);
  }
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    if (nearest <= fit.cascades[k].end && tiles[k].Shade(place)) {
      return true;
    }
  }
  return false;
}

} // namespace dspace
