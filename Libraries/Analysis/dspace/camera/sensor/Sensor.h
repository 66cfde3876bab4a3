// A detector: from radiance to electrons and counts.
#ifndef DSPACE_CAMERA_SENSOR_SENSOR_H
#define DSPACE_CAMERA_SENSOR_SENSOR_H

#include <array>
#include <cstdint>
#include <string>
#include <vector>

namespace dspace {

// A detector with its optics' light. Radiance L [W/m²/sr] of a channel is that of the whole solar
// spectrum, whose shape is a black body's of 5772 K (IAU 2015 nominal): L in a band is the
// fraction of that spectrum. The mean number of electrons of a pixel is
//   L · falloff · pi pitch² / (4 N²) · transmission · QE · exposure · ∫ B λ / (h c) dλ / ∫ B dλ
// with the first integral over the band: an extended source far away on a lens of f-number N.
struct SensorSettings {
  double exposure_s = 0.01;       // > 0, to 1e6
  double fNumber = 4.0;           // N, 0.1 to 1000
  double pixelPitch = 5e-6;       // [m], 1e-7 to 1e-3
  double transmission = 0.9;      // of the lens, 0 to 1
  double quantumEfficiency = 0.5; // electrons a photon in the band, 0 to 1
  // Of one channel, or of red, green and blue: from, to [nm], 100 to 5000. One channel takes the
  // mean of red, green and blue.
  std::vector<std::array<double, 2>> bands_nm = {{600, 700}, {500, 600}, {400, 500}};
  std::string bayer;        // "": every channel a pixel; "RGGB", "BGGR", "GRBG", "GBRG"
  double pointSpread = 0.0; // standard deviation of a Gaussian blur [pixels], 0 to 50
  bool photonNoise = true;
  double readNoise = 0.0;    // standard deviation [electrons], 0 to 1e6
  double darkCurrent = 0.0;  // [electrons/s], 0 to 1e9
  double fullWell = 50000.0; // [electrons], > 0, to 1e9
  double gain = 12.5;        // [electrons per count], > 0, to 1e9
  int bits = 12;             // of a count, 8 to 16
  double offset = 0.0;       // counts of no electron, 0 to 65535
  std::uint64_t seed = 0;
};

class Sensor {
public:
  // Throws Error(InvalidArgument) naming the value and what is accepted.
  explicit Sensor(const SensorSettings& settings);

  const SensorSettings& Settings() const { return this->Settings_; }
  int Channels() const { return int(this->Settings_.bands_nm.size()); } // of Electrons()
  int CountChannels() const; // of Counts(): one with a Bayer pattern
  // Electrons per radiance of a channel at falloff 1.
  double Response(int channel) const { return this->Response_[std::size_t(channel)]; }

  // Mean electrons from light, after blur: Channels() a pixel. radiance: red, green, blue a pixel,
  // rows from the top; NaN and negative values count as 0. falloff: a factor for each pixel, or
  // empty. Pixels beyond the edges count as those on them.
  std::vector<float> Electrons(const std::vector<float>& radiance, int width, int height,
                               const std::vector<float>& falloff) const;
  // Counts of a part of an image whose first pixel is (x, y): noise depends on the seed, the
  // pixel's own place and `frame`, and on nothing else. Photon noise is Poisson's; above a
  // million electrons its normal limit. Clipped at the full well, rounded, clipped at the bits.
  // Throws Error(InvalidArgument) for electrons that are not finite.
  std::vector<std::uint16_t> Counts(const std::vector<float>& electrons, int width, int height,
                                    int x, int y, std::uint32_t frame) const;

private:
  SensorSettings Settings_;
  std::vector<double> Response_;
};

// The fraction of a black body's radiance below a wavelength [m] at a temperature [K].
double BlackBodyFraction(double wavelength, double temperature);

// Settings as a JSON object with the names exposure_s, f_number, pixel_pitch, transmission,
// quantum_efficiency, bands_nm, bayer, point_spread, photon_noise, read_noise, dark_current,
// full_well, gain, bits, offset, seed. Throws Error(InvalidArgument) for others.
SensorSettings ParseSensorJson(const std::string& text);

} // namespace dspace

#endif
