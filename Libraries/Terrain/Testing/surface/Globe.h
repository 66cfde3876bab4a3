// Rasters of whole bodies for tests, and their surface evaluated by hand.
#ifndef DSPACE_TEST_GLOBE_H
#define DSPACE_TEST_GLOBE_H

#include <cmath>
#include <functional>

#include <Eigen/Core>

#include "RasterFile.h"

namespace dspace::testing {

constexpr double Degree = M_PI / 180.0;

// A whole body of `width` x width / 2 pixels.
struct Globe {
  int width = 96;
  double radius = 1737400.0;
  double west_deg = -180.0;                             // of the left edge
  int direction = 1;                                    // of longitude along columns
  std::function<double(double lon, double lat)> height; // [deg]

  double Step() const { return 360.0 / this->width; }
  double Lon(int c) const { return this->west_deg + this->direction * (c + 0.5) * this->Step(); }
  double Lat(int r) const { return 90.0 - (r + 0.5) * this->Step(); }
  RasterFile File() const {
    RasterFile file;
    file.width = this->width;
    file.height = this->width / 2;
    file.crs = "+proj=longlat +R=" + std::to_string(this->radius) + " +no_defs";
    file.verticalDatum = "sphere";
    file.geotransform = std::array<double, 6>{
        this->west_deg, this->direction * this->Step(), 0, 90, 0, -this->Step()};
    file.value = [this](int c, int r, int) {
      return double(float(this->height(this->Lon(c), this->Lat(r))));
    };
    return file;
  }
};

inline double Bulges(double lon, double lat) {
  const double l = lon * Degree;
  const double p = lat * Degree;
  return 4000.0 * std::cos(p) * std::cos(p) * std::sin(2.0 * l) + 1500.0 * std::sin(3.0 * p) +
         700.0 * std::cos(p) * std::cos(l - 0.4);
}

// The stated surface by hand: linear between pixels in longitude and latitude, on triangles whose
// diagonal runs down to the right, and ruled from the pole.
inline double ByHand(const Globe& globe, double lon, double lat) {
  const int height = globe.width / 2;
  const auto pixel = [&](int c, int r) {
    c = ((c % globe.width) + globe.width) % globe.width;
    return double(float(globe.height(globe.Lon(c), globe.Lat(r))));
  };
  double x = globe.direction * (lon - globe.west_deg) / globe.Step() - 0.5;
  x -= globe.width * std::floor(x / globe.width);
  const double y = (90.0 - lat) / globe.Step() - 0.5;
  const int c = int(x);
  const double u = x - c;
  if (y < 0.0 || y > height - 1.0) {
    const int row = y < 0.0 ? 0 : height - 1;
    double pole = 0.0;
    for (int i = 0; i < globe.width; ++i) {
      pole += pixel(i, row) / globe.width;
    }
    const double along = (1.0 - u) * pixel(c, row) + u * pixel(c + 1, row);
    const double share = 2.0 * (y < 0.0 ? y + 0.5 : height - 0.5 - y);
    return pole + share * (along - pole);
  }
  const int r = std::min(int(y), height - 2);
  const double v = y - r;
  const double corner = u > v ? pixel(c + 1, r) : pixel(c, r + 1);
  return (1.0 - std::max(u, v)) * pixel(c, r) + std::min(u, v) * pixel(c + 1, r + 1) +
         std::abs(u - v) * corner;
}

inline Eigen::Vector3d Direction(double lon, double lat) {
  return {std::cos(lat * Degree) * std::cos(lon * Degree),
          std::cos(lat * Degree) * std::sin(lon * Degree), std::sin(lat * Degree)};
}

} // namespace dspace::testing

#endif
