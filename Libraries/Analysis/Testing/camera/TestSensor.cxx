// The detector: photons by quadrature, noise by its statistics, seeds, saturation.
#include <cmath>
#include <functional>
#include <numeric>

#include <gtest/gtest.h>

#include <dspace/Error.h>
#include <dspace/camera/sensor/Philox.h>
#include <dspace/camera/sensor/Sensor.h>

namespace dspace {
namespace {

constexpr int Side = 256;

SensorSettings Gray() {
  SensorSettings settings;
  settings.bands_nm = {{500, 600}};
  settings.gain = 1.0;
  settings.bits = 16;
  settings.offset = 1000.0;
  settings.readNoise = 0.0;
  return settings;
}

struct Moments {
  double mean = 0.0;
  double variance = 0.0;
};

Moments Of(const std::vector<std::uint16_t>& counts) {
  Moments m;
  for (const std::uint16_t count : counts) {
    m.mean += count;
  }
  m.mean /= double(counts.size());
  for (const std::uint16_t count : counts) {
    m.variance += (count - m.mean) * (count - m.mean);
  }
  m.variance /= double(counts.size() - 1);
  return m;
}

Moments Flat(const SensorSettings& settings, double electrons) {
  const Sensor sensor(settings);
  return Of(sensor.Counts(std::vector<float>(Side * Side, float(electrons)), Side, Side, 0, 0, 0));
}

TEST(Sensor, PhiloxIsThePublishedOne) { // known answers of Random123
  using Four = std::array<std::uint32_t, 4>;
  EXPECT_EQ(Philox({0, 0, 0, 0}, {0, 0}), (Four{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
  const std::uint32_t f = 0xffffffff;
  EXPECT_EQ(Philox({f, f, f, f}, {f, f}), (Four{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
  EXPECT_EQ(Philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, {0xa4093822, 0x299f31d0}),
            (Four{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
}

TEST(Sensor, ResponseIsTheQuadratureOfPlancksLaw) {
  const double h = 6.62607015e-34, c = 299792458.0, k = 1.380649e-23, T = 5772.0;
  const auto radiance = [&](double l) {
    return 2 * h * c * c / std::pow(l, 5) / std::expm1(h * c / (l * k * T));
  };
  double photons = 0.0;
  const double step = 1e-12;
  for (double l = 500e-9 + 0.5 * step; l < 600e-9; l += step) {
    photons += radiance(l) * l / (h * c) * step;
  }
  const double whole = 2 * std::pow(M_PI * k * T, 4) / (15 * h * h * h * c * c); // sigma T⁴ / pi
  SensorSettings s = Gray();
  s.exposure_s = 0.02;
  s.fNumber = 8.0;
  s.pixelPitch = 7e-6;
  s.transmission = 0.8;
  s.quantumEfficiency = 0.4;
  const double expected = photons / whole * M_PI * 7e-6 * 7e-6 / 256.0 * 0.8 * 0.4 * 0.02;
  EXPECT_NEAR(Sensor(s).Response(0) / expected, 1.0, 1e-6);
  // 0.2501 of the radiance of a black body lies below lambda T = 2898 um K (published tables), and
  // half below 4107 um K.
  EXPECT_NEAR(BlackBodyFraction(2897.77e-6 / T, T), 0.2501, 1e-4);
  EXPECT_NEAR(BlackBodyFraction(4107e-6 / T, T), 0.5, 1e-4);
  const Sensor sensor(s);
  const std::vector<float> electrons =
      sensor.Electrons({100, 200, 300, -1, std::nanf(""), 0}, 2, 1, {0.5f, 1.0f});
  EXPECT_NEAR(electrons[0] / (100.0 * sensor.Response(0)), 1.0, 1e-6);
  EXPECT_EQ(electrons[1], 0.0f);
}

TEST(Sensor, VarianceIsTheMeanOfPhotons) {
  // Means below and above the change of the method. 65,536 values: the mean is known to
  // sqrt(m) / 256, the variance to 0.55 % (4 sigma: 2.2 %).
  for (const double mean : {0.5, 7.0, 12.0, 90.0, 900.0, 20000.0}) {
    const Moments m = Flat(Gray(), mean);
    EXPECT_NEAR(m.mean - 1000.0, mean, 4.0 * std::sqrt(mean) / Side) << mean;
    // Rounding to counts adds nothing to integers.
    EXPECT_NEAR(m.variance / mean, 1.0, 0.03) << mean;
  }
}

TEST(Sensor, DarkCurrentReadNoiseAndGainAddUp) {
  SensorSettings s = Gray();
  s.readNoise = 6.0;
  s.gain = 2.0;
  s.darkCurrent = 400.0;
  s.exposure_s = 0.5;
  const Moments dark = Flat(s, 0.0); // 200 electrons
  EXPECT_NEAR(dark.mean, 1000.0 + 100.0, 0.15);
  EXPECT_NEAR(dark.variance, (200.0 + 36.0) / 4.0 + 1.0 / 12.0, 1.6);
  s.darkCurrent = 0.0;
  const Moments floor = Flat(s, 0.0);
  EXPECT_NEAR(floor.variance, 9.0 + 1.0 / 12.0, 0.25); // the read noise's floor
  s.photonNoise = false;
  s.readNoise = 0.0;
  EXPECT_EQ(Flat(s, 250.0).variance, 0.0);
  EXPECT_EQ(Flat(s, 250.0).mean, 1125.0);
}

TEST(Sensor, SaturatesAtTheWellAndAtTheBits) {
  SensorSettings s = Gray();
  s.offset = 0.0;
  s.fullWell = 3000.0;
  EXPECT_EQ(Flat(s, 1e6).mean, 3000.0);
  s.bits = 10;
  EXPECT_EQ(Flat(s, 1e6).mean, 1023.0);
}

TEST(Sensor, NoiseDependsOnSeedPlaceAndFrameOnly) {
  SensorSettings s = Gray();
  s.readNoise = 10.0;
  s.seed = 0x123456789abcdefULL;
  const Sensor sensor(s);
  std::vector<float> electrons(Side * Side);
  for (std::size_t i = 0; i < electrons.size(); ++i) {
    electrons[i] = float(i % 700);
  }
  const auto whole = sensor.Counts(electrons, Side, Side, 0, 0, 3);
  EXPECT_EQ(whole, sensor.Counts(electrons, Side, Side, 0, 0, 3));
  std::vector<float> part;
  for (int y = 100; y < 130; ++y) {
    part.insert(part.end(), electrons.begin() + y * Side + 50, electrons.begin() + y * Side + 90);
  }
  const auto tile = sensor.Counts(part, 40, 30, 50, 100, 3);
  for (int y = 0; y < 30; ++y) {
    for (int x = 0; x < 40; ++x) {
      ASSERT_EQ(tile[std::size_t(y * 40 + x)], whole[std::size_t((100 + y) * Side + 50 + x)]);
    }
  }
  const auto differs = [&](const std::vector<std::uint16_t>& other) {
    int count = 0;
    double product = 0.0;
    for (std::size_t i = 0; i < other.size(); ++i) {
      count += other[i] != whole[i];
      product += (other[i] - 1000.0 - electrons[i]) * (whole[i] - 1000.0 - electrons[i]);
    }
    // Not correlated: the variance is some 450.
    EXPECT_LT(std::abs(product / double(other.size())), 10.0);
    return count > int(other.size()) * 9 / 10;
  };
  EXPECT_TRUE(differs(sensor.Counts(electrons, Side, Side, 0, 0, 4)));
  s.seed += 1;
  EXPECT_TRUE(differs(Sensor(s).Counts(electrons, Side, Side, 0, 0, 3)));
}

TEST(Sensor, BlurKeepsTheEnergyAndIsTheGaussian) {
  SensorSettings s = Gray();
  s.pointSpread = 1.7;
  const Sensor sensor(s);
  std::vector<float> radiance(3 * 65 * 65, 0.0f);
  for (std::size_t k = 0; k < 3; ++k) {
    radiance[3 * (32 * 65 + 32) + k] = 1e6f;
  }
  const std::vector<float> e = sensor.Electrons(radiance, 65, 65, {});
  const double total = std::accumulate(e.begin(), e.end(), 0.0);
  EXPECT_NEAR(total / (1e6 * sensor.Response(0)), 1.0, 1e-6);
  double second = 0.0, inside = 0.0;
  for (int y = 0; y < 65; ++y) {
    for (int x = 0; x < 65; ++x) {
      second += double(e[std::size_t(y * 65 + x)]) * (x - 32) * (x - 32);
      inside +=
          std::abs(x - 32) <= 2 && std::abs(y - 32) <= 2 ? double(e[std::size_t(y * 65 + x)]) : 0.0;
    }
  }
  EXPECT_NEAR(second / total, 1.7 * 1.7 + 1.0 / 12.0, 1e-3); // and the pixel's own width
  const double across = std::erf(2.5 / (1.7 * std::sqrt(2.0)));
  EXPECT_NEAR(inside / total, across * across, 1e-5); // the ensquared energy
}

TEST(Sensor, FiltersFollowThePattern) {
  SensorSettings s;
  s.photonNoise = false;
  s.gain = 1.0;
  s.bits = 16;
  s.bayer = "GRBG";
  const Sensor sensor(s);
  std::vector<float> e;
  for (int i = 0; i < 16; ++i) {
    e.insert(e.end(), {100, 200, 300});
  }
  const auto counts = sensor.Counts(e, 4, 4, 0, 0, 0);
  EXPECT_EQ(counts.size(), 16u);
  EXPECT_EQ(counts[0], 200);
  EXPECT_EQ(counts[1], 100);
  EXPECT_EQ(counts[4], 300);
  EXPECT_EQ(counts[5], 200);
  const auto odd = sensor.Counts(e, 4, 4, 1, 0, 0); // a tile that begins at an odd column
  EXPECT_EQ(odd[0], 100);
}

TEST(Sensor, RejectsWhatIsNoDetector) {
  const auto rejected = [](const std::function<void(SensorSettings&)>& change) {
    SensorSettings s;
    change(s);
    try {
      Sensor sensor(s);
    } catch (const Error& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  EXPECT_NE(rejected([](auto& s) { s.exposure_s = 0.0; }).find("exposure is 0"), std::string::npos);
  EXPECT_NE(rejected([](auto& s) { s.bits = 0; }).find("number of bits is 0; accepted: 8 to 16"),
            std::string::npos);
  EXPECT_NE(rejected([](auto& s) { s.gain = std::nan(""); }).find("gain"), std::string::npos);
  EXPECT_NE(rejected([](auto& s) { s.bayer = "RGBG"; }).find("accepted: RGGB"), std::string::npos);
  EXPECT_NE(rejected([](auto& s) {
              s.bands_nm = {{600, 500}};
            }).find("600 to 500 nm"),
            std::string::npos);
  for (const float electrons : {std::nanf(""), HUGE_VALF}) {
    EXPECT_THROW(Sensor(Gray()).Counts({electrons}, 1, 1, 0, 0, 0), Error);
  }
  EXPECT_THROW(ParseSensorJson("{\"exposure\": 1}"), Error);
  EXPECT_THROW(ParseSensorJson("{\"bits\": 1.5}"), Error);
  EXPECT_EQ(ParseSensorJson("{\"gain\": 3, \"seed\": 18446744073709551615}").seed,
            ~std::uint64_t(0));
}

} // namespace
} // namespace dspace
