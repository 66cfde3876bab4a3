#include <dspace/camera/LensNumbers.h>

#include <cmath>

#include <dspace/Checks.h>

namespace dspace {

LensNumbers::LensNumbers(const LensValues& values, const std::string& label)
    : Values_(values), Label_(label) {
  for (const auto& [name, numbers] : values) {
    for (const double number : numbers) {
      RequireFinite(label, name.c_str(), number);
      Require(std::abs(number) <= 1e12, label, name.c_str(), number, "within 1e12");
    }
  }
}

std::vector<double> LensNumbers::Exactly(const std::string& name, std::size_t count) {
  const auto found = this->Values_.find(name);
  const std::size_t given = found == this->Values_.end() ? 0 : found->second.size();
  if (given != count) {
    Reject(this->Label_, "'" + name + "' has " + std::to_string(given) +
                             " numbers; accepted: " + std::to_string(count));
  }
  this->Taken_.insert(name);
  return found->second;
}

std::vector<double> LensNumbers::UpTo(const std::string& name, std::size_t least,
                                      std::size_t most) {
  this->Taken_.insert(name);
  const auto found = this->Values_.find(name);
  if (found == this->Values_.end()) {
    return std::vector<double>(most, 0.0);
  }
  std::vector<double> numbers = found->second;
  if (numbers.size() < least || numbers.size() > most) {
    Reject(this->Label_, "'" + name + "' has " + std::to_string(numbers.size()) +
                             " numbers; accepted: " + std::to_string(least) + " to " +
                             std::to_string(most));
  }
  numbers.resize(most, 0.0);
  return numbers;
}

std::vector<double> LensNumbers::Rows(const std::string& name, std::size_t columns,
                                      std::size_t least, std::size_t most) {
  const auto found = this->Values_.find(name);
  const std::size_t given = found == this->Values_.end() ? 0 : found->second.size();
  if (given % columns != 0 || given < least * columns || given > most * columns) {
    Reject(this->Label_, "'" + name + "' has " + std::to_string(given) +
                             " numbers; accepted: " + std::to_string(least) + " to " +
                             std::to_string(most) + " times " + std::to_string(columns));
  }
  this->Taken_.insert(name);
  return found->second;
}

double LensNumbers::One(const std::string& name) {
  return this->Exactly(name, 1)[0];
}

Eigen::Vector2d LensNumbers::Two(const std::string& name) {
  return Eigen::Vector2d(this->Exactly(name, 2).data());
}

Eigen::Vector3d LensNumbers::Three(const std::string& name) {
  return Eigen::Vector3d(this->Exactly(name, 3).data());
}

void LensNumbers::Finish() const {
  for (const auto& [name, numbers] : this->Values_) {
    if (this->Taken_.count(name) == 0) {
      std::string accepted;
      for (const std::string& taken : this->Taken_) {
        accepted += (accepted.empty() ? "" : ", ") + taken;
      }
      Reject(this->Label_, "'" + name + "' is unknown to this type; accepted: " + accepted);
    }
  }
}

Eigen::Vector2d TakeFocal(LensNumbers& numbers) {
  const Eigen::Vector2d focal = numbers.Two("focal");
  for (const double each : {focal.x(), focal.y()}) {
    Require(each >= 1e-3, numbers.Label(), "the focal length", each, "1e-3 pixels and more");
  }
  return focal;
}

LensPtr ScaledByFocal(const LensModel& lens, double x, double y) {
  LensValues values = lens.Values();
  values["focal"][0] *= x;
  values["focal"][1] *= y;
  std::vector<double>& center = values["center"];
  center = {ScaledPosition(center[0], x), ScaledPosition(center[1], y)};
  return MakeLens(lens.Type(), values, "scaled lens");
}

} // namespace dspace
