#include <dspace/layers/raster/ImageLayer.h>

#include <algorithm>
#include <cmath>

#include <dspace/layers/raster/BlockSampler.h>
#include <dspace/layers/raster/RasterPlacing.h>

namespace dspace {
namespace {

// Rounded, half up.
std::uint8_t ByteOf(float value) {
  return std::uint8_t(std::clamp(double(value) + 0.5, 0.0, 255.0));
}

class RasterImageLayer : public ColorLayer {
public:
  RasterImageLayer(std::shared_ptr<RasterLevels> levels, const PlacedRaster& placed)
      : Name_(levels->Object()), Channels_(levels->Channels()), PixelSize_(placed.pixelSize),
        Warnings_(levels->Warnings()), Sampler_(std::move(levels), placed.position) {}

  const std::string& GetName() const override { return this->Name_; }
  double PixelSize() const override { return this->PixelSize_; }
  const std::vector<std::string>& Warnings() const override { return this->Warnings_; }
  std::size_t KeptBytes() const override { return this->Sampler_.KeptBytes(); }

  bool Read(const ColorGrid& grid, const ColorBlock& block, std::uint8_t* rgba) const override {
    std::vector<float> texels;
    if (!this->Sampler_.Sample(grid, block, texels)) {
      return false;
    }
    const float* from = texels.data();
    for (std::size_t i = 0; i < std::size_t(block.width) * block.height; ++i) {
      const float opacity = from[this->Channels_];
      const std::uint8_t alpha = ByteOf(255.0f * opacity);
      for (int k = 0; k < 3; ++k) {
        const float color = alpha ? from[this->Channels_ == 1 ? 0 : k] / opacity : 0.0f;
        rgba[4 * i + k] = ByteOf(color);
      }
      rgba[4 * i + 3] = alpha;
      from += this->Channels_ + 1;
    }
    return true;
  }

private:
  std::string Name_;
  int Channels_;
  double PixelSize_;
  std::vector<std::string> Warnings_;
  BlockSampler Sampler_;
};

} // namespace

std::shared_ptr<const ColorLayer> OpenImageLayer(const std::string& path,
                                                 const RasterPlace& terrain,
                                                 const RasterLayerOptions& options) {
  auto levels = std::make_shared<RasterLevels>("image '" + path + "'", path, 0, options);
  const PlacedRaster placed = PlaceRaster(*levels, terrain, options);
  return std::make_shared<RasterImageLayer>(std::move(levels), placed);
}

} // namespace dspace
