#include <dspace/layers/PerlinNoise.h>

#include <cmath>
#include <numeric>
#include <utility>

#include <dspace/Checks.h>

namespace dspace {
namespace {

// Towards the middles of a cube's edges; four of them twice, so that four bits choose one.
constexpr int Gradients[16][3] = {
    {1, 1, 0}, {-1, 1, 0}, {1, -1, 0}, {-1, -1, 0}, {1, 0, 1}, {-1, 0, 1}, {1, 0, -1}, {-1, 0, -1},
    {0, 1, 1}, {0, -1, 1}, {0, 1, -1}, {0, -1, -1}, {1, 1, 0}, {0, -1, 1}, {-1, 1, 0}, {0, -1, -1}};

// One step of SplitMix64 (Steele, Lea and Flood 2014) from the state `z` - the golden ratio's bits.
constexpr std::uint64_t Golden = 0x9e3779b97f4a7c15U;
std::uint64_t Mixed(std::uint64_t z) {
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9U;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebU;
  return z ^ (z >> 31);
}

// 0 to 1 with no slope and no curvature at either end.
double Fade(double t) {
  return t * t * t * (t * (t * 6.0 - 15.0) + 10.0);
}

double Mix(double a, double b, double t) {
  return a + t * (b - a);
}

} // namespace

PerlinNoise::Permutation PerlinNoise::Shuffled(std::uint32_t seed) {
  Permutation table;
  std::iota(table.begin(), table.end(), std::uint8_t(0));
  std::uint64_t state = seed;
  for (std::uint64_t i = 255; i > 0; --i) {
    state += Golden;
    const std::uint64_t j = ((Mixed(state) >> 32) * (i + 1)) >> 32; // 0 to i
    std::swap(table[i], table[j]);
  }
  return table;
}

unsigned PerlinNoise::HashOf(std::int64_t i, std::int64_t j, std::int64_t k) const {
  // Of the block of 256 cells a side: where it begins in the table. The first has none, so that it
  // is the noise as published.
  std::uint64_t shift = 0;
  if (((i | j | k) >> 8) != 0) {
    for (const std::int64_t block : {i >> 8, j >> 8, k >> 8}) {
      shift = Mixed(shift + Golden + static_cast<std::uint64_t>(block));
    }
  }
  const auto at = [this](std::uint64_t index) { return std::uint64_t(this->Table_[index & 255]); };
  const std::uint64_t a = at(static_cast<std::uint64_t>(i) + (shift & 255));
  const std::uint64_t b = at(a + static_cast<std::uint64_t>(j) + (shift >> 8 & 255));
  return unsigned(at(b + static_cast<std::uint64_t>(k) + (shift >> 16 & 255)));
}

double PerlinNoise::At(const Eigen::Vector3d& p) const {
  constexpr double Far = 4503599627370496.0; // 2^52
  if (!(p.cwiseAbs().maxCoeff() < Far)) {
    return 0.0;
  }
  const Eigen::Vector3d cell = p.array().floor();
  const Eigen::Vector3d f = p - cell;
  const auto i = static_cast<std::int64_t>(cell.x());
  const auto j = static_cast<std::int64_t>(cell.y());
  const auto k = static_cast<std::int64_t>(cell.z());
  double corners[8];
  for (int c = 0; c < 8; ++c) {
    const int dx = c & 1, dy = c >> 1 & 1, dz = c >> 2;
    const int* g = Gradients[this->HashOf(i + dx, j + dy, k + dz) & 15U];
    corners[c] = g[0] * (f.x() - dx) + g[1] * (f.y() - dy) + g[2] * (f.z() - dz);
  }
  const double u = Fade(f.x());
  const double v = Fade(f.y());
  const double near = Mix(Mix(corners[0], corners[1], u), Mix(corners[2], corners[3], u), v);
  const double far = Mix(Mix(corners[4], corners[5], u), Mix(corners[6], corners[7], u), v);
  return Mix(near, far, Fade(f.z()));
}

void NoiseOptions::Check(const std::string& object) const {
  Require(this->wavelength >= 1e-3 && this->wavelength <= 1e7, object,
          "the wavelength of its noise", this->wavelength, "1e-3 to 1e7 m");
  Require(this->octaves >= 1 && this->octaves <= 16, object, "the number of its noise's octaves",
          this->octaves, "1 to 16");
  Require(this->gain > 0.0 && this->gain <= 1.0, object, "the gain of its noise", this->gain,
          "more than 0, up to 1");
}

OctaveNoise::OctaveNoise(const NoiseOptions& options) : Options_(options), Noise_(options.seed) {
  options.Check("noise");
  for (int octave = 0; octave < options.octaves; ++octave) {
    this->Most_ += std::pow(options.gain, octave);
  }
}

double OctaveNoise::At(const Eigen::Vector3d& p, double spacing) const {
  double sum = 0.0;
  double amplitude = 1.0 / PerlinNoise::Most;
  double wavelength = this->Options_.wavelength;
  // Cells of no two octaves line up: all would be 0 at the same points.
  const Eigen::Vector3d apart(37.6180339887, 17.7548776662, 71.5698402910);
  for (int octave = 0; octave < this->Options_.octaves; ++octave) {
    const double samples = wavelength / spacing;
    if (!(samples > 2.0)) {
      break;
    }
    const double weight = samples < 4.0 ? Fade(std::log2(samples) - 1.0) : 1.0;
    sum += weight * amplitude * this->Noise_.At(p / wavelength + (octave + 1) * apart);
    amplitude *= this->Options_.gain;
    wavelength *= 0.5;
  }
  return sum;
}

double OctaveNoise::ShortestWavelength() const {
  return std::ldexp(this->Options_.wavelength, 1 - this->Options_.octaves);
}

} // namespace dspace
