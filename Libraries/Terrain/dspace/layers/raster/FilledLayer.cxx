#include <dspace/layers/raster/FilledLayer.h>

#include <algorithm>
#include <cmath>

#include <dspace/Error.h>
#include <dspace/layers/raster/ImageLayer.h>

#include <dspace/layers/raster/BlockSampler.h>
#include <dspace/layers/raster/RasterPlacing.h>

namespace dspace {
namespace {

class HoleLayer : public ColorLayer {
public:
  HoleLayer(std::shared_ptr<RasterLevels> levels, const PlacedRaster& placed,
            const std::array<double, 3>& color, std::vector<std::unique_ptr<BlockSampler>> patches)
      : Name_(levels->Object()), PixelSize_(placed.pixelSize), Warnings_(levels->Warnings()),
        Holes_(std::move(levels), placed.position), Patches_(std::move(patches)) {
    for (int k = 0; k < 3; ++k) {
      this->Color_[std::size_t(k)] = std::uint8_t(std::lround(255.0 * color[std::size_t(k)]));
    }
  }

  const std::string& GetName() const override { return this->Name_; }
  double PixelSize() const override { return this->PixelSize_; }
  const std::vector<std::string>& Warnings() const override { return this->Warnings_; }
  std::size_t KeptBytes() const override {
    std::size_t bytes = this->Holes_.KeptBytes();
    for (const auto& patch : this->Patches_) {
      bytes += patch->KeptBytes();
    }
    return bytes;
  }

  bool Read(const ColorGrid& grid, const ColorBlock& block, std::uint8_t* rgba) const override {
    std::vector<float> holes;
    if (!this->Holes_.Sample(grid, block, holes)) {
      return false;
    }
    std::vector<float> covered;
    for (const auto& patch : this->Patches_) {
      if (patch->Sample(grid, block, covered)) {
        for (std::size_t i = 1; i < holes.size(); i += 2) {
          holes[i] *= 1.0f - std::min(covered[i], 1.0f);
        }
      }
    }
    for (std::size_t i = 0; i < std::size_t(block.width) * block.height; ++i) {
      rgba[4 * i + 3] = std::uint8_t(std::clamp(std::lround(255.0f * holes[2 * i + 1]), 0l, 255l));
      for (std::size_t k = 0; k < 3; ++k) {
        rgba[4 * i + k] = rgba[4 * i + 3] ? this->Color_[k] : 0;
      }
    }
    return true;
  }

private:
  std::string Name_;
  double PixelSize_;
  std::vector<std::string> Warnings_;
  std::array<std::uint8_t, 3> Color_ = {};
  BlockSampler Holes_;
  std::vector<std::unique_ptr<BlockSampler>> Patches_;
};

} // namespace

std::shared_ptr<const ColorLayer> OpenFilledLayer(const std::string& path, int band,
                                                  const RasterPlace& terrain,
                                                  const RasterWindow& window,
                                                  const FilledLayerOptions& options,
                                                  const std::vector<FilledLayerPatch>& patches) {
  const std::string object = "holes of raster '" + path + "'";
  for (const double part : options.color) {
    if (!(part >= 0.0 && part <= 1.0)) {
      throw Error(Error::Kind::InvalidArgument, object,
                  "its colour has " + std::to_string(part) + "; accepted is 0 to 1");
    }
  }
  RasterLayerOptions raster;
  raster.network = options.network;
  raster.cacheFolder = options.cacheFolder;
  auto levels =
      std::make_shared<RasterLevels>(object, path, std::max(1, band), raster, RasterShown::Holes);
  const PlacedRaster placed = PlaceRasterAt(
      *levels, terrain, terrain.crs,
      terrain.pixelToMap * Eigen::Translation2d(-double(window.column), -double(window.row)));
  std::vector<std::unique_ptr<BlockSampler>> covers;
  for (const FilledLayerPatch& patch : patches) {
    RasterLayerOptions own = raster;
    own.crs = patch.crs;
    auto cover = std::make_shared<RasterLevels>("patch '" + patch.path + "'", patch.path,
                                                std::max(1, patch.band), own);
    try {
      const PlacedRaster place = PlaceRaster(*cover, terrain, own);
      covers.push_back(std::make_unique<BlockSampler>(std::move(cover), place.position));
    } catch (const Error&) {
      // It adds nothing to the ground either; opening the terrain has reported a warning.
    }
  }
  return std::make_shared<HoleLayer>(std::move(levels), placed, options.color, std::move(covers));
}

} // namespace dspace
