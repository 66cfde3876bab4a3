// Texels of layers of normals. Not for public headers.
#ifndef DSPACE_LAYERS_NORMALTEXELS_H
#define DSPACE_LAYERS_NORMALTEXELS_H

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstring>

#include <Eigen/Core>

namespace dspace {

// Four numbers of 16 bits, in the machine's order: a unit normal times opacity, then opacity. What
// lies between texels is linear, as a shader's texture filter makes it.
struct NormalTexel {
  static constexpr int Bytes = 8;
  static constexpr float Zero = 32768.0f;
  static constexpr float One = 32767.0f; // above Zero

  Eigen::Vector3f normal = Eigen::Vector3f::Zero(); // times opacity
  float opacity = 0.0f;

  // Lays another over it, with an opacity of its own.
  void Cover(const NormalTexel& over, float part) {
    const float rest = 1.0f - part * over.opacity;
    this->normal = rest * this->normal + part * over.normal;
    this->opacity = rest * this->opacity + part * over.opacity;
  }
  void Write(std::uint8_t* to) const {
    std::uint16_t numbers[4];
    for (int k = 0; k < 3; ++k) {
      numbers[k] =
          std::uint16_t(std::lround(Zero + One * std::clamp(this->normal[k], -1.0f, 1.0f)));
    }
    numbers[3] = std::uint16_t(std::lround(65535.0f * std::clamp(this->opacity, 0.0f, 1.0f)));
    std::memcpy(to, numbers, sizeof numbers);
  }
  static NormalTexel Read(const std::uint8_t* from) {
    std::uint16_t numbers[4];
    std::memcpy(numbers, from, sizeof numbers);
    NormalTexel texel;
    for (int k = 0; k < 3; ++k) {
      texel.normal[k] = (float(numbers[k]) - Zero) / One;
    }
    texel.opacity = float(numbers[3]) / 65535.0f;
    return texel;
  }
};

} // namespace dspace

#endif
