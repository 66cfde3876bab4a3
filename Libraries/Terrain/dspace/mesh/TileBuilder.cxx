#include <dspace/mesh/TileBuilder.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

namespace dspace {

namespace {

constexpr std::uint32_t None = std::numeric_limits<std::uint32_t>::max();

double Rounded(double value, double step) {
  return std::round(value / step) * step;
}

// FNV-1a, a word at a time.
struct Hash {
  std::uint64_t value = 14695981039346656037ull;
  void Mix(std::uint64_t word) {
    this->value = (this->value ^ word) * 1099511628211ull;
    this->value ^= this->value >> 32;
  }
};

} // namespace

HeightRange TileHeights(const HeightGrid& grid, int column, int row, int cells) {
  const int c0 = column * cells, r0 = row * cells;
  const int c1 = std::min(c0 + cells, grid.GetColumns() - 1);
  const int r1 = std::min(r0 + cells, grid.GetRows() - 1);
  HeightRange range{std::numeric_limits<double>::infinity(),
                    -std::numeric_limits<double>::infinity()};
  for (int r = r0; r <= r1; ++r)
    for (int c = c0; c <= c1; ++c)
      if (grid.HasPost(c, r)) {
        range.least = std::min(range.least, grid.At(c, r));
        range.greatest = std::max(range.greatest, grid.At(c, r));
      }
  return range.least <= range.greatest ? range : HeightRange{};
}

std::uint64_t TracksId(const GridTerrain& terrain, int column, int row, int cells) {
  const HeightGrid& grid = terrain.Grid();
  const int r0 = std::max(row * cells - 1, 0), c0 = std::max(column * cells - 1, 0);
  const int r1 = std::min((row + 1) * cells + 1, grid.GetRows() - 1);
  const int c1 = std::min((column + 1) * cells + 1, grid.GetColumns() - 1);
  Hash hash;
  bool any = false;
  for (int r = r0; r <= r1; ++r)
    for (int c = c0; c <= c1; ++c) {
      const float rolled = terrain.Rolled(c, r);
      if (rolled < 0.0f)
        continue;
      any = true;
      const double height = grid.At(c, r);
      std::uint64_t bits = 0;
      std::memcpy(&bits, &height, sizeof bits);
      hash.Mix(bits);
      std::uint32_t share = 0;
      std::memcpy(&share, &rolled, sizeof share);
      hash.Mix(share);
      hash.Mix(static_cast<std::uint64_t>(c) << 32 | static_cast<std::uint32_t>(r));
    }
  return !any ? 0 : hash.value == 0 ? 1 : hash.value;
}

std::uint64_t ContentId(int column, int row, const std::vector<MeshQuadtree::Leaf>& leaves,
                        std::uint64_t tracks) {
  if (leaves.empty())
    return 0;
  Hash hash;
  const auto mix = [&hash](std::uint64_t word) { hash.Mix(word); };
  mix(static_cast<std::uint64_t>(column) << 32 | static_cast<std::uint32_t>(row));
  for (const MeshQuadtree::Leaf& leaf : leaves) {
    mix(static_cast<std::uint64_t>(leaf.level) << 4 | leaf.fan);
    mix(static_cast<std::uint64_t>(leaf.c) << 32 | static_cast<std::uint32_t>(leaf.r));
  }
  if (tracks != 0)
    mix(tracks);
  return hash.value == 0 ? 1 : hash.value;
}

TileBuilder::TileBuilder(const GridTerrain& terrain, int column, int row, int cells, double stepXY,
                         double stepZ)
    : Terrain_(terrain), FirstC_(column * cells), FirstR_(row * cells), Side_(cells + 1),
      StepXY_(stepXY), StepZ_(stepZ),
      Mirrored_(terrain.Grid().GetGridToScene().linear().determinant() > 0.0),
      Index_(static_cast<std::size_t>(this->Side_) * this->Side_, None) {
  const HeightRange heights = TileHeights(terrain.Grid(), column, row, cells);
  const Eigen::Vector2d middle =
      terrain.Grid().ToScene({this->FirstC_ + 0.5 * cells, this->FirstR_ + 0.5 * cells});
  const double z = 0.5 * (heights.least + heights.greatest) - terrain.Frame().GetOriginHeight();
  this->Tile_.column = column;
  this->Tile_.row = row;
  this->Tile_.origin_S = {Rounded(middle.x(), stepXY), Rounded(middle.y(), stepXY),
                          Rounded(z, stepZ)};
}

std::uint32_t TileBuilder::Vertex(int c, int r) {
  std::uint32_t& index =
      this->Index_[static_cast<std::size_t>(r - this->FirstR_) * this->Side_ + (c - this->FirstC_)];
  if (index != None)
    return index;
  TerrainTile& tile = this->Tile_;
  const HeightGrid& grid = this->Terrain_.Grid();
  index = static_cast<std::uint32_t>(tile.VertexCount());
  const Eigen::Vector2d xy = grid.ToScene(Eigen::Vector2d(c, r));
  const Eigen::Vector3d p(
      Rounded(xy.x(), this->StepXY_), Rounded(xy.y(), this->StepXY_),
      Rounded(grid.At(c, r) - this->Terrain_.Frame().GetOriginHeight(), this->StepZ_));
  const Eigen::Vector3d n = grid.PostNormal(c, r);
  for (int k = 0; k < 3; ++k) {
    tile.positions.push_back(static_cast<float>(p[k] - tile.origin_S[k]));
    tile.normals.push_back(static_cast<float>(n[k]));
  }
  tile.tcoords.push_back(static_cast<float>((c + 0.5) / grid.GetColumns()));
  tile.tcoords.push_back(static_cast<float>(1.0 - (r + 0.5) / grid.GetRows()));
  tile.bounds_S.extend(p);
  this->Rolled_.push_back(this->Terrain_.Rolled(c, r));
  return index;
}

TerrainTile TileBuilder::Take() {
  if (std::any_of(this->Rolled_.begin(), this->Rolled_.end(), [](float r) { return r > 0.0f; })) {
    for (const float rolled : this->Rolled_)
      this->Tile_.rolled.push_back(std::max(rolled, 0.0f));
  }
  return std::move(this->Tile_);
}

void TileBuilder::Triangle(std::uint32_t a, std::uint32_t b, std::uint32_t c) {
  if (this->Mirrored_)
    std::swap(b, c);
  this->Tile_.indices.insert(this->Tile_.indices.end(), {a, b, c});
}

void TileBuilder::Add(const MeshQuadtree::Leaf& leaf) {
  const int n = 1 << leaf.level, c = leaf.c, r = leaf.r;
  if (!leaf.fan) {
    const HeightGrid& grid = this->Terrain_.Grid();
    if (leaf.level > 0 || grid.HasA(c, r))
      this->Triangle(this->Vertex(c, r), this->Vertex(c, r + n), this->Vertex(c + n, r + n));
    if (leaf.level > 0 || grid.HasB(c, r))
      this->Triangle(this->Vertex(c, r), this->Vertex(c + n, r + n), this->Vertex(c + n, r));
    return;
  }
  // Counter-clockwise from the north-west, with the middles that finer neighbours need.
  const int h = n / 2;
  std::vector<std::uint32_t> rim;
  rim.push_back(this->Vertex(c, r));
  if (leaf.fan & 1)
    rim.push_back(this->Vertex(c, r + h));
  rim.push_back(this->Vertex(c, r + n));
  if (leaf.fan & 2)
    rim.push_back(this->Vertex(c + h, r + n));
  rim.push_back(this->Vertex(c + n, r + n));
  if (leaf.fan & 4)
    rim.push_back(this->Vertex(c + n, r + h));
  rim.push_back(this->Vertex(c + n, r));
  if (leaf.fan & 8)
    rim.push_back(this->Vertex(c + h, r));
  const std::uint32_t middle = this->Vertex(c + h, r + h);
  for (std::size_t i = 0; i < rim.size(); ++i)
    this->Triangle(middle, rim[i], rim[(i + 1) % rim.size()]);
}

} // namespace dspace
