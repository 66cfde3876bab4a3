#include <dspace/commands/terrain/ClipmapMesh.h>

#include <algorithm>
#include <cmath>
#include <cstring>

#include <dspace/scene/LinearLight.h>

namespace dspace::session {
namespace {

constexpr int BlockCells = 256;  // a side of a part
constexpr int MostTexels = 4096; // a side of the image

std::uint64_t TrianglesOf(const PostLattice& lattice, int level) {
  const std::int64_t columns = lattice.ColumnsAt(level) - (lattice.periodic ? 0 : 1);
  return 2 * std::uint64_t(columns) * std::uint64_t(lattice.RowsAt(level) - 1);
}

int LevelWithin(const PostLattice& lattice, std::size_t triangleBudget) {
  int level = 0;
  while (level + 1 < lattice.levels && TrianglesOf(lattice, level) > triangleBudget) {
    ++level;
  }
  return level;
}

// Where the image lies, in level-0 posts: it reaches from `first` to `first + size`.
struct Extent {
  Eigen::Vector2d first;
  Eigen::Vector2d size;
};

Eigen::Vector3d MaterialColor(const Material& material, const Eigen::Vector2d& uv) {
  const auto own = LinearColor(material.color);
  Eigen::Vector3d color(own[0], own[1], own[2]);
  if (material.texture) {
    const Image& image = *material.texture;
    const auto at = [](double f, int n) { return std::clamp(int(std::floor(f * n)), 0, n - 1); };
    const std::size_t texel =
        std::size_t(at(1.0 - uv.y(), image.height)) * std::size_t(image.width) +
        std::size_t(at(uv.x(), image.width));
    const std::uint8_t* p = &image.pixels[texel * std::size_t(image.channels)];
    for (int k = 0; k < 3; ++k) {
      color[k] *= LinearFromSrgb(p[image.channels < 3 ? 0 : k] / 255.0);
    }
  }
  return color;
}

std::uint8_t SrgbByte(double linear) {
  const double s = linear <= 0.0031308 ? 12.92 * linear : 1.055 * std::pow(linear, 1 / 2.4) - 0.055;
  return std::uint8_t(std::lround(255.0 * std::clamp(s, 0.0, 1.0)));
}

// The composed tiles of one zoom that cover a window of texels.
class LayerTexels {
public:
  LayerTexels(const ClipmapTerrain& terrain, int zoom, std::int64_t column, std::int64_t row,
              int width, int height)
      : First_(FloorDiv(column, Tile), FloorDiv(row, Tile)),
        Columns_(int(FloorDiv(column + width - 1, Tile) - First_.x()) + 1) {
    std::vector<ColorTile> wanted;
    const std::int64_t lastRow = FloorDiv(row + height - 1, Tile);
    for (std::int64_t r = this->First_.y(); r <= lastRow; ++r) {
      for (int c = 0; c < this->Columns_; ++c) {
        wanted.push_back({0, zoom, this->First_.x() + c, r});
      }
    }
    this->Tiles_ = terrain.Tiles().Get(wanted, terrain.Options().deadline);
  }

