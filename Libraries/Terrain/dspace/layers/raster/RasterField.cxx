#include <dspace/layers/raster/RasterField.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>
#include <mutex>
#include <utility>

#include <dspace/Error.h>
#include <dspace/layers/raster/BlockSampler.h>
#include <dspace/layers/raster/RasterPlacing.h>
#include <dspace/raster/LruCache.h>

namespace dspace {
namespace {

constexpr int TileSide = 128;            // pixels of a tile
constexpr int TileStored = 1 + TileSide; // with the first column and row of the next tiles
constexpr double NoValue = std::numeric_limits<double>::quiet_NaN();
using Tile = std::shared_ptr<const std::vector<double>>;
constexpr std::size_t TileBytes = sizeof(double) * TileStored * TileStored;

// A place in the raster: a pixel, and how far it is from its centre to those of its neighbours to
// the right and below.
struct Spot {
  std::int64_t tile = -1; // -1: outside
  int pixel = 0;          // of the tile's TileStored x TileStored
  double u = 0.0;
  double v = 0.0;
};

double Bilinear(const double* p, double u, double v) {
  const std::array<double, 4> values = {p[0], p[1], p[TileStored], p[TileStored + 1]};
  const std::array<double, 4> weights = {(1.0 - u) * (1.0 - v), u * (1.0 - v), (1.0 - u) * v,
                                         u * v};
  if (std::isnan(values[std::size_t(u < 0.5 ? 0 : 1) + std::size_t(v < 0.5 ? 0 : 2)])) {
    return NoValue;
  }
  double sum = 0.0;
  double all = 0.0;
  for (std::size_t i = 0; i < 4; ++i) {
    if (weights[i] > 0.0 && !std::isnan(values[i])) {
      sum += weights[i] * values[i];
      all += weights[i];
    }
  }
  return sum / all;
}

RasterLayerOptions Uncached(RasterLayerOptions options) {
  options.cacheFolder.clear();
  return options;
}

} // namespace

struct RasterField::Implementation {
  Implementation(const std::string& object, const std::string& path, const RasterPlace& terrain,
                 const RasterFieldOptions& options)
      : levels(object, path, options.band, Uncached(options.raster)),
        placed(PlaceRaster(this->levels, terrain, options.raster)), terrain(terrain.crs),
        nearest(options.nearest),
        units(options.units.empty() ? this->levels.Unit() : options.units),
        warnings(this->levels.Warnings()),
        most(std::max<std::size_t>(4, options.byteBudget / TileBytes)), tiles(this->most) {}

  std::unique_ptr<PixelFinder> AcquireFinder() {
    {
      const std::lock_guard<std::mutex> lock(this->mutex);
      if (!this->finders.empty()) {
        auto finder = std::move(this->finders.back());
        this->finders.pop_back();
        return finder;
      }
    }
    return std::make_unique<PixelFinder>(this->terrain, this->placed.position);
  }

  // In place: map places of the terrain to pixels.
  void Find(Eigen::Matrix2Xd& places) {
    std::unique_ptr<PixelFinder> finder = this->AcquireFinder();
    finder->Find(places);
    const std::lock_guard<std::mutex> lock(this->mutex);
    this->finders.push_back(std::move(finder));
  }

  std::int64_t TilesAcross() const { return (this->placed.position.width - 1) / TileSide + 1; }

  Spot SpotOf(const Eigen::Vector2d& pixel) const {
    const RasterPosition& raster = this->placed.position;
    double x = pixel.x();
    double y = pixel.y();
    Spot spot;
    if (!(y >= 0.0 && y <= raster.height) || !std::isfinite(x)) {
      return spot;
    }
    if (raster.turn > 0.0) {
      x -= raster.turn * std::round((x - 0.5 * raster.width) / raster.turn);
    }
    if (!raster.periodic && !(x >= 0.0 && x <= raster.width)) {
      return spot;
    }
    const double half = this->nearest ? 0.0 : 0.5;
    if (!raster.periodic) {
      x = std::clamp(x - half, 0.0, raster.width - 1.0 + (this->nearest ? 0.9 : 0.0));
    } else {
      x -= half;
    }
    y = std::clamp(y - half, 0.0, raster.height - 1.0 + (this->nearest ? 0.9 : 0.0));
    const double left = std::floor(x);
    const double top = std::floor(y);
    spot.u = x - left;
    spot.v = y - top;
    const int column = int(left - std::floor(left / raster.width) * raster.width);
    const int row = int(top);
    spot.tile = std::int64_t(row / TileSide) * this->TilesAcross() + column / TileSide;
    spot.pixel = row % TileSide * TileStored + column % TileSide;
    return spot;
  }

