#include <dspace/clipmap/ClipmapNoise.h>

#include <cmath>

namespace dspace {

ClipmapNoise::ClipmapNoise(const ClipmapStyle::Noise& noise, const PostPlacement& placement)
    : Noise_(noise), Octaves_(noise.options), Placement_(placement) {}

void ClipmapNoise::Roughen(const PostLattice& lattice, const PostBlock& block,
                           std::vector<float>& heights) const {
  for (int j = 0; j < block.height; ++j) {
    const auto row = double(lattice.RowPlace(block.level, block.row + j));
    for (int i = 0; i < block.width; ++i) {
      const std::int64_t c = lattice.Wrapped(block.level, block.column + i);
      const Eigen::Vector2d post(double(lattice.ColumnPlace(block.level, c)), row);
      const double spacing = std::ldexp(this->Placement_.CellSize(post), block.level);
      if (this->Octaves_.Silent(spacing)) {
        continue; // and in a hole NaN stays NaN
      }
      float& height = heights[std::size_t(j) * block.width + i];
      height = float(height + this->Noise_.amplitude *
                                  this->Octaves_.At(this->Placement_.ToScene(post, 0.0), spacing));
    }
  }
}

} // namespace dspace
