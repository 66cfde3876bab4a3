// Air against closed forms.
#include <gtest/gtest.h>

#include <cmath>

#include <dspace/Error.h>
#include <dspace/scene/bodies/Atmosphere.h>

namespace dspace {
namespace {

constexpr double Ground = 6371e3;

TEST(Atmosphere, TheVerticalColumnIsThatOfAnExponential) {
  const Atmosphere air = EarthAtmosphere();
  const Eigen::Vector3d passed = TransmittanceToTop(air, Ground, Ground, 1.0, 20000);
  for (int i = 0; i < 3; ++i) {
    const double depth =
        air.rayleigh[i] * air.rayleighHeight * (1.0 - std::exp(-air.top / air.rayleighHeight)) +
        air.mieExtinction[i] * air.mieHeight;
    EXPECT_NEAR(passed[i], std::exp(-depth), 1e-6) << i;
  }
  // Green light of the Earth's clear sky: 10.8 % of Rayleigh's kind (8 km), as published for 550
  // nm: 0.097 (A. Bucholtz, Appl. Opt. 34 (1995) 2765), with a column of 8.43 km rather than 8.
  EXPECT_NEAR(air.rayleigh[1] * air.rayleighHeight, 0.097, 0.012);
}

TEST(Atmosphere, TheGroundThrowsItsShadow) {
  const Atmosphere air = EarthAtmosphere();
  EXPECT_EQ(TransmittanceToTop(air, Ground, Ground + 10e3, -1.0), Eigen::Vector3d::Zero());
  EXPECT_GT(TransmittanceToTop(air, Ground, Ground + 10e3, -0.05)[0],
            0.0); // above the horizon: dip 3.2 deg
}

// Of one thin layer without extinction the integral is a product.
TEST(Atmosphere, ThinAirScattersItsPhaseFunction) {
  Atmosphere air;
  air.rayleigh = {1e-12, 2e-12, 4e-12};
  air.rayleighHeight = 1e7; // even, about
  air.top = 1e5;
  const Eigen::Vector3d from(Ground + 100.0, 0, 0);
  const Eigen::Vector3d to(Ground + 9e4, 0, 0);
  for (const double angle : {0.2, 1.0, 1.5}) {
    const Eigen::Vector3d sun(std::cos(angle), std::sin(angle), 0);
    const AirLight light = IntegrateAir(air, Ground, from, to, sun, 400, 50);
    const double mean = (std::exp(-100.0 / 1e7) + std::exp(-9e4 / 1e7)) / 2.0;
    const double phase = 3.0 / (16.0 * M_PI) * (1.0 + std::cos(angle) * std::cos(angle));
    for (int i = 0; i < 3; ++i) {
      const double expected = air.rayleigh[i] * phase * mean * (to - from).norm();
      EXPECT_NEAR(light.scattered[i], expected, 1e-4 * expected) << i;
      EXPECT_NEAR(light.transmitted[i], 1.0, 1e-5) << i;
    }
  }
}

// Henyey and Greenstein's function is normalised to 1 over the sphere.
TEST(Atmosphere, HazeScattersAllThatItTakesWithoutAbsorption) {
  Atmosphere air;
  air.mie = air.mieExtinction = Eigen::Vector3d::Constant(1e-12);
  air.mieHeight = 1e7;
  air.mieAsymmetry = 0.7;
  air.top = 1e5;
  double sum = 0.0;
  constexpr int Steps = 400;
  for (int i = 0; i < Steps; ++i) { // over the angle between a level ray and a level Sun
    const double angle = M_PI * (i + 0.5) / Steps;
    const Eigen::Vector3d level(0, std::cos(angle), std::sin(angle));
    const Eigen::Vector3d high(Ground + 9.9e4, 0, 0);
    const AirLight light =
        IntegrateAir(air, Ground, high, high + Eigen::Vector3d(0, 1e3, 0), level, 4, 20);
    sum += light.scattered[0] / 1e3 / 1e-12 / std::exp(-9.9e4 / 1e7) * 2.0 * M_PI *
           std::sin(angle) * M_PI / Steps;
  }
  EXPECT_NEAR(sum, 1.0, 2e-3);
}

TEST(Atmosphere, BadNumbersAreRejected) {
  Atmosphere air = EarthAtmosphere();
  const Eigen::Vector3d radii(Ground, Ground, Ground);
  EXPECT_NO_THROW(air.Check("earth", radii));
  EXPECT_NO_THROW(MarsAtmosphere().Check("mars", radii));
  air.mieExtinction[1] = 0.5 * air.mie[1];
  EXPECT_THROW(air.Check("earth", radii), Error);
  air = EarthAtmosphere();
  air.rayleighHeight = 0.0;
  EXPECT_THROW(air.Check("earth", radii), Error);
  air = EarthAtmosphere();
  EXPECT_THROW(air.Check("earth", Eigen::Vector3d(1e6, 1.1e6, 1e6)), Error);
}

} // namespace
} // namespace dspace
