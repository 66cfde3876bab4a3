// A colour layer made of a formula, for tests: what every texel must be is known.
#ifndef DSPACE_TEST_FORMULALAYER_H
#define DSPACE_TEST_FORMULALAYER_H

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <string>
#include <vector>

#include <dspace/layers/ColorLayer.h>

namespace dspace::testing {

class FormulaLayer : public ColorLayer {
public:
  // sRGB and opacity, 0 to 1, of a place in the scene at height 0, as a zoom shows it.
  using Formula = std::function<std::array<double, 4>(const Eigen::Vector3d& place, int zoom)>;
  FormulaLayer(Formula formula, double pixel) : Formula_(std::move(formula)), Pixel_(pixel) {}

  const std::string& GetName() const override { return this->Name_; }
  bool Read(const ColorGrid& grid, const ColorBlock& block, std::uint8_t* rgba) const override {
    const Eigen::Affine2d toPost = grid.TexelToPost(block.zoom);
    for (int j = 0; j < block.height; ++j) {
      for (int i = 0; i < block.width; ++i) {
        const Eigen::Vector2d texel(double(block.column + i) + 0.5, double(block.row + j) + 0.5);
        const std::array<double, 4> color = this->Formula_(
            grid.placement.ToScene(Eigen::Vector2d(toPost * texel), 0.0), block.zoom);
        for (std::size_t k = 0; k < 4; ++k) {
          *rgba++ = std::uint8_t(std::clamp(255.0 * color[k] + 0.5, 0.0, 255.0));
        }
      }
    }
    return true;
  }
  double PixelSize() const override { return this->Pixel_; }
  const std::vector<std::string>& Warnings() const override { return this->Warnings_; }

private:
  std::string Name_ = "formula";
  std::vector<std::string> Warnings_;
  Formula Formula_;
  double Pixel_;
};

} // namespace dspace::testing

#endif