  // Colour in linear light times opacity, and opacity.
  Eigen::Vector4d At(std::int64_t column, std::int64_t row) const {
    const std::int64_t c = FloorDiv(column, Tile);
    const std::int64_t r = FloorDiv(row, Tile);
    const auto& tile =
        this->Tiles_[std::size_t((r - this->First_.y()) * this->Columns_ + (c - this->First_.x()))];
    if (!tile || tile->texels.empty()) {
      return Eigen::Vector4d::Zero();
    }
    const std::int64_t x = column - c * Tile + 1; // a texel of border
    const std::int64_t y = row - r * Tile + 1;
    const std::uint8_t* p = &tile->texels[std::size_t(4 * (y * ColorTiles::Side + x))];
    const double opacity = p[3] / 255.0;
    Eigen::Vector4d made(0.0, 0.0, 0.0, opacity);
    for (int k = 0; k < 3 && opacity > 0.0; ++k) {
      made[k] = std::min(p[k] / 255.0 * (p[k] / 255.0) / opacity, opacity);
    }
    return made;
  }

private:
  static constexpr std::int64_t Tile = ColorGrid::TileTexels;
  Eigen::Matrix<std::int64_t, 2, 1> First_;
  int Columns_;
  std::vector<ColorTiles::TilePointer> Tiles_;
};

// The material's texture under the layers. Sets `extent` to what it covers.
std::shared_ptr<const Image> Painted(const ClipmapTerrain& terrain, const Material& material,
                                     Extent& extent) {
  const ColorGrid& grid = terrain.Grids()[0];
  const PostLattice& lattice = terrain.Pyramid()->Lattice();
  const double last = double(lattice.columns - (lattice.periodic ? 0 : 1));
  int zoom = std::min(grid.ZoomFor(terrain.Layers()->PixelSize()), ColorGrid::MaximumZoom);
  Eigen::Array2d first;
  Eigen::Array2d end;
  while (true) {
    const Eigen::Affine2d postToTexel = grid.TexelToPost(zoom).inverse();
    const Eigen::Array2d a = postToTexel * Eigen::Vector2d(0.0, 0.0);
    const Eigen::Array2d b = postToTexel * Eigen::Vector2d(last, double(lattice.rows - 1));
    first = a.min(b).floor();
    end = a.max(b).ceil();
    if (zoom == 0 || (end - first).maxCoeff() <= MostTexels) {
      break;
    }
    --zoom;
  }
  const auto column = std::int64_t(first.x());
  const auto row = std::int64_t(first.y());
  const int width = int(end.x() - first.x());
  const int height = int(end.y() - first.y());
  const LayerTexels layers(terrain, zoom, column, row, width, height);
  const Eigen::Affine2d texelToPost = grid.TexelToPost(zoom);
  auto image = std::make_shared<Image>();
  image->name = "terrain";
  image->width = width;
  image->height = height;
  image->channels = 3;
  image->pixels.resize(std::size_t(width) * std::size_t(height) * 3);
  for (int y = 0; y < height; ++y) {
    for (int x = 0; x < width; ++x) {
      const Eigen::Vector2d post =
          texelToPost * Eigen::Vector2d(double(column + x) + 0.5, double(row + y) + 0.5);
      const Eigen::Vector4d over = layers.At(column + x, row + y);
      const Eigen::Vector3d under = MaterialColor(material, terrain.Options().postToTexture * post);
      for (int k = 0; k < 3; ++k) {
        image->pixels[3 * (std::size_t(y) * std::size_t(width) + std::size_t(x)) + std::size_t(k)] =
            SrgbByte(over[k] + (1.0 - over[3]) * under[k]);
      }
    }
  }
  const Eigen::Vector2d from = texelToPost * Eigen::Vector2d(double(column), double(row));
  const Eigen::Vector2d to =
      texelToPost * Eigen::Vector2d(double(column + width), double(row + height));
  extent = {from, to - from};
  return image;
}

class MeshMaker {
public:
  MeshMaker(const ClipmapTerrain& terrain, std::size_t triangleBudget)
      : Terrain_(terrain), Lattice_(terrain.Pyramid()->Lattice()),
        Level_(LevelWithin(Lattice_, triangleBudget)) {
    auto material = std::make_shared<Material>(
        terrain.Options().material ? *terrain.Options().material : Material());
    this->PostToTexture_ = terrain.Options().postToTexture;
    if (terrain.Layers() && !terrain.Layers()->Empty()) {
      Extent extent;
      material->texture = Painted(terrain, *material, extent);
      material->color = {1.0, 1.0, 1.0}; // it is in the image
      material->repeatTexture = false;
      // v = 0 is the bottom row of the image, whose top row is the first.
      this->PostToTexture_ = Eigen::Translation2d(0.0, 1.0) * Eigen::Scaling(1.0, -1.0) *
                             Eigen::Scaling(1.0 / extent.size.x(), 1.0 / extent.size.y()) *
                             Eigen::Translation2d(-extent.first);
    }
    this->Textured_ = material->texture != nullptr;
    this->Material_ = std::move(material);
  }

  std::vector<Part> Run() const {
    const std::int64_t columns =
        this->Lattice_.ColumnsAt(this->Level_) - (this->Lattice_.periodic ? 0 : 1); // cells
    const std::int64_t rows = this->Lattice_.RowsAt(this->Level_) - 1;
    std::vector<Part> parts;
    for (std::int64_t r = 0; r < rows; r += BlockCells) {
      for (std::int64_t c = 0; c < columns; c += BlockCells) {
        Part part = this->Block(c, r, int(std::min<std::int64_t>(BlockCells, columns - c)),
                                int(std::min<std::int64_t>(BlockCells, rows - r)));
        if (!part.mesh->indices.empty()) {
          parts.push_back(std::move(part));
        }
      }
    }
    return parts;
  }

private:
  Eigen::Vector2d PostAt(std::int64_t column, std::int64_t row) const {
    return {double(this->Lattice_.ColumnPlace(this->Level_, column)),
            double(this->Lattice_.RowPlace(this->Level_, row))};
  }

