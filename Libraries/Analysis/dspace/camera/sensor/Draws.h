// Random numbers of one value of a sensor.
#ifndef DSPACE_CAMERA_SENSOR_DRAWS_H
#define DSPACE_CAMERA_SENSOR_DRAWS_H

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <cstdint>

#include <dspace/camera/sensor/Philox.h>

namespace dspace {

// The random numbers of one value: a counter of its own.
class Draws {
public:
  // x, y: which value; frame: which picture or scan; channel, 0 to 255: which of the values there.
  Draws(std::uint64_t seed, std::uint32_t x, std::uint32_t y, std::uint32_t frame,
        std::uint32_t channel)
      : Key_{std::uint32_t(seed), std::uint32_t(seed >> 32)}, Counter_{x, y, frame, channel << 24} {
  }

  double Next() { // uniform in (0, 1)
    if (this->Left_ == 0) {
      this->Block_ = Philox(this->Counter_, this->Key_);
      ++this->Counter_[3];
      this->Left_ = 2;
    }
    --this->Left_;
    return Uniform(this->Block_[std::size_t(2 * this->Left_)],
                   this->Block_[std::size_t(2 * this->Left_ + 1)]);
  }
  double Normal() { // Box and Muller
    const double radius = std::sqrt(-2.0 * std::log(this->Next()));
    return radius * std::cos(2.0 * M_PI * this->Next());
  }
  double Poisson(double mean) { // above a million its normal limit
    if (mean > NormalAbove) {
      return std::max(std::round(mean + std::sqrt(mean) * this->Normal()), 0.0);
    }
    return mean < RejectionAbove ? this->FewPoisson(mean) : this->ManyPoisson(mean);
  }

private:
  static constexpr double RejectionAbove = 10.0; // of a Poisson mean
  static constexpr double NormalAbove = 1e6;

  // Uniform in (0, 1), of 53 bits.
  static double Uniform(std::uint32_t high, std::uint32_t low) {
    const std::uint64_t bits = (std::uint64_t(high) << 32 | low) >> 11;
    return (double(bits) + 0.5) * 0x1p-53;
  }
  double FewPoisson(double mean) { // by multiplication (Knuth)
    double count = 0.0;
    const double end = std::exp(-mean);
    for (double product = this->Next(); product > end; product *= this->Next()) {
      count += 1.0;
    }
    return count;
  }
  // By transformed rejection. Source: W. Hoermann, "The transformed rejection method for generating
  // Poisson random variables", Insurance: Mathematics and Economics 12, 1993 (PTRS).
  double ManyPoisson(double mean) {
    const double b = 0.931 + 2.53 * std::sqrt(mean);
    const double a = -0.059 + 0.02483 * b;
    const double scale = 1.1239 + 1.1328 / (b - 3.4);
    const double sure = 0.9277 - 3.6224 / (b - 2.0);
    for (;;) {
      const double u = this->Next() - 0.5, v = this->Next();
      const double s = 0.5 - std::abs(u);
      const double k = std::floor((2.0 * a / s + b) * u + mean + 0.43);
      if (s >= 0.07 && v <= sure) {
        return k;
      }
      if (k < 0.0 || (s < 0.013 && v > s)) {
        continue;
      }
      if (std::log(v * scale / (a / (s * s) + b)) <=
          k * std::log(mean) - mean - std::lgamma(k + 1.0)) {
        return k;
      }
    }
  }

  std::array<std::uint32_t, 2> Key_;
  std::array<std::uint32_t, 4> Counter_;
  std::array<std::uint32_t, 4> Block_{};
  int Left_ = 0;
};

} // namespace dspace

#endif
