// How surfaces reflect light: photometric models of airless ground, and the reference in double
// precision that the shaders follow (Shaders/Photometry.glsl).
#ifndef DSPACE_IMPORT_MODEL_REFLECTANCE_H
#define DSPACE_IMPORT_MODEL_REFLECTANCE_H

#include <array>
#include <optional>
#include <string>

namespace dspace {

// i is the angle of incidence, e that of emission, g the phase angle. All models but
// MetallicRoughness give a radiance factor: pi times the radiance, divided by the irradiance of a
// surface that faces the light. In linear light, where a light of intensity 1 stands for that
// irradiance, it is the value itself: a white Lambertian surface that faces such a light gives 1.
//
// The material's colour multiplies the radiance factor. For Lambert, Lommel-Seeliger and
// lunar-Lambert it is the normal albedo: the value at i = e = 0. For Hapke white leaves the
// parameters as they are. Metal and roughness of the material count in MetallicRoughness alone.
// Light from all directions (ambient, fill) is reflected by the plain colour.
struct Reflectance {
  enum class Model {
    MetallicRoughness, // of the material (glTF 2.0); without metal, of roughness 1: Lambert
    Lambert,           // cos i
    LommelSeeliger,    // 2 cos i / (cos i + cos e)
    LunarLambert,      // L 2 cos i / (cos i + cos e) + (1 - L) cos i (McEwen 1991, Icarus 92, 298)
    // Hapke (1993, 2012: Theory of Reflectance and Emittance Spectroscopy): shadow-hiding
    // opposition effect, isotropic multiple scattering with the H function of Hapke (2002, Icarus
    // 157, 523), macroscopic roughness (Hapke 1984, Icarus 59, 41). Without coherent backscatter
    // and porosity.
    Hapke
  };
  Model model = Model::MetallicRoughness;

  // LunarLambert: L, 0 to 1. Absent: that of the Moon by the phase angle in degrees, 1 - 0.019 g +
  // 0.242e-3 g^2 - 1.46e-6 g^3 (McEwen 1996, LPSC 27, 841), and 0 where that is negative (from 104
  // degrees on). Neither has a phase function: the colour is that of the phase angle.
  std::optional<double> lunarWeight;

  // Hapke. The defaults lie amid the values that are published for the Moon in red light (Sato et
  // al. 2014, JGR Planets 119, 1775); they belong to no place.
  double singleScatteringAlbedo = 0.3; // w, 0 to 1
  // Of the phase function, two lobes of Henyey and Greenstein: P(g) =
  // (1 + c) / 2 (1 - b^2) / (1 - 2 b cos g + b^2)^1.5 (backwards) +
  // (1 - c) / 2 (1 - b^2) / (1 + 2 b cos g + b^2)^1.5 (forwards).
  double phaseAsymmetry = 0.24;     // b, 0 to 0.99
  double phasePartition = 0.3;      // c, -1 to 1
  double oppositionAmplitude = 1.8; // B0, 0 to 100; B(g) = B0 / (1 + tan(g / 2) / h)
  double oppositionWidth = 0.07;    // h, 1e-6 to 100
  double roughness_deg = 23.4;      // theta bar, mean slope below the resolution, 0 to 60

  bool operator==(const Reflectance& o) const;
  bool operator!=(const Reflectance& o) const { return !(*this == o); }

  // Throws Error(InvalidArgument) naming `object`, the parameter and its value.
  void Check(const std::string& object) const;
};

// The radiance factor of a white surface. `cosI`, `cosE`: cosines of incidence and emission;
// `phase`: the phase angle [rad], 0 to pi. 0 where the light or the camera is below the surface.
// MetallicRoughness: that of Lambert.
double RadianceFactor(const Reflectance& reflectance, double cosI, double cosE, double phase);

// Parts of it. `phase` in radians.
double LunarWeight(const Reflectance& reflectance, double phase);
// Factors of the powers 0 to 3 of the phase angle in degrees; where their sum is below 0, it is 0.
std::array<double, 4> LunarWeightPowers(const Reflectance& reflectance);
double HapkePhaseFunction(const Reflectance& reflectance, double phase); // mean 1 over the sphere
double HapkeH(double singleScatteringAlbedo, double cosine); // within 1 % of Chandrasekhar's

} // namespace dspace

#endif
