// What pictures of a scene say about sights: pixels into angles and areas.
#ifndef DSPACE_MEASURE_PICTURE_READINGS_H
#define DSPACE_MEASURE_PICTURE_READINGS_H

#include <cstdint>
#include <vector>

namespace dspace {

// Pictures are square, rows from the top down, by a level camera with a field of view of 90
// degrees. A range [m] is infinite where nothing was hit.
struct HorizonReading {
  double elevation_deg = -90.0; // -90: the column shows nothing
  float range = 0.0f;           // of the highest pixel that was hit
  int column = 0;               // of that pixel
  int row = 0;
  bool over = false; // the column's top pixel was hit: the horizon is at least this high
};

// The horizon at an azimuth `right_deg` clockwise of the picture's middle, -45 to 45: the upper
// edge of the highest pixel that was hit in the column nearest to it. A column shows one azimuth:
// vertical planes through the camera are columns.
HorizonReading ReadHorizon(const std::vector<float>& range, int size, double right_deg);

// The largest angle between two neighbouring pixels' rays [deg]: at the middle.
double PixelAngle(int size);

// How many pixels have a label.
std::size_t CountLabel(const std::vector<std::uint32_t>& labels, std::uint32_t label);

} // namespace dspace

#endif
