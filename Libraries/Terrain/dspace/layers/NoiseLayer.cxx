#include <dspace/layers/NoiseLayer.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

#include <dspace/Checks.h>

#include <dspace/layers/TexelSides.h>

namespace dspace {
namespace {

class NoiseLayer : public ColorLayer {
public:
  NoiseLayer(const NoiseOptions& options, double contrast)
      : Name_("noise of seed " + std::to_string(options.seed)), Noise_(options),
        Contrast_(contrast) {
    Require(contrast >= 0.0 && contrast <= 1.0, this->Name_, "its contrast", contrast, "0 to 1");
  }
  const std::string& GetName() const override { return this->Name_; }
  double PixelSize() const override { return 0.25 * this->Noise_.ShortestWavelength(); }
  const std::vector<std::string>& Warnings() const override { return this->Warnings_; }

  bool Read(const ColorGrid& grid, const ColorBlock& block, std::uint8_t* rgba) const override {
    const Eigen::Affine2d toPost = grid.TexelToPost(block.zoom);
    const TexelSides sides(grid, block.zoom);
    // In the first turn: a place is the same in every one, to the last bit.
    const std::int64_t around =
        grid.periodic ? grid.ColumnsAt(block.zoom) * ColorGrid::TileTexels : 0;
    bool some = false;
    std::vector<std::uint8_t> texels(std::size_t(4) * block.width * block.height, 0);
    for (int y = 0; y < block.height; ++y) {
      for (int x = 0; x < block.width; ++x) {
        std::int64_t column = block.column + x;
        if (around > 0) {
          column = ((column % around) + around) % around;
        }
        const Eigen::Vector2d post =
            toPost * Eigen::Vector2d(double(column) + 0.5, double(block.row + y) + 0.5);
        const double value =
            this->Noise_.At(grid.placement.ToScene(post, 0.0), sides.At(post).maxCoeff()) /
            this->Noise_.Most();
        const auto opacity =
            static_cast<std::uint8_t>(std::lround(255.0 * this->Contrast_ * std::abs(value)));
        if (opacity > 0) {
          std::uint8_t* texel = texels.data() + 4 * (std::size_t(y) * block.width + x);
          std::fill_n(texel, 3, value > 0.0 ? std::uint8_t(255) : std::uint8_t(0));
          texel[3] = opacity;
          some = true;
        }
      }
    }
    if (some) {
      std::copy(texels.begin(), texels.end(), rgba);
    }
    return some;
  }

private:
  std::string Name_;
  OctaveNoise Noise_;
  double Contrast_;
  std::vector<std::string> Warnings_;
};

} // namespace

std::shared_ptr<const ColorLayer> MakeNoiseLayer(const NoiseOptions& options, double contrast) {
  return std::make_shared<NoiseLayer>(options, contrast);
}

} // namespace dspace