  Part Block(std::int64_t column, std::int64_t row, int columns, int rows) const {
    // With a post more on every side, for the normals.
    const int width = columns + 3;
    const int height = rows + 3;
    std::vector<float> heights(std::size_t(width) * std::size_t(height));
    this->Terrain_.Pyramid()->Read({this->Level_, column - 1, row - 1, width, height},
                                   heights.data(), this->Terrain_.Options().deadline);
    std::vector<Eigen::Vector3d> places(heights.size());
    for (int y = 0; y < height; ++y) {
      for (int x = 0; x < width; ++x) {
        const std::size_t i = std::size_t(y) * std::size_t(width) + std::size_t(x);
        places[i] = this->Terrain_.Placement().ToScene(this->PostAt(column - 1 + x, row - 1 + y),
                                                       heights[i]);
      }
    }
    const auto at = [&](int x, int y) -> const Eigen::Vector3d& {
      return places[std::size_t(y + 1) * std::size_t(width) + std::size_t(x + 1)];
    };
    const auto good = [&](int x, int y) { return at(x, y).allFinite(); };

    auto mesh = std::make_shared<Mesh>();
    mesh->name = "ground " + std::to_string(column) + ", " + std::to_string(row);
    Eigen::Vector3d origin = Eigen::Vector3d::Zero();
    bool found = false;
    std::vector<std::uint32_t> indexOf(std::size_t(columns + 1) * std::size_t(rows + 1));
    for (int y = 0; y <= rows; ++y) {
      for (int x = 0; x <= columns; ++x) {
        if (!good(x, y)) {
          continue;
        }
        if (!found) {
          origin = at(x, y).array().round();
          found = true;
        }
        indexOf[std::size_t(y) * std::size_t(columns + 1) + std::size_t(x)] =
            std::uint32_t(mesh->VertexCount());
        const Eigen::Vector3d p = at(x, y) - origin;
        const Eigen::Vector3d n = this->Normal(at, good, x, y);
        for (int k = 0; k < 3; ++k) {
          mesh->positions.push_back(float(p[k]));
          mesh->normals.push_back(float(n[k]));
        }
        if (this->Textured_) {
          const Eigen::Vector2d uv = this->PostToTexture_ * this->PostAt(column + x, row + y);
          mesh->tcoords.push_back(float(uv.x()));
          mesh->tcoords.push_back(float(uv.y()));
        }
      }
    }
    const auto add = [&](std::array<std::array<int, 2>, 3> corners) {
      if (!good(corners[0][0], corners[0][1]) || !good(corners[1][0], corners[1][1]) ||
          !good(corners[2][0], corners[2][1])) {
        return;
      }
      const Eigen::Vector3d& a = at(corners[0][0], corners[0][1]);
      const Eigen::Vector3d n =
          (at(corners[1][0], corners[1][1]) - a).cross(at(corners[2][0], corners[2][1]) - a);
      if (n.dot(this->Terrain_.Placement().Up(a)) < 0.0) {
        std::swap(corners[1], corners[2]); // counter-clockwise seen from above
      }
      for (const auto& corner : corners) {
        mesh->indices.push_back(
            indexOf[std::size_t(corner[1]) * std::size_t(columns + 1) + std::size_t(corner[0])]);
      }
    };
    for (int y = 0; y < rows; ++y) {
      for (int x = 0; x < columns; ++x) {
        add({{{x, y}, {x, y + 1}, {x + 1, y + 1}}}); // the diagonal of HeightGrid
        add({{{x, y}, {x + 1, y + 1}, {x + 1, y}}});
      }
    }
    Part part;
    part.mesh = std::move(mesh);
    part.material = this->Material_;
    part.X_OP = Eigen::Affine3d(Eigen::Translation3d(origin));
    return part;
  }

  // Of the plane through the neighbours, upward.
  template<class At, class Good>
  Eigen::Vector3d Normal(const At& at, const Good& good, int x, int y) const {
    const auto along = [&](int dx, int dy) -> Eigen::Vector3d {
      const bool before = good(x - dx, y - dy);
      const bool after = good(x + dx, y + dy);
      return (after ? at(x + dx, y + dy) : at(x, y)) - (before ? at(x - dx, y - dy) : at(x, y));
    };
    const Eigen::Vector3d up = this->Terrain_.Placement().Up(at(x, y));
    const Eigen::Vector3d n = along(1, 0).cross(along(0, 1));
    const double length = n.norm();
    if (!(length > 0.0)) {
      return up; // alone, or at a pole
    }
    return n.dot(up) < 0.0 ? Eigen::Vector3d(-n / length) : Eigen::Vector3d(n / length);
  }

  const ClipmapTerrain& Terrain_;
  const PostLattice& Lattice_;
  int Level_;
  std::shared_ptr<const Material> Material_;
  bool Textured_ = false;
  Eigen::Affine2d PostToTexture_ = Eigen::Affine2d::Identity();
};

} // namespace

std::vector<Part> ClipmapMesh(const ClipmapTerrain& terrain, std::size_t triangleBudget) {
  return MeshMaker(terrain, triangleBudget).Run();
}

} // namespace dspace::session
