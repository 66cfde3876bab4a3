#include <dspace/render/shadows/CasterTiles.h>

#include <algorithm>
#include <cmath>

namespace dspace {
namespace {

// How far below a place, in texels, a caster may still darken the texels about it (Shadow.glsl), on
// surfaces that the light does not graze.
constexpr double Below = 16.0;

// Floats of which none is below, or above, the number (to a unit in the last place or two).
float Above(double number) {
  const float near = float(number);
  return near + std::abs(near) * 1.2e-7f;
}

float Beneath(double number) {
  const float near = float(number);
  return near - std::abs(near) * 1.2e-7f;
}

} // namespace

CasterTiles::CasterTiles(const CascadeFit& fit, const CascadeFit::Cascade& cascade)
    : Axes_(fit.sun.axes), Corner_(cascade.center - Eigen::Vector2d::Constant(cascade.radius)),
      Texel_(cascade.Texel(fit.size)), Tile_(2.0 * cascade.radius / Side), Size_(fit.size),
      Tops_(Side * Side, Nothing), Lows_(Side * Side, Everything) {}

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

CasterTiles::Line CasterTiles::LineOf(const std::optional<Eigen::Vector3d>& plane, double bound,
                                      int j, double room, double sign) const {
  if (!plane) {
    return {bound, bound, 0.0};
  }
  const Eigen::Vector2d middle = this->Corner_ + this->Tile_ * Eigen::Vector2d(0.5, j + 0.5);
  return {bound,
          (*plane)[0] + plane->tail<2>().dot(middle) +
              sign * (0.5 * this->Tile_ + room) * plane->tail<2>().lpNorm<1>(),
          this->Tile_ * plane->y()};
}

template<class Taken>
bool CasterTiles::AnyRow(const Extent& extent, const std::array<int, 4>& tiles, double room,
                         const Taken& taken) const {
  for (int j = tiles[1]; j < tiles[3]; ++j) {
    // The box does of what fills few tiles.
    const auto [first, end] = tiles[2] - tiles[0] > 2 || tiles[3] - tiles[1] > 2
                                  ? this->SpanOf(extent, j, tiles[0], tiles[2], room)
                                  : std::array<int, 2>{tiles[0], tiles[2]};
    if (first < end && taken(std::size_t(j) * Side, first, end,
                             this->LineOf(extent.ceiling, extent.box.max().z(), j, room, 1.0),
                             this->LineOf(extent.floor, extent.box.min().z(), j, room, -1.0))) {
      return true;
    }
  }
  return false;
}

void CasterTiles::Add(const Extent& extent) {
  const double room = Margin * this->Texel_;
  const auto tiles = this->TilesOf(extent.box, room);
  if (!tiles) {
    return;
  }
  this->AnyRow(extent, *tiles, room,
               [this](std::size_t row, int first, int end, const Line& high, const Line& low) {
                 float* const tops = &this->Tops_[row];
                 float* const lows = &this->Lows_[row];
                 for (int i = first; i < end; ++i) {
                   const float top = Above(std::min(high.bound, high.start + high.step * i));
                   tops[i] = top > tops[i] ? top : tops[i];
                 }
                 for (int i = first; i < end; ++i) {
                   const float bottom = Beneath(std::max(low.bound, low.start + low.step * i));
                   lows[i] = bottom < lows[i] ? bottom : lows[i];
                 }
                 return false;
               });
  this->Hold(*tiles);
}

void CasterTiles::Add(const Eigen::AlignedBox3d& box) {
  const auto tiles = this->TilesOf(box, Margin * this->Texel_);
  if (!tiles) {
    return;
  }
  const float top = Above(box.max().z());
  const float bottom = Beneath(box.min().z());
  for (int j = (*tiles)[1]; j < (*tiles)[3]; ++j) {
    float* const tops = &this->Tops_[std::size_t(j) * Side];
    float* const lows = &this->Lows_[std::size_t(j) * Side];
    for (int i = (*tiles)[0]; i < (*tiles)[2]; ++i) {
      tops[i] = top > tops[i] ? top : tops[i];
      lows[i] = bottom < lows[i] ? bottom : lows[i];
    }
  }
  this->Hold(*tiles);
}

void CasterTiles::Hold(const std::array<int, 4>& tiles) {
  const auto& [left, bottom, right, top] = tiles;
  this->Tiles_ = {std::min(this->Tiles_[0], left), std::min(this->Tiles_[1], bottom),
                  std::max(this->Tiles_[2], right), std::max(this->Tiles_[3], top)};
}

void CasterTiles::Add(const LightPlace& place) {
  if (place.Anywhere()) {
    this->AddEverywhere();
  } else if (!this->InParts(place)) {
    this->Add(place.Whole());
  } else {
    for (const LightPlace::Part& part : place.Parts()) {
      this->Add(part.box);
    }
  }
}

void CasterTiles::AddEverywhere() {
  std::fill(this->Tops_.begin(), this->Tops_.end(), Everything);
  std::fill(this->Lows_.begin(), this->Lows_.end(), Nothing);
  this->Tiles_ = {0, 0, Side, Side};
}

bool CasterTiles::InParts(const LightPlace& place) const {
  constexpr int Few = 9; // tiles
  if (!place.HasParts()) {
    return false;
  }
  const auto tiles = this->TilesOf(place.Whole().box, Margin * this->Texel_);
  return tiles && ((*tiles)[2] - (*tiles)[0]) * ((*tiles)[3] - (*tiles)[1]) > Few;
}

bool CasterTiles::Shade(const LightPlace& place) const {
  if (place.Anywhere()) {
    return !this->Empty();
  }
  const auto tiles = this->TilesOf(place.Whole().box, 0.0);
  if (!tiles) {
    return false;
  }
  const double room = Below * this->Texel_;
  return this->AnyRow(place.Whole(), *tiles, 0.0,
                      [&](std::size_t row, int first, int end, const Line&, const Line& low) {
                        const float* const tops = &this->Tops_[row];
                        bool any = false; // no branch: many at once
                        for (int i = first; i < end; ++i) {
                          any |= double(tops[i]) >
                                 std::max(low.bound, low.start + low.step * i) - room;
                        }
                        return any;
                      });
}

bool CasterTiles::TakeShadows(const LightPlace& caster, double above) const {
  if (caster.Anywhere()) {
    return !this->Empty();
  }
  if (!this->TakeShadows(caster.Whole(), above)) {
    return false;
  }
  return !this->InParts(caster) || std::any_of(caster.Parts().begin(), caster.Parts().end(),
                                               [&](const LightPlace::Part& part) {
                                                 return this->TakeShadows(part.box, above);
                                               });
}

bool CasterTiles::TakeShadows(const Eigen::AlignedBox3d& box, double above) const {
  const auto tiles = this->TilesOf(box, 0.0);
  if (!tiles) {
    return false;
  }
  const double high = box.max().z() - (above - Below * this->Texel_);
  for (int j = (*tiles)[1]; j < (*tiles)[3]; ++j) {
    const float* const lows = &this->Lows_[std::size_t(j) * Side];
    for (int i = (*tiles)[0]; i < (*tiles)[2]; ++i) {
      if (double(lows[i]) < high) {
        return true;
      }
    }
  }
  return false;
}

bool CasterTiles::TakeShadows(const Extent& extent, double above) const {
  const auto tiles = this->TilesOf(extent.box, 0.0);
  if (!tiles) {
    return false;
  }
  const double lower = above - Below * this->Texel_;
  return this->AnyRow(
      extent, *tiles, 0.0, [&](std::size_t row, int first, int end, const Line& high, const Line&) {
        const float* const lows = &this->Lows_[row];
        bool any = false;
        for (int i = first; i < end; ++i) {
          any |= double(lows[i]) < std::min(high.bound, high.start + high.step * i) - lower;
        }
        return any;
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
                 const LightPlace& place) {
  const double nearest = place.Anywhere() ? 0.0 : place.GetDepths().nearest;
  for (std::size_t k = 0; k < tiles.size(); ++k) {
    if (nearest <= fit.cascades[k].end && tiles[k].Shade(place)) {
      return true;
    }
  }
  return false;
}

} // namespace dspace
