#include <dspace/layers/LayerTiles.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dspace {
namespace {

constexpr int Side = ColorTiles::Side;
constexpr std::size_t Count = std::size_t(Side) * Side;
constexpr double Tiny = 1e-6; // of a texel

double Decoded(double v) {
  return v <= 0.04045 ? v / 12.92 : std::pow((v + 0.055) / 1.055, 2.4);
}

// Linear light of sRGB bytes (IEC 61966-2-1).
const std::array<float, 256>& LinearLight() {
  static const std::array<float, 256> table = [] {
    std::array<float, 256> light;
    for (std::size_t i = 0; i < light.size(); ++i) {
      light[i] = float(Decoded(double(i) / 255.0));
    }
    return light;
  }();
  return table;
}

// Of a tile's texels without its border, counted from its first: those with ground.
Eigen::AlignedBox2d GroundIn(const ColorGrid& grid, const ColorTile& tile) {
  const Eigen::Affine2d postToTexel = grid.TexelToPost(tile.zoom).inverse();
  const Eigen::Vector2d first =
      ColorGrid::TileTexels * Eigen::Vector2d(double(tile.column), double(tile.row));
  Eigen::AlignedBox2d ground;
  ground.extend(Eigen::Vector2d(postToTexel * grid.extent.min() - first));
  ground.extend(Eigen::Vector2d(postToTexel * grid.extent.max() - first));
  return ground;
}

} // namespace

bool HasGround(const ColorGrid& grid, const ColorTile& tile) {
  const Eigen::AlignedBox2d ground = GroundIn(grid, tile);
  constexpr double End = ColorGrid::TileTexels + 1.0;
  return ground.min().y() < End && ground.max().y() > -1.0 && tile.row >= 0 &&
         tile.row < grid.RowsAt(tile.zoom) &&
         (grid.periodic || (ground.min().x() < End && ground.max().x() > -1.0));
}

std::vector<std::uint8_t> ReadLayerTile(const ColorLayer& layer, const ColorGrid& grid,
                                        const ColorTile& tile) {
  const int bytes = TexelBytes(layer.Content());
  std::vector<std::uint8_t> rgba(Count * std::size_t(bytes));
  const ColorBlock block{tile.zoom, tile.column * ColorGrid::TileTexels - 1,
                         tile.row * ColorGrid::TileTexels - 1, Side, Side};
  if (!layer.Read(grid, block, rgba.data())) {
    return {};
  }
  const Eigen::AlignedBox2d ground = GroundIn(grid, tile);
  const auto texel = [&](int x, int y) {
    return rgba.begin() + bytes * (std::ptrdiff_t(y) * Side + x);
  };
  const auto copy = [&](int axis, double from, int to) { // a column or a row of the block
    if (from >= 0.0 && from < Side && to >= 0 && to < Side) {
      for (int i = 0; i < Side; ++i) {
        axis == 0 ? std::copy_n(texel(int(from), i), bytes, texel(to, i))
                  : std::copy_n(texel(i, int(from)), bytes, texel(i, to));
      }
    }
  };
  for (int axis = grid.periodic ? 1 : 0; axis < 2; ++axis) {
    const double first = std::floor(ground.min()[axis] + Tiny) + 1.0; // in the block
    const double last = std::ceil(ground.max()[axis] - Tiny);
    if (first >= 1.0 && first < Side) {
      copy(axis, first, int(first) - 1);
    }
    if (last >= 0.0 && last < Side - 1) {
      copy(axis, last, int(last) + 1);
    }
  }
  return rgba;
}

void TileComposer::Add(const std::vector<std::uint8_t>& rgba, double opacity) {
  if (rgba.empty()) {
    return;
  }
  const std::array<float, 256>& light = LinearLight();
  this->Sums_.resize(Count * 4, 0.0f);
  const auto part = float(opacity / 255.0);
  float* sum = this->Sums_.data();
  for (const std::uint8_t *p = rgba.data(), *end = p + Count * 4; p != end; p += 4, sum += 4) {
    if (p[3] == 0) {
      continue;
    }
    const float a = part * p[3];
    for (int k = 0; k < 3; ++k) {
      sum[k] += a * (light[p[k]] - sum[k]);
    }
    sum[3] += a * (1.0f - sum[3]);
  }
}

std::vector<std::uint8_t> TileComposer::Encode() const {
  std::vector<std::uint8_t> texels(this->Sums_.size());
  bool any = false;
  for (std::size_t i = 0; i < texels.size(); i += 4) {
    const float* const sum = &this->Sums_[i];
    const float opacity = std::clamp(sum[3], 0.0f, 1.0f);
    for (std::size_t k = 0; k < 3; ++k) {
      texels[i + k] =
          std::uint8_t(255.0f * std::sqrt(std::clamp(sum[k] * opacity, 0.0f, 1.0f)) + 0.5f);
    }
    texels[i + 3] = std::uint8_t(255.0f * opacity + 0.5f);
    any = any || texels[i + 3] != 0;
  }
  return any ? texels : std::vector<std::uint8_t>();
}

} // namespace dspace
