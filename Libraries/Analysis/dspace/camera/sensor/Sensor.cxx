#include <dspace/camera/sensor/Sensor.h>

#include <algorithm>
#include <cmath>
#include <memory>

#include <json/json.h>

#include <dspace/Checks.h>
#include <dspace/camera/sensor/Draws.h>

namespace dspace {
namespace {

constexpr double Planck = 6.62607015e-34;   // [J s], SI 2019
constexpr double Light = 299792458.0;       // [m/s]
constexpr double Boltzmann = 1.380649e-23;  // [J/K]
constexpr double SolarTemperature = 5772.0; // [K], IAU 2015 resolution B3
const std::string Label = "sensor";

// The channel of a Bayer pattern's pixel: 0 red, 1 green, 2 blue.
int FilterOf(const std::string& pattern, int x, int y) {
  switch (pattern[std::size_t((y & 1) * 2 + (x & 1))]) {
  case 'R':
    return 0;
  case 'G':
    return 1;
  default:
    return 2;
  }
}

// Blurs each channel along x or y.
void Blur(std::vector<float>& values, int width, int height, int channels,
          const std::vector<double>& kernel, bool down) {
  const int reach = int(kernel.size()) / 2;
  const int count = down ? height : width, lines = down ? width : height;
  std::vector<double> line(static_cast<std::size_t>(count));
  for (int l = 0; l < lines; ++l) {
    for (int c = 0; c < channels; ++c) {
      const auto at = [&](int i) -> float& {
        const int x = down ? l : i, y = down ? i : l;
        return values[(std::size_t(y) * std::size_t(width) + std::size_t(x)) *
                          std::size_t(channels) +
                      std::size_t(c)];
      };
      for (int i = 0; i < count; ++i) {
        double sum = 0.0;
        for (int k = -reach; k <= reach; ++k) {
          sum += kernel[std::size_t(k + reach)] * double(at(std::clamp(i + k, 0, count - 1)));
        }
        line[std::size_t(i)] = sum;
      }
      for (int i = 0; i < count; ++i) {
        at(i) = float(line[std::size_t(i)]);
      }
    }
  }
}

// The integral of a Gaussian over each pixel.
std::vector<double> KernelOf(double sigma) {
  const int reach = int(std::ceil(5.0 * sigma)) + 1;
  std::vector<double> kernel;
  double sum = 0.0;
  for (int k = -reach; k <= reach; ++k) {
    const double root = sigma * std::sqrt(2.0);
    kernel.push_back(0.5 * (std::erf((k + 0.5) / root) - std::erf((k - 0.5) / root)));
    sum += kernel.back();
  }
  for (double& value : kernel) {
    value /= sum;
  }
  return kernel;
}

// ∫ x² / (e^x - 1) dx from x to infinity, by its series: photons.
double PhotonTail(double x) {
  double sum = 0.0;
  for (int n = 1; n < 400; ++n) {
    const double term =
        std::exp(-n * x) * (x * x / n + 2.0 * x / (double(n) * n) + 2.0 / (double(n) * n * n));
    sum += term;
    if (term < 1e-17 * sum) {
      break;
    }
  }
  return sum;
}

double RatioOf(double wavelength, double temperature) {
  return Planck * Light / (wavelength * Boltzmann * temperature);
}

} // namespace

double BlackBodyFraction(double wavelength, double temperature) {
  // 15 / pi⁴ ∫ x³ / (e^x - 1) dx from x to infinity, by its series.
  const double x = RatioOf(wavelength, temperature);
  double sum = 0.0;
  for (int n = 1; n < 400; ++n) {
    const double m = n;
    const double term = std::exp(-m * x) * (x * x * x / m + 3.0 * x * x / (m * m) +
                                            6.0 * x / (m * m * m) + 6.0 / (m * m * m * m));
    sum += term;
    if (term < 1e-17 * sum) {
      break;
    }
  }
  return 15.0 / std::pow(M_PI, 4) * sum;
}

Sensor::Sensor(const SensorSettings& settings) : Settings_(settings) {
  const SensorSettings& s = this->Settings_;
  const auto within = [](double value, double low, double high, const char* what,
                         const char* accepted) {
    Require(value >= low && value <= high, Label, what, value, accepted);
  };
  Require(s.exposure_s > 0.0 && s.exposure_s <= 1e6, Label, "the exposure", s.exposure_s,
          "above 0, to 1e6 s");
  within(s.fNumber, 0.1, 1000.0, "the f-number", "0.1 to 1000");
  within(s.pixelPitch, 1e-7, 1e-3, "the pixel pitch", "1e-7 to 1e-3 m");
  within(s.transmission, 0.0, 1.0, "the transmission", "0 to 1");
  within(s.quantumEfficiency, 0.0, 1.0, "the quantum efficiency", "0 to 1");
  within(s.pointSpread, 0.0, 50.0, "the point spread", "0 to 50 pixels");
  within(s.readNoise, 0.0, 1e6, "the read noise", "0 to 1e6 electrons");
  within(s.darkCurrent, 0.0, 1e9, "the dark current", "0 to 1e9 electrons/s");
  Require(s.fullWell > 0.0 && s.fullWell <= 1e9, Label, "the full well", s.fullWell,
          "above 0, to 1e9 electrons");
  Require(s.gain > 0.0 && s.gain <= 1e9, Label, "the gain", s.gain,
          "above 0, to 1e9 electrons per count");
  within(s.bits, 8, 16, "the number of bits", "8 to 16");
  within(s.offset, 0.0, 65535.0, "the offset", "0 to 65535 counts");
  if (s.bands_nm.size() != 1 && s.bands_nm.size() != 3) {
    Reject(Label, "it has " + std::to_string(s.bands_nm.size()) + " bands; accepted: 1 or 3");
  }
  if (!s.bayer.empty() && s.bayer != "RGGB" && s.bayer != "BGGR" && s.bayer != "GRBG" &&
      s.bayer != "GBRG") {
    Reject(Label, "the pattern is '" + s.bayer + "'; accepted: RGGB, BGGR, GRBG, GBRG or none");
  }
  if (!s.bayer.empty() && s.bands_nm.size() != 3) {
    Reject(Label, "it has a Bayer pattern and one band; accepted: three bands with it");
  }
  for (const auto& [low, high] : s.bands_nm) {
    if (!(low >= 100.0 && high <= 5000.0 && low < high)) {
      Reject(Label, "a band is " + NumberText(low) + " to " + NumberText(high) +
                        " nm; accepted: within 100 to 5000 nm, the lower first");
    }
    // Photons in the band per joule of the whole spectrum.
    const double photons = PhotonTail(RatioOf(high * 1e-9, SolarTemperature)) -
                           PhotonTail(RatioOf(low * 1e-9, SolarTemperature));
    const double energy = std::pow(M_PI, 4) / 15.0;
    const double perJoule = photons / energy / (Boltzmann * SolarTemperature);
    const double etendue = M_PI * s.pixelPitch * s.pixelPitch / (4.0 * s.fNumber * s.fNumber);
    this->Response_.push_back(perJoule * etendue * s.transmission * s.quantumEfficiency *
                              s.exposure_s);
  }
}

int Sensor::CountChannels() const {
  return this->Settings_.bayer.empty() ? this->Channels() : 1;
}

std::vector<float> Sensor::Electrons(const std::vector<float>& radiance, int width, int height,
                                     const std::vector<float>& falloff) const {
  const std::size_t pixels = std::size_t(std::max(width, 0)) * std::size_t(std::max(height, 0));
  if (radiance.size() != 3 * pixels || (!falloff.empty() && falloff.size() != pixels)) {
    Reject(Label, "the radiance has " + std::to_string(radiance.size()) +
                      " values and the falloff " + std::to_string(falloff.size()) + "; accepted: " +
                      std::to_string(3 * pixels) + ", and " + std::to_string(pixels) + " or none");
  }
  const std::size_t channels = std::size_t(this->Channels());
  std::vector<float> electrons(channels * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const double factor = falloff.empty() ? 1.0 : double(falloff[i]);
    const auto light = [&](std::size_t k) {
      const double value = double(radiance[3 * i + k]) * factor;
      return value > 0.0 ? std::min(value, 1e12) : 0.0;
    };
    for (std::size_t c = 0; c < channels; ++c) {
      const double value = channels == 3 ? light(c) : (light(0) + light(1) + light(2)) / 3.0;
      electrons[channels * i + c] = float(value * this->Response_[c]);
    }
  }
  if (this->Settings_.pointSpread > 0.0) {
    const std::vector<double> kernel = KernelOf(this->Settings_.pointSpread);
    Blur(electrons, width, height, int(channels), kernel, false);
    Blur(electrons, width, height, int(channels), kernel, true);
  }
  return electrons;
}

std::vector<std::uint16_t> Sensor::Counts(const std::vector<float>& electrons, int width,
                                          int height, int x, int y, std::uint32_t frame) const {
  const SensorSettings& s = this->Settings_;
  const std::size_t channels = std::size_t(this->Channels());
  const std::size_t pixels = std::size_t(std::max(width, 0)) * std::size_t(std::max(height, 0));
  if (electrons.size() != channels * pixels) {
    Reject(Label, "there are electrons of " + std::to_string(electrons.size()) +
                      " values; accepted: " + std::to_string(channels * pixels));
  }
  const std::size_t out = std::size_t(this->CountChannels());
  const double most = double((1 << s.bits) - 1);
  const double dark = s.darkCurrent * s.exposure_s;
  std::vector<std::uint16_t> counts(out * pixels);
  for (std::size_t i = 0; i < pixels; ++i) {
    const int u = x + int(i % std::size_t(width)), v = y + int(i / std::size_t(width));
    for (std::size_t c = 0; c < out; ++c) {
      const std::size_t source = s.bayer.empty() ? c : std::size_t(FilterOf(s.bayer, u, v));
      const double mean = double(electrons[channels * i + source]) + dark;
      RequireFinite(Label, "the number of electrons of a pixel", mean);
      Draws draws(s.seed, std::uint32_t(u), std::uint32_t(v), frame, std::uint32_t(c));
      double value = s.photonNoise ? draws.Poisson(mean) : mean;
      value = std::min(value, s.fullWell);
      if (s.readNoise > 0.0) {
        value += s.readNoise * draws.Normal();
      }
      counts[out * i + c] =
          std::uint16_t(std::clamp(std::round(value / s.gain + s.offset), 0.0, most));
    }
  }
  return counts;
}

SensorSettings ParseSensorJson(const std::string& text) {
  Json::CharReaderBuilder builder;
  const std::unique_ptr<Json::CharReader> reader(builder.newCharReader());
  Json::Value root;
  std::string errors;
  if (!reader->parse(text.data(), text.data() + text.size(), &root, &errors) || !root.isObject()) {
    Reject(Label, "its settings are no JSON object");
  }
  SensorSettings s;
  const std::vector<std::pair<const char*, double*>> numbers = {
      {"exposure_s", &s.exposure_s},
      {"f_number", &s.fNumber},
      {"pixel_pitch", &s.pixelPitch},
      {"transmission", &s.transmission},
      {"quantum_efficiency", &s.quantumEfficiency},
      {"point_spread", &s.pointSpread},
      {"read_noise", &s.readNoise},
      {"dark_current", &s.darkCurrent},
      {"full_well", &s.fullWell},
      {"gain", &s.gain},
      {"offset", &s.offset}};
  for (const std::string& name : root.getMemberNames()) {
    const Json::Value& value = root[name];
    const auto found = std::find_if(numbers.begin(), numbers.end(),
                                    [&](const auto& each) { return name == each.first; });
    const auto wrong = [&] {
      Reject(Label, "'" + name + "' has a value of another kind, or is unknown");
    };
    if (found != numbers.end()) {
      value.isNumeric() ? void(*found->second = value.asDouble()) : wrong();
    } else if (name == "bits") {
      value.isInt() ? void(s.bits = value.asInt()) : wrong();
    } else if (name == "seed") {
      value.isUInt64() ? void(s.seed = value.asUInt64()) : wrong();
    } else if (name == "photon_noise") {
      value.isBool() ? void(s.photonNoise = value.asBool()) : wrong();
    } else if (name == "bayer") {
      value.isString() ? void(s.bayer = value.asString()) : wrong();
    } else if (name == "bands_nm" && value.isArray()) {
      s.bands_nm.clear();
      for (const Json::Value& band : value) {
        if (!band.isArray() || band.size() != 2 || !band[0].isNumeric() || !band[1].isNumeric()) {
          wrong();
        }
        s.bands_nm.push_back({band[0].asDouble(), band[1].asDouble()});
      }
    } else {
      wrong();
    }
  }
  return s;
}

} // namespace dspace
