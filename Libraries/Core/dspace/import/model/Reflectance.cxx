#include <dspace/import/model/Reflectance.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;

double LommelSeeliger(double cosI, double cosE) {
  return cosI / (cosI + cosE);
}

// Effective cosines and the shadowing function of a rough surface (Hapke 1984).
struct Roughness {
  double cosI;
  double cosE;
  double shadowing = 1.0;
};

Roughness RoughnessAt(double theta, double cosI, double cosE, double phase) {
  if (theta <= 0.0) {
    return {cosI, cosE};
  }
  const double sinI = std::sqrt(std::max(0.0, 1.0 - cosI * cosI));
  const double sinE = std::sqrt(std::max(0.0, 1.0 - cosE * cosE));
  // Of the azimuth between light and camera.
  double cosPsi = 1.0;
  if (sinI * sinE > 0.0) {
    cosPsi = std::clamp((std::cos(phase) - cosI * cosE) / (sinI * sinE), -1.0, 1.0);
  }
  const double psi = std::acos(cosPsi);
  const double half = 0.5 * (1.0 - cosPsi); // sin^2(psi / 2)
  const double tangent = std::tan(theta);
  const double chi = 1.0 / std::sqrt(1.0 + M_PI * tangent * tangent);
  const auto cotangents = [&](double cosine, double sine) {
    return sine > 0.0 ? cosine / (sine * tangent) : HUGE_VAL;
  };
  const double cotI = cotangents(cosI, sinI);
  const double cotE = cotangents(cosE, sinE);
  const double e1I = std::exp(-2.0 / M_PI * cotI);
  const double e1E = std::exp(-2.0 / M_PI * cotE);
  const double e2I = std::exp(-cotI * cotI / M_PI);
  const double e2E = std::exp(-cotE * cotE / M_PI);
  const double etaI = chi * (cosI + sinI * tangent * e2I / (2.0 - e1I));
  const double etaE = chi * (cosE + sinE * tangent * e2E / (2.0 - e1E));
  Roughness made{};
  double ratio = 0.0;
  if (cosI >= cosE) { // i <= e
    const double below = 2.0 - e1E - psi / M_PI * e1I;
    made.cosI = chi * (cosI + sinI * tangent * (cosPsi * e2E + half * e2I) / below);
    made.cosE = chi * (cosE + sinE * tangent * (e2E - half * e2I) / below);
    ratio = chi * cosI / etaI;
  } else {
    const double below = 2.0 - e1I - psi / M_PI * e1E;
    made.cosI = chi * (cosI + sinI * tangent * (e2I - half * e2E) / below);
    made.cosE = chi * (cosE + sinE * tangent * (cosPsi * e2I + half * e2E) / below);
    ratio = chi * cosE / etaE;
  }
  const double f = cosPsi > -1.0 ? std::exp(-2.0 * std::tan(0.5 * psi)) : 0.0;
  made.shadowing = made.cosE / etaE * cosI / etaI * chi / (1.0 - f + f * ratio);
  return made;
}

double Hapke(const Reflectance& r, double cosI, double cosE, double phase) {
  const double w = r.singleScatteringAlbedo;
  const Roughness rough = RoughnessAt(r.roughness_deg * Degree, cosI, cosE, phase);
  const double opposition =
      r.oppositionAmplitude / (1.0 + std::tan(0.5 * phase) / r.oppositionWidth);
  return 0.25 * w * LommelSeeliger(rough.cosI, rough.cosE) *
         ((1.0 + opposition) * HapkePhaseFunction(r, phase) +
          HapkeH(w, rough.cosI) * HapkeH(w, rough.cosE) - 1.0) *
         rough.shadowing;
}

} // namespace

bool Reflectance::operator==(const Reflectance& o) const {
  return this->model == o.model && this->lunarWeight == o.lunarWeight &&
         this->singleScatteringAlbedo == o.singleScatteringAlbedo &&
         this->phaseAsymmetry == o.phaseAsymmetry && this->phasePartition == o.phasePartition &&
         this->oppositionAmplitude == o.oppositionAmplitude &&
         this->oppositionWidth == o.oppositionWidth && this->roughness_deg == o.roughness_deg;
}

void Reflectance::Check(const std::string& object) const {
  const auto require = [&object](const char* what, double value, double low, double high,
                                 const char* accepted) {
    Require(value >= low && value <= high, object, what, value, accepted);
  };
  require("the lunar weight of its reflectance", this->lunarWeight.value_or(0.0), 0, 1, "0 to 1");
  require("the single-scattering albedo of its reflectance", this->singleScatteringAlbedo, 0, 1,
          "0 to 1");
  require("the phase asymmetry of its reflectance", this->phaseAsymmetry, 0, 0.99, "0 to 0.99");
  require("the phase partition of its reflectance", this->phasePartition, -1, 1, "-1 to 1");
  require("the opposition amplitude of its reflectance", this->oppositionAmplitude, 0, 100,
          "0 to 100");
  require("the opposition width of its reflectance", this->oppositionWidth, 1e-6, 100,
          "1e-6 to 100");
  require("the roughness of its reflectance", this->roughness_deg, 0, 60, "0 to 60 degrees");
}

double LunarWeight(const Reflectance& reflectance, double phase) {
  const std::array<double, 4> k = LunarWeightPowers(reflectance);
  const double g = phase / Degree;
  return std::max(0.0, k[0] + g * (k[1] + g * (k[2] + g * k[3])));
}

std::array<double, 4> LunarWeightPowers(const Reflectance& reflectance) {
  if (reflectance.lunarWeight) {
    return {*reflectance.lunarWeight, 0.0, 0.0, 0.0};
  }
  return {1.0, -0.019, 0.242e-3, -1.46e-6};
}

double HapkePhaseFunction(const Reflectance& reflectance, double phase) {
  const double b = reflectance.phaseAsymmetry;
  const double c = reflectance.phasePartition;
  const auto lobe = [&](double cosine) {
    return (1.0 - b * b) / std::pow(1.0 - 2.0 * b * cosine + b * b, 1.5);
  };
  return 0.5 * ((1.0 + c) * lobe(std::cos(phase)) + (1.0 - c) * lobe(-std::cos(phase)));
}

double HapkeH(double singleScatteringAlbedo, double cosine) {
  const double gamma = std::sqrt(1.0 - singleScatteringAlbedo);
  const double r0 = (1.0 - gamma) / (1.0 + gamma);
  const double x = cosine;
  if (x <= 0.0) {
    return 1.0;
  }
  return 1.0 / (1.0 - singleScatteringAlbedo * x *
                          (r0 + 0.5 * (1.0 - 2.0 * r0 * x) * std::log((1.0 + x) / x)));
}

double RadianceFactor(const Reflectance& reflectance, double cosI, double cosE, double phase) {
  if (cosI <= 0.0 || cosE < 0.0) {
    return 0.0;
  }
  switch (reflectance.model) {
  case Reflectance::Model::LommelSeeliger:
    return 2.0 * LommelSeeliger(cosI, cosE);
  case Reflectance::Model::LunarLambert: {
    const double weight = LunarWeight(reflectance, phase);
    return weight * 2.0 * LommelSeeliger(cosI, cosE) + (1.0 - weight) * cosI;
  }
  case Reflectance::Model::Hapke:
    return Hapke(reflectance, cosI, cosE, phase);
  default:
    return cosI;
  }
}

} // namespace dspace