  Tile TileAt(std::int64_t key) {
    {
      const std::lock_guard<std::mutex> lock(this->mutex);
      if (const Tile* kept = this->tiles.Find(key)) {
        return *kept;
      }
    }
    Tile tile = this->ReadTile(int(key % this->TilesAcross()) * TileSide,
                               int(key / this->TilesAcross()) * TileSide);
    const std::lock_guard<std::mutex> lock(this->mutex);
    if (!this->tiles.Find(key)) {
      this->count = std::min(this->count + 1, this->most);
      this->tiles.Insert(key, tile);
    }
    return tile;
  }

  // With the column and the row after it; those of the edge are repeated, and around a body the
  // column after the last is the first.
  Tile ReadTile(int column, int row) const {
    const RasterPosition& raster = this->placed.position;
    const RasterWindow part{column, row, std::min(TileStored, raster.width - column),
                            std::min(TileStored, raster.height - row)};
    std::vector<double> pixels(std::size_t(part.width) * part.height);
    this->levels.ReadValues(part, pixels.data());
    std::vector<double> first;
    if (raster.periodic && part.width < TileStored) {
      first.resize(std::size_t(part.height));
      this->levels.ReadValues({0, row, 1, part.height}, first.data());
    }
    auto tile = std::make_shared<std::vector<double>>(std::size_t(TileStored) * TileStored);
    for (int y = 0; y < TileStored; ++y) {
      const auto from = std::size_t(std::min(y, part.height - 1));
      for (int x = 0; x < TileStored; ++x) {
        (*tile)[std::size_t(y) * TileStored + std::size_t(x)] =
            x >= part.width && !first.empty()
                ? first[from]
                : pixels[from * std::size_t(part.width) + std::size_t(std::min(x, part.width - 1))];
      }
    }
    return tile;
  }

  RasterLevels levels;
  PlacedRaster placed;
  Crs terrain;
  bool nearest;
  std::string units;
  std::vector<std::string> warnings;
  std::size_t most; // tiles
  std::mutex mutex; // of what follows
  std::vector<std::unique_ptr<PixelFinder>> finders;
  LruCache<std::int64_t, Tile> tiles;
  std::size_t count = 0; // of tiles in memory
};

RasterField::RasterField(const std::string& name, const std::string& path,
                         const RasterPlace& terrain, const RasterFieldOptions& options) {
  const std::string object = "field '" + name + "' (raster '" + path + "')";
  if (options.band < 1) {
    throw Error(Error::Kind::InvalidArgument, object,
                "band " + std::to_string(options.band) + " asked for; accepted are 1 and more");
  }
  this->Impl_ = std::make_unique<Implementation>(object, path, terrain, options);
}

RasterField::~RasterField() = default;

const std::string& RasterField::Units() const {
  return this->Impl_->units;
}

const Crs& RasterField::GetCrs() const {
  return this->Impl_->placed.position.crs;
}

double RasterField::PixelSize() const {
  return this->Impl_->placed.pixelSize;
}

bool RasterField::Nearest() const {
  return this->Impl_->nearest;
}

int RasterField::Columns() const {
  return this->Impl_->placed.position.width;
}

int RasterField::Rows() const {
  return this->Impl_->placed.position.height;
}

std::size_t RasterField::Bytes() const {
  const std::lock_guard<std::mutex> lock(this->Impl_->mutex);
  return this->Impl_->count * TileBytes;
}

const std::vector<std::string>& RasterField::Warnings() const {
  return this->Impl_->warnings;
}

// Places of one tile are taken together, so that each tile is read once.
Eigen::VectorXd RasterField::Values(const Eigen::Ref<const Eigen::Matrix2Xd>& map) const {
  Eigen::Matrix2Xd pixels = map;
  this->Impl_->Find(pixels);
  Eigen::VectorXd values = Eigen::VectorXd::Constant(map.cols(), NoValue);
  std::vector<Spot> spots(std::size_t(map.cols()));
  std::vector<std::pair<std::int64_t, std::size_t>> order;
  order.reserve(spots.size());
  for (std::size_t i = 0; i < spots.size(); ++i) {
    spots[i] = this->Impl_->SpotOf(pixels.col(Eigen::Index(i)));
    if (spots[i].tile >= 0) {
      order.emplace_back(spots[i].tile, i);
    }
  }
  if (!std::is_sorted(order.begin(), order.end())) {
    std::sort(order.begin(), order.end());
  }
  Tile tile;
  std::int64_t at = -1;
  for (const auto& [key, i] : order) {
    if (key != at) {
      tile = this->Impl_->TileAt(key);
      at = key;
    }
    const Spot& spot = spots[i];
    const double* p = tile->data() + spot.pixel;
    values[Eigen::Index(i)] = this->Impl_->nearest ? *p : Bilinear(p, spot.u, spot.v);
  }
  return values;
}

} // namespace dspace
