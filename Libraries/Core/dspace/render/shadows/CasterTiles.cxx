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

// The sides of the convex hull of points (A. M. Andrew 1979), moved outwards by a radius.
std::vector<Eigen::Vector3d> SidesOf(std::vector<Eigen::Vector2d> points, double radius) {
  std::sort(points.begin(), points.end(), [](const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
    return a.x() < b.x() || (a.x() == b.x() && a.y() < b.y());
  });
  std::vector<Eigen::Vector3d> sides;
  for (const double turn : {1.0, -1.0}) { // the lower half, and the upper one
    std::vector<Eigen::Vector2d> chain;
    for (const Eigen::Vector2d& p : points) {
      while (chain.size() > 1) {
        const Eigen::Vector2d a = chain.back() - chain[chain.size() - 2];
        const Eigen::Vector2d b = p - chain.back();
        if (turn * (a.x() * b.y() - a.y() * b.x()) > 0.0) {
          break;
        }
        chain.pop_back();
      }
      chain.push_back(p);
    }
    for (std::size_t i = 1; i < chain.size(); ++i) {
      const Eigen::Vector2d along = chain[i] - chain[i - 1];
      const double length = along.norm();
      if (length > 0.0) {
        const Eigen::Vector2d out = turn / length * Eigen::Vector2d(along.y(), -along.x());
        sides.emplace_back(out.x(), out.y(), out.dot(chain[i]) + radius);
      }
    }
  }
  return sides;
}

} // namespace

CasterTiles::CasterTiles(const CascadeFit& fit, const CascadeFit::Cascade& cascade)
    : Axes_(fit.sun.axes), Corner_(cascade.center - Eigen::Vector2d::Constant(cascade.radius)),
      Texel_(cascade.Texel(fit.size)), Tile_(2.0 * cascade.radius / Side), Size_(fit.size),
      Tops_(Side * Side, Nothing), Lows_(Side * Side, Everything) {}

CasterTiles::Extent CasterTiles::ExtentOf(const LightHull& hull) const {
  Extent extent;
  std::vector<Eigen::Vector2d> places;
  for (const Eigen::Vector3d& point : hull.points) {
    const Eigen::Vector3d light = this->Axes_ * point;
    extent.box.extend(light);
    places.emplace_back(light.head<2>());
  }
  extent.sides = SidesOf(std::move(places), hull.radius);
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

bool CasterTiles::Beside(const Extent& extent, int i, int j, double room) const {
  const Eigen::Vector2d middle = this->Corner_ + this->Tile_ * Eigen::Vector2d(i + 0.5, j + 0.5);
  const double half = 0.5 * this->Tile_ + room;
  return std::any_of(extent.sides.begin(), extent.sides.end(), [&](const Eigen::Vector3d& side) {
    return side.head<2>().dot(middle) - half * side.head<2>().lpNorm<1>() > side.z();
  });
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
  const auto& [left, bottom, right, top] = *tiles;
  for (int j = bottom; j < top; ++j) {
    for (int i = left; i < right; ++i) {
      if (this->Beside(extent, i, j, room)) {
        continue;
      }
      const double high = extent.ceiling ? std::min(extent.box.max().z(),
                                                    this->Extreme(*extent.ceiling, i, j, room, 1.0))
                                         : extent.box.max().z();
      const double low = extent.floor ? std::max(extent.box.min().z(),
                                                 this->Extreme(*extent.floor, i, j, room, -1.0))
                                      : extent.box.min().z();
      const std::size_t at = std::size_t(j) * Side + i;
      this->Tops_[at] = std::max(this->Tops_[at], std::nextafter(float(high), Everything));
      this->Lows_[at] = std::min(this->Lows_[at], std::nextafter(float(low), Nothing));
    }
  }
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
  const auto& [left, bottom, right, top] = *tiles;
  for (int j = bottom; j < top; ++j) {
    for (int i = left; i < right; ++i) {
      const double low = extent.floor ? std::max(extent.box.min().z(),
                                                 this->Extreme(*extent.floor, i, j, 0.0, -1.0))
                                      : extent.box.min().z();
      if (double(this->Tops_[std::size_t(j) * Side + i]) > low - room &&
          !this->Beside(extent, i, j, 0.0)) {
        return true;
      }
    }
  }
  return false;
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
  const auto& [left, bottom, right, top] = *tiles;
  for (int j = bottom; j < top; ++j) {
    for (int i = left; i < right; ++i) {
      const double high = extent.ceiling ? std::min(extent.box.max().z(),
                                                    this->Extreme(*extent.ceiling, i, j, 0.0, 1.0))
                                         : extent.box.max().z();
      if (double(this->Lows_[std::size_t(j) * Side + i]) < high - lower &&
          !this->Beside(extent, i, j, 0.0)) {
        return true;
      }
    }
  }
  return false;
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
