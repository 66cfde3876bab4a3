// Gradient noise over space, alone and in octaves: the same numbers on every machine.
#ifndef DSPACE_LAYERS_PERLINNOISE_H
#define DSPACE_LAYERS_PERLINNOISE_H

#include <array>
#include <cstdint>
#include <string>

#include <Eigen/Core>

namespace dspace {

// Improved gradient noise in three dimensions (K. Perlin, "Improving Noise", SIGGRAPH 2002), but
// without its period of 256: farther cells use the permutation at places of their own. 0 at points
// of whole coordinates, mean 0, twice differentiable.
class PerlinNoise {
public:
  using Permutation = std::array<std::uint8_t, 256>;
  // |At()| is no greater; reached near (0.5, 0.35, 0.4875) of a cell.
  static constexpr double Most = 1.0364;

  explicit PerlinNoise(std::uint32_t seed) : PerlinNoise(Shuffled(seed)) {}
  explicit PerlinNoise(const Permutation& table) : Table_(table) {}

  // `p` in cells. 0 beyond 2^52 cells, where a double has no place within one.
  double At(const Eigen::Vector3d& p) const;

  // 0..255 shuffled (Fisher and Yates, from the last down) by SplitMix64 that starts at `seed`.
  static Permutation Shuffled(std::uint32_t seed);

private:
  unsigned HashOf(std::int64_t i, std::int64_t j, std::int64_t k) const;

  Permutation Table_;
};

struct NoiseOptions {
  double wavelength = 10.0; // [m] of the longest octave, 1e-3 to 1e7
  int octaves = 6;          // 1 to 16; those shorter than two samples are left out
  double gain = 0.5;        // amplitude of an octave over that of the one before it, (0, 1]
  std::uint32_t seed = 0;

  bool operator==(const NoiseOptions& o) const {
    return this->wavelength == o.wavelength && this->octaves == o.octaves && this->gain == o.gain &&
           this->seed == o.seed;
  }
  // Throws Error(InvalidArgument) naming `object` and the value.
  void Check(const std::string& object) const;
};

// Octaves of halved wavelength, each a PerlinNoise of amplitude 1, gain, gain^2, ...
class OctaveNoise {
public:
  // Throws what NoiseOptions::Check throws, naming "noise".
  explicit OctaveNoise(const NoiseOptions& options);

  // At a point [m], for samples that are `spacing` [m] apart: an octave is whole from four samples
  // a wavelength on, left out up to two, and comes in smoothly between them. Within Most().
  double At(const Eigen::Vector3d& p, double spacing) const;
  // The sum of all gains.
  double Most() const { return this->Most_; }
  // Of the shortest octave [m].
  double ShortestWavelength() const;
  // Whether At() is 0 everywhere for samples so far apart.
  bool Silent(double spacing) const { return !(this->Options_.wavelength > 2.0 * spacing); }

private:
  NoiseOptions Options_;
  PerlinNoise Noise_;
  double Most_ = 0.0;
};

} // namespace dspace

#endif
