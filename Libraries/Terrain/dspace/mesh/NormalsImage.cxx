#include <dspace/mesh/NormalsImage.h>

#include <algorithm>
#include <array>
#include <cmath>

#include <dspace/layers/NormalTexels.h>
#include <dspace/mesh/DrapeImage.h>

namespace dspace {
namespace {

constexpr int StripRows = 256; // that are composed at a time
constexpr float Zero = 128.0f; // of a byte, for a number from -1 to 1
constexpr float One = 127.0f;

// Posts are pixels, counted from the raster's corner; texels of zoom 0 are the image's.
ColorGrid GridOf(const GridTerrain& terrain, const std::array<int, 2>& size) {
  const Eigen::Vector2d raster(terrain.Grid().GetColumns(), terrain.Grid().GetRows());
  ColorGrid grid;
  grid.placement = PostPlacement::OnPlane(terrain.Frame().PostToScene(terrain.PixelToMap()) *
                                              Eigen::Translation2d(-0.5, -0.5),
                                          terrain.Frame().GetOriginHeight());
  grid.crs = terrain.GetCrs();
  grid.postToMap = terrain.PixelToMap();
  grid.rootPosts = ColorGrid::TileTexels * raster.cwiseQuotient(Eigen::Vector2d(size[0], size[1]));
  grid.extent = Eigen::AlignedBox2d(Eigen::Vector2d::Zero(), raster);
  return grid;
}

std::array<int, 2> SizeOf(const GridTerrain& terrain, double pixel, int maximumSize) {
  const int columns = terrain.Grid().GetColumns();
  const int rows = terrain.Grid().GetRows();
  const std::array<int, 2> most = DrapeSize(columns, rows, maximumSize); // rejects a bad maximum
  const Eigen::Matrix2d cell = terrain.Frame().PostToScene(terrain.PixelToMap()).linear();
  const double finer = std::max(1.0, cell.colwise().norm().minCoeff() / pixel);
  const double factor = std::min(finer, double(maximumSize) / std::max(columns, rows));
  return {std::max(most[0], int(std::lround(columns * factor))),
          std::max(most[1], int(std::lround(rows * factor)))};
}

} // namespace

std::shared_ptr<const Image>
NormalsImage(const GridTerrain& terrain, const std::vector<StackedLayer>& layers, int maximumSize) {
  const LayerChoice choice{LayerChoice::Part::Normals, {}};
  std::vector<StackedLayer> shown;
  std::copy_if(layers.begin(), layers.end(), std::back_inserter(shown),
               [&](const StackedLayer& layer) { return choice.Takes(layer); });
  if (shown.empty()) {
    return nullptr;
  }
  double pixel = shown.front().layer->PixelSize();
  for (const StackedLayer& layer : shown) {
    pixel = std::min(pixel, layer.layer->PixelSize());
  }
  const std::array<int, 2> size = SizeOf(terrain, pixel, maximumSize);
  const ColorGrid grid = GridOf(terrain, size);
  auto image = std::make_shared<Image>();
  image->name = terrain.GetName() + " normals";
  image->width = size[0];
  image->height = size[1];
  image->channels = 4;
  image->pixels.reserve(std::size_t(4) * size[0] * size[1]);
  std::vector<std::uint8_t> texels;
  for (int row = 0; row < size[1]; row += StripRows) {
    const int rows = std::min(StripRows, size[1] - row);
    const std::size_t count = std::size_t(size[0]) * rows;
    std::vector<NormalTexel> sums(count);
    texels.resize(count * NormalTexel::Bytes);
    for (const StackedLayer& layer : shown) {
      if (!layer.layer->Read(grid, {0, 0, row, size[0], rows}, texels.data())) {
        continue;
      }
      const auto part = float(layer.opacity);
      for (std::size_t i = 0; i < count; ++i) {
        sums[i].Cover(NormalTexel::Read(&texels[i * NormalTexel::Bytes]), part);
      }
    }
    for (const NormalTexel& sum : sums) {
      for (int k = 0; k < 3; ++k) {
        image->pixels.push_back(std::uint8_t(std::lround(Zero + One * sum.normal[k])));
      }
      image->pixels.push_back(std::uint8_t(std::lround(255.0f * sum.opacity)));
    }
  }
  return image;
}

} // namespace dspace
