#include <dspace/visibility/HorizonLine.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <dspace/Checks.h>

namespace dspace {
namespace {

constexpr double Degree = M_PI / 180.0;
constexpr int Columns = 129;
// Of the elevation of a disc: at the zenith azimuths have no width.
constexpr double LeastCosine = 1e-3;

void RequireRadius(double radius_deg) {
  Require(radius_deg >= 0.0 && radius_deg <= HorizonLine::MostRadius, "horizon",
          "the radius of a disc", radius_deg, "0 to 10 degrees");
}

// Calls `visit(half, over)` for columns of equal steps of angle around the disc: half the height of
// the column [deg], and the height of its middle over the horizon [deg]. `half` is also
// proportional to the column's width.
template<class Visit>
void ForEachColumn(const HorizonLine& line, const AzimuthElevation& center, double radius_deg,
                   Visit visit) {
  const double width = std::max(std::cos(center.elevation_deg * Degree), LeastCosine);
  for (int i = 0; i < Columns; ++i) {
    const double angle = M_PI * (i + 0.5) / Columns;
    const double azimuth_deg = center.azimuth_deg + radius_deg * std::cos(angle) / width;
    visit(radius_deg * std::sin(angle), center.elevation_deg - line.ElevationAt(azimuth_deg));
  }
}

} // namespace

HorizonLine::HorizonLine(double elevation_deg) : HorizonLine(std::vector<double>{elevation_deg}) {}

HorizonLine::HorizonLine(std::vector<double> elevations_deg, double first_deg)
    : Elevations_(std::move(elevations_deg)), First_(first_deg) {
  if (this->Elevations_.empty() || this->Elevations_.size() > std::size_t(Most)) {
    Reject("horizon",
           std::to_string(this->Elevations_.size()) + " elevations; accepted: 1 to 1,000,000");
  }
  if (!std::isfinite(first_deg)) {
    Reject("horizon", "the first azimuth is not finite; accepted: degrees");
  }
  for (const double elevation : this->Elevations_) {
    Require(elevation >= -90.0 && elevation <= 90.0, "horizon", "an elevation", elevation,
            "-90 to 90 degrees");
  }
  this->Least_ = *std::min_element(this->Elevations_.begin(), this->Elevations_.end());
  this->Greatest_ = *std::max_element(this->Elevations_.begin(), this->Elevations_.end());
}

double HorizonLine::ElevationAt(double azimuth_deg) const {
  const std::size_t count = this->Elevations_.size();
  double turn = (azimuth_deg - this->First_) / 360.0;
  turn -= std::floor(turn);
  const double place = turn * double(count);
  const std::size_t before = std::min(std::size_t(place), count - 1);
  const double share = place - double(before);
  return (1.0 - share) * this->Elevations_[before] +
         share * this->Elevations_[(before + 1) % count];
}

double HorizonLine::TopOver(const AzimuthElevation& center, double radius_deg) const {
  RequireRadius(radius_deg);
  double top = center.elevation_deg - this->ElevationAt(center.azimuth_deg) + radius_deg;
  if (radius_deg > 0.0 && this->Least_ < this->Greatest_) {
    ForEachColumn(*this, center, radius_deg,
                  [&](double half, double over) { top = std::max(top, over + half); });
  }
  return top;
}

double HorizonLine::LitFraction(const AzimuthElevation& center, double radius_deg) const {
  RequireRadius(radius_deg);
  if (radius_deg == 0.0) {
    return center.elevation_deg >= this->ElevationAt(center.azimuth_deg) ? 1.0 : 0.0;
  }
  if (center.elevation_deg - radius_deg >= this->Greatest_) {
    return 1.0;
  }
  if (center.elevation_deg + radius_deg <= this->Least_) {
    return 0.0;
  }
  double lit = 0.0, all = 0.0;
  ForEachColumn(*this, center, radius_deg, [&](double half, double over) {
    lit += half * std::clamp(over + half, 0.0, 2.0 * half);
    all += half * 2.0 * half;
  });
  return lit / all;
}

} // namespace dspace
