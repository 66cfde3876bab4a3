#include <dspace/scene/stars/StarColor.h>

#include <algorithm>
#include <cmath>

#include <Eigen/Core>

namespace dspace {
namespace {

constexpr double SunColorIndex = 0.653; // I. Ramirez et al., ApJ 752 (2012) 5

// A Gaussian with another width on each side of its mean.
double Lobe(double nm, double mean, double below, double above) {
  const double t = (nm - mean) * (nm < mean ? below : above);
  return std::exp(-0.5 * t * t);
}

Eigen::Vector3d MatchingFunctions(double nm) {
  return {1.056 * Lobe(nm, 599.8, 0.0264, 0.0323) + 0.362 * Lobe(nm, 442.0, 0.0624, 0.0374) -
              0.065 * Lobe(nm, 501.1, 0.0490, 0.0382),
          0.821 * Lobe(nm, 568.8, 0.0213, 0.0247) + 0.286 * Lobe(nm, 530.9, 0.0613, 0.0322),
          1.217 * Lobe(nm, 437.0, 0.0845, 0.0278) + 0.681 * Lobe(nm, 459.0, 0.0385, 0.0725)};
}

// Linear light of a black body, of any luminance.
Eigen::Vector3d BlackBody(double kelvin) {
  Eigen::Vector3d xyz = Eigen::Vector3d::Zero();
  for (double nm = 380.0; nm <= 780.0; nm += 5.0) {
    constexpr double SecondRadiation = 1.438776877e7; // h c / k [nm K]
    const double radiance =
        std::pow(nm / 560.0, -5.0) / (std::exp(SecondRadiation / (nm * kelvin)) - 1.0);
    xyz += radiance * MatchingFunctions(nm);
  }
  Eigen::Matrix3d linear; // IEC 61966-2-1
  linear << 3.2406255, -1.5372080, -0.4986286, -0.9689307, 1.8757561, 0.0415175, 0.0557101,
      -0.2040211, 1.0569959;
  return linear * xyz;
}

} // namespace

double StarTemperature(double colorIndex) {
  const double index = std::clamp(colorIndex, -0.4, 2.0);
  return 4600.0 * (1.0 / (0.92 * index + 1.7) + 1.0 / (0.92 * index + 0.62));
}

std::array<float, 3> StarColor(double colorIndex) {
  if (std::isnan(colorIndex)) {
    return {1.0f, 1.0f, 1.0f};
  }
  static const Eigen::Vector3d sun = BlackBody(StarTemperature(SunColorIndex));
  const Eigen::Vector3d relative =
      BlackBody(StarTemperature(colorIndex)).cwiseQuotient(sun).cwiseMax(0.0);
  const Eigen::Vector3d luminance(0.2126, 0.7152, 0.0722);
  const Eigen::Vector3f color = (relative / luminance.dot(relative)).cast<float>();
  return {color.x(), color.y(), color.z()};
}

} // namespace dspace
