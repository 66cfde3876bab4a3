// Noise on the posts that a clipmap draws.
#include <dspace/clipmap/ClipmapLevels.h>

#include <cmath>

namespace dspace {

void ClipmapLevels::SetNoise(const std::optional<ClipmapStyle::Noise>& noise,
                             const PostPlacement& placement) {
  if (noise ? this->Noise_ && this->Noise_->noise == *noise : !this->Noise_) {
    return;
  }
  if (noise) {
    this->Noise_ = Roughening{*noise, OctaveNoise(noise->options), placement};
  } else {
    this->Noise_.reset();
  }
  for (Level& level : this->Levels_) {
    level.window.reset();
  }
}

// Each post by the noise at its own place: the same in whatever update it comes, in every turn.
void ClipmapLevels::Roughen(const PostBlock& block, std::vector<float>& heights) const {
  const PostLattice& lattice = this->Lattice();
  const Roughening& rough = *this->Noise_;
  for (int j = 0; j < block.height; ++j) {
    const auto row = double(lattice.RowPlace(block.level, block.row + j));
    for (int i = 0; i < block.width; ++i) {
      const std::int64_t c = lattice.Wrapped(block.level, block.column + i);
      const Eigen::Vector2d post(double(lattice.ColumnPlace(block.level, c)), row);
      const double spacing = std::ldexp(rough.placement.CellSize(post), block.level);
      if (rough.octaves.Silent(spacing)) {
        continue; // and in a hole NaN stays NaN
      }
      float& height = heights[std::size_t(j) * block.width + i];
      height = float(height + rough.noise.amplitude *
                                  rough.octaves.At(rough.placement.ToScene(post, 0.0), spacing));
    }
  }
}

} // namespace dspace
