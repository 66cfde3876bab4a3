#include <dspace/visibility/DirectionTable.h>

#include <algorithm>
#include <cmath>
#include <string>
#include <utility>

#include <dspace/Checks.h>

namespace dspace {

DirectionTable::DirectionTable(std::vector<double> values, std::size_t azimuths, double lowest_deg,
                               double highest_deg)
    : Values_(std::move(values)), Azimuths_(azimuths),
      Rows_(azimuths > 0 ? this->Values_.size() / azimuths : 0), Lowest_deg_(lowest_deg),
      Highest_deg_(highest_deg) {
  const std::string about = "table of directions";
  if (this->Values_.empty() || this->Values_.size() > MostValues ||
      this->Rows_ * azimuths != this->Values_.size()) {
    Reject(about, std::to_string(this->Values_.size()) + " values at " + std::to_string(azimuths) +
                      " azimuths; accepted: 1 to 1,000,000, a row of azimuths for each elevation");
  }
  if (!(lowest_deg >= -90.0 && highest_deg <= 90.0) ||
      !(this->Rows_ == 1 ? lowest_deg <= highest_deg : lowest_deg < highest_deg)) {
    Reject(about, "its elevations run from " + NumberText(lowest_deg) + " to " +
                      NumberText(highest_deg) + "; accepted: ascending, -90 to 90 degrees");
  }
  for (const double value : this->Values_) {
    Require(value >= 0.0 && std::isfinite(value), about, "a value", value, "0 or more, finite");
  }
}

double DirectionTable::At(const AzimuthElevation& direction) const {
  const double turn = direction.azimuth_deg / 360.0;
  const double x = (turn - std::floor(turn)) * double(this->Azimuths_);
  const auto left = std::size_t(x) % this->Azimuths_;
  const std::size_t right = (left + 1) % this->Azimuths_;
  const double share = x - std::floor(x);
  double y = 0.0;
  if (this->Rows_ > 1) {
    y = (direction.elevation_deg - this->Lowest_deg_) / (this->Highest_deg_ - this->Lowest_deg_) *
        double(this->Rows_ - 1);
  }
  y = std::clamp(y, 0.0, double(this->Rows_ - 1));
  const std::size_t low = std::min(std::size_t(y), this->Rows_ - 1);
  const std::size_t high = std::min(low + 1, this->Rows_ - 1);
  const auto along = [&](std::size_t row) {
    const double* values = &this->Values_[row * this->Azimuths_];
    return values[left] + share * (values[right] - values[left]);
  };
  return along(low) + (y - double(low)) * (along(high) - along(low));
}

} // namespace dspace
