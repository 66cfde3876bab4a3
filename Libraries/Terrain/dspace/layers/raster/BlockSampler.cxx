#include <dspace/layers/raster/BlockSampler.h>

#include <algorithm>
#include <cmath>
#include <optional>

#include <dspace/posts/PostLattice.h>

#include <dspace/crs/CrsTransform.h>
#include <dspace/layers/raster/SquareReader.h>

namespace dspace {
namespace {

constexpr int Side = TexelPlaces::Side;

// What holds all of them, if little else.
std::optional<LevelWindow> Together(const std::vector<const TexelSquare*>& squares) {
  LevelWindow all = squares.front()->window;
  double sum = 0.0;
  for (const TexelSquare* square : squares) {
    const LevelWindow& w = square->window;
    const int right = std::max(all.column + all.width, w.column + w.width);
    const int bottom = std::max(all.row + all.height, w.row + w.height);
    all.column = std::min(all.column, w.column);
    all.row = std::min(all.row, w.row);
    all.width = right - all.column;
    all.height = bottom - all.row;
    sum += double(w.width) * w.height;
  }
  if (double(all.width) * all.height > 1.5 * sum) {
    return std::nullopt;
  }
  return all;
}

} // namespace

PixelFinder::PixelFinder(const Crs& grid, const RasterPosition& raster)
    : MapToPixel_(raster.mapToPixel) {
  if (grid.Ogr() && raster.crs.Ogr() && grid.GetWkt() != raster.crs.GetWkt()) {
    this->Transform_ = std::make_unique<CrsTransform>(grid, raster.crs);
  }
}

void PixelFinder::Find(Eigen::Matrix2Xd& places) const {
  if (this->Transform_) {
    this->Transform_->TryApply(places);
  }
  for (Eigen::Index i = 0; i < places.cols(); ++i) {
    places.col(i) = this->MapToPixel_ * Eigen::Vector2d(places.col(i));
  }
}

BlockSampler::BlockSampler(std::shared_ptr<const RasterLevels> levels, RasterPosition raster)
    : Levels_(std::move(levels)), Raster_(std::move(raster)) {}

std::unique_ptr<PixelFinder> BlockSampler::AcquireFinder(const Crs& grid) const {
  {
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    const auto found = this->Finders_.find(grid.GetWkt());
    if (found != this->Finders_.end()) {
      std::unique_ptr<PixelFinder> finder = std::move(found->second);
      this->Finders_.erase(found);
      return finder;
    }
  }
  return std::make_unique<PixelFinder>(grid, this->Raster_);
}

void BlockSampler::ReleaseFinder(const Crs& grid, std::unique_ptr<PixelFinder> finder) const {
  const std::lock_guard<std::mutex> lock(this->Mutex_);
  this->Finders_.emplace(grid.GetWkt(), std::move(finder));
}

bool BlockSampler::Sample(const ColorGrid& grid, const ColorBlock& block,
                          std::vector<float>& texels) const {
  const int step = this->Levels_->Channels() + 1;
  const SquareReader reader(*this->Levels_, this->Raster_);
  std::unique_ptr<PixelFinder> finder = this->AcquireFinder(grid.crs);
  const std::int64_t around =
      grid.periodic ? grid.ColumnsAt(block.zoom) * (ColorGrid::TileTexels / Side) : 0;
  std::vector<std::unique_ptr<TexelSquare>> squares;
  std::map<std::pair<int, int>, std::vector<const TexelSquare*>> levels;
  for (std::int64_t row = FloorDiv(block.row, Side); row * Side < block.row + block.height; ++row) {
    for (std::int64_t column = FloorDiv(block.column, Side);
         column * Side < block.column + block.width; ++column) {
      const std::int64_t wrapped = around > 0 ? column - FloorDiv(column, around) * around : column;
      const int left = int(column * Side - block.column);
      const int top = int(row * Side - block.row);
      auto square = std::make_unique<TexelSquare>(TexelSquare{
          TexelPlaces(grid, block.zoom, wrapped * Side, row * Side, *finder, this->Raster_.turn),
          {std::max(0, -left), std::max(0, -top), std::min(Side, block.width - left),
           std::min(Side, block.height - top)},
          left,
          top,
          {}});
      if (reader.ChooseLevel(*square)) {
        squares.push_back(std::move(square));
      }
    }
  }
  this->ReleaseFinder(grid.crs, std::move(finder));
  if (squares.empty()) {
    return false;
  }
  for (const auto& square : squares) {
    levels[{square->window.levelX, square->window.levelY}].push_back(square.get());
  }
  texels.assign(std::size_t(block.width) * block.height * step, 0.0f);
  std::vector<float> cells;
  for (const auto& [level, group] : levels) {
    const std::optional<LevelWindow> together = Together(group);
    if (together) {
      reader.Read(*together, cells);
    }
    for (const TexelSquare* square : group) {
      if (!together) {
        reader.Read(square->window, cells);
      }
      reader.Sample(*square, together.value_or(square->window), cells, block, texels.data());
    }
  }
  for (std::size_t i = step - 1; i < texels.size(); i += step) {
    if (texels[i] > 0.0f) {
      return true;
    }
  }
  return false;
}

} // namespace dspace
