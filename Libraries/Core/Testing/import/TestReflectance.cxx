// Photometric models against published values, closed forms and reciprocity.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <vector>

#include <dspace/Error.h>
#include <dspace/import/model/Reflectance.h>

namespace dspace {
namespace {

using Law = Reflectance::Model;

Reflectance Of(Law model) {
  Reflectance made;
  made.model = model;
  return made;
}

// Angles in degrees.
double Factor(const Reflectance& reflectance, double i, double e, double g) {
  return RadianceFactor(reflectance, std::cos(i * M_PI / 180), std::cos(e * M_PI / 180),
                        g * M_PI / 180);
}

// Points and weights of Gauss and Legendre on 0 to 1, by Newton's method.
void GaussLegendre(int n, std::vector<double>& x, std::vector<double>& w) {
  for (int k = 0; k < n; ++k) {
    double z = std::cos(M_PI * (k + 0.75) / (n + 0.5));
    double derivative = 0.0;
    for (int turn = 0; turn < 100; ++turn) {
      double p0 = 1.0;
      double p1 = z;
      for (int j = 2; j <= n; ++j) {
        const double p2 = ((2 * j - 1) * z * p1 - (j - 1) * p0) / j;
        p0 = p1;
        p1 = p2;
      }
      derivative = n * (z * p1 - p0) / (z * z - 1);
      z -= p1 / derivative;
    }
    x.push_back(0.5 * (1 - z));
    w.push_back(1 / ((1 - z * z) * derivative * derivative));
  }
}

// Chandrasekhar's H function for isotropic scattering, from its integral equation.
double ExactH(double albedo, double cosine) {
  std::vector<double> x;
  std::vector<double> weights;
  GaussLegendre(64, x, weights);
  std::vector<double> h(x.size(), 1.0);
  const auto next = [&](double mu) {
    double sum = 0.0;
    for (std::size_t k = 0; k < x.size(); ++k) {
      sum += weights[k] * h[k] * x[k] / (mu + x[k]);
    }
    return 1.0 / (std::sqrt(1.0 - albedo) + 0.5 * albedo * sum);
  };
  for (int turn = 0; turn < 2000; ++turn) {
    std::vector<double> made;
    for (const double mu : x) {
      made.push_back(next(mu));
    }
    for (std::size_t k = 0; k < x.size(); ++k) {
      h[k] = 0.5 * (h[k] + made[k]);
    }
  }
  return next(cosine);
}

} // namespace

TEST(Reflectance, AWhiteSurfaceThatFacesLightAndCameraShowsOne) {
  EXPECT_DOUBLE_EQ(Factor(Of(Law::Lambert), 0, 0, 0), 1.0);
  EXPECT_DOUBLE_EQ(Factor(Of(Law::LommelSeeliger), 0, 0, 0), 1.0);
  EXPECT_DOUBLE_EQ(Factor(Of(Law::LunarLambert), 0, 0, 0), 1.0);
  EXPECT_DOUBLE_EQ(Factor(Of(Law::MetallicRoughness), 60, 20, 70), 0.5000000000000001);
}

TEST(Reflectance, NothingComesFromBelowTheSurface) {
  for (const Law model : {Law::Lambert, Law::LommelSeeliger, Law::LunarLambert, Law::Hapke}) {
    EXPECT_EQ(Factor(Of(model), 91, 10, 90), 0.0);
    EXPECT_EQ(Factor(Of(model), 10, 91, 90), 0.0);
    EXPECT_GT(Factor(Of(model), 89, 89, 30), 0.0);
  }
}

TEST(Reflectance, LommelSeeligerAndLunarLambertAreTheirFormulas) {
  EXPECT_NEAR(Factor(Of(Law::LommelSeeliger), 60, 0, 60), 2.0 * 0.5 / 1.5, 1e-15);
  Reflectance lunar = Of(Law::LunarLambert);
  // 1 - 0.019 g + 0.242e-3 g^2 - 1.46e-6 g^3 by hand (McEwen 1996).
  const double weights[][2] = {{0, 1.0}, {30, 0.60838}, {60, 0.41584}, {90, 0.18586}, {120, 0.0}};
  for (const auto& [g, weight] : weights) {
    EXPECT_NEAR(LunarWeight(lunar, g * M_PI / 180), weight, 1e-12) << g;
  }
  EXPECT_NEAR(Factor(lunar, 60, 0, 60), 0.41584 * 2.0 / 3.0 + 0.58416 * 0.5, 1e-12);
  lunar.lunarWeight = 1.0;
  EXPECT_DOUBLE_EQ(Factor(lunar, 50, 20, 60), Factor(Of(Law::LommelSeeliger), 50, 20, 60));
  lunar.lunarWeight = 0.0;
  EXPECT_DOUBLE_EQ(Factor(lunar, 50, 20, 60), Factor(Of(Law::Lambert), 50, 20, 60));
}

TEST(Reflectance, AllModelsAreReciprocal) {
  for (const Law model : {Law::Lambert, Law::LommelSeeliger, Law::LunarLambert, Law::Hapke}) {
    for (const double i : {5.0, 30.0, 62.0, 85.0}) {
      for (const double e : {0.5, 30.0, 71.0, 88.0}) {
        for (const double part : {0.05, 0.5, 0.95}) { // of the phase angles that i and e allow
          const double g = std::abs(i - e) + part * (i + e - std::abs(i - e));
          const double there = Factor(Of(model), i, e, g) / std::cos(i * M_PI / 180);
          const double back = Factor(Of(model), e, i, g) / std::cos(e * M_PI / 180);
          EXPECT_NEAR(there / back, 1.0, 1e-9) << int(model) << " " << i << " " << e << " " << g;
        }
      }
    }
  }
}

TEST(Reflectance, ThePhaseFunctionHasTheMeanOneAndLobesWhereItsParametersSay) {
  Reflectance hapke = Of(Law::Hapke);
  for (const double b : {0.0, 0.24, 0.6}) {
    for (const double c : {-1.0, 0.3, 1.0}) {
      hapke.phaseAsymmetry = b;
      hapke.phasePartition = c;
      double mean = 0.0;
      const int steps = 20000;
      for (int k = 0; k < steps; ++k) {
        const double g = M_PI * (k + 0.5) / steps;
        mean += 0.5 * HapkePhaseFunction(hapke, g) * std::sin(g) * M_PI / steps;
      }
      EXPECT_NEAR(mean, 1.0, 1e-6) << b << " " << c;
    }
  }
  hapke.phaseAsymmetry = 0.5;
  hapke.phasePartition = 1.0; // backwards: (1 - b^2) / (1 - b)^3
  EXPECT_NEAR(HapkePhaseFunction(hapke, 0.0), 6.0, 1e-12);
  EXPECT_NEAR(HapkePhaseFunction(hapke, M_PI), 0.75 / 3.375, 1e-12);
}

TEST(Reflectance, HIsChandrasekharsWithinAHundredth) {
  // Chandrasekhar (1960), Radiative Transfer, table XI: conservative scattering.
  ASSERT_NEAR(ExactH(1.0, 1.0), 2.9078, 2e-3);
  for (const double w : {0.1, 0.3, 0.5, 0.8, 0.95}) {
    for (const double x : {0.05, 0.2, 0.5, 0.8, 1.0}) {
      EXPECT_NEAR(HapkeH(w, x) / ExactH(w, x), 1.0, 0.01) << w << " " << x;
    }
  }
  EXPECT_EQ(HapkeH(0.5, 0.0), 1.0);
}

// Radiance factors that USGS ISIS 3 publishes with its Hapke models (Hapke.truth): w = 0.52, B0 =
// 1, h = 1, theta bar = 30 degrees; b = 0.213, c = 1, and isotropic. Their H function is that of
// Hapke (1981): what the two differ in does not have it.
TEST(Reflectance, SingleScatteringOfRoughGroundIsThatOfIsis) {
  Reflectance lobes = Of(Law::Hapke);
  lobes.singleScatteringAlbedo = 0.52;
  lobes.oppositionAmplitude = 1.0;
  lobes.oppositionWidth = 1.0;
  lobes.roughness_deg = 30.0;
  lobes.phaseAsymmetry = 0.213;
  lobes.phasePartition = 1.0;
  Reflectance isotropic = lobes;
  isotropic.phaseAsymmetry = 0.0;
  EXPECT_NEAR(Factor(lobes, 0, 0, 0) - Factor(isotropic, 0, 0, 0), 0.286048 - 0.16145, 2e-6);
  EXPECT_NEAR(Factor(lobes, 45, 30, 60) - Factor(isotropic, 45, 30, 60), 0.1342 - 0.111525, 1e-6);
  // Whole, with the two H functions up to 4 % apart.
  EXPECT_NEAR(Factor(isotropic, 0, 0, 0) / 0.16145, 1.0, 0.03);
  EXPECT_NEAR(Factor(isotropic, 45, 30, 60) / 0.111525, 1.0, 0.03);
}

TEST(Reflectance, SmoothHapkeIsItsClosedForm) {
  Reflectance hapke = Of(Law::Hapke);
  hapke.singleScatteringAlbedo = 0.4;
  hapke.phaseAsymmetry = 0.0;
  hapke.oppositionAmplitude = 1.5;
  hapke.oppositionWidth = 0.1;
  hapke.roughness_deg = 0.0;
  // i = 60, e = 0, g = 60: w / 4 / 3 (1 + 1.5 / (1 + tan 30 / 0.1) + H H - 1).
  const double both = HapkeH(0.4, 0.5) * HapkeH(0.4, 1.0);
  EXPECT_NEAR(Factor(hapke, 60, 0, 60), 0.1 / 3.0 * (1.5 / (1.0 + 10.0 / std::sqrt(3.0)) + both),
              1e-14);
  // Roughness comes in steadily, and darkens what is lit and seen slantwise.
  const double smooth = Factor(hapke, 70, 60, 100);
  hapke.roughness_deg = 0.01;
  EXPECT_NEAR(Factor(hapke, 70, 60, 100) / smooth, 1.0, 1e-3);
  hapke.roughness_deg = 30.0;
  EXPECT_LT(Factor(hapke, 70, 60, 100), 0.8 * smooth);
  // At phase 0 a facet hides no shadow: chi cancels but in H.
  EXPECT_NEAR(Factor(hapke, 0, 0, 0) / (0.4 / 8 * (1.5 + std::pow(HapkeH(0.4, 0.6989), 2))), 1.0,
              1e-4);
}

TEST(Reflectance, BadParametersAreRejectedByName) {
  const auto rejected = [](const Reflectance& reflectance) {
    try {
      reflectance.Check("object 'ground'");
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_EQ(rejected(Of(Law::Hapke)), "");
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const auto with = [](double Reflectance::*member, double value) {
    Reflectance made = Of(Law::Hapke);
    made.*member = value;
    return made;
  };
  EXPECT_EQ(rejected(with(&Reflectance::singleScatteringAlbedo, 1.2)),
            "object 'ground': the single-scattering albedo of its reflectance is 1.2; accepted: 0 "
            "to 1");
  for (const double value : {-0.1, 1.0, nan}) {
    EXPECT_NE(rejected(with(&Reflectance::phaseAsymmetry, value)), "");
  }
  for (const double value : {-1.1, 1.1, nan}) {
    EXPECT_NE(rejected(with(&Reflectance::phasePartition, value)), "");
  }
  for (const double value : {-1.0, 101.0, nan}) {
    EXPECT_NE(rejected(with(&Reflectance::oppositionAmplitude, value)), "");
  }
  for (const double value : {0.0, -1.0, 101.0, nan}) {
    EXPECT_NE(rejected(with(&Reflectance::oppositionWidth, value)), "");
  }
  for (const double value : {-1.0, 61.0, nan}) {
    EXPECT_NE(rejected(with(&Reflectance::roughness_deg, value)), "");
  }
  Reflectance lunar = Of(Law::LunarLambert);
  lunar.lunarWeight = 1.5;
  EXPECT_NE(rejected(lunar).find("the lunar weight of its reflectance is 1.5"), std::string::npos);
}

} // namespace dspace
