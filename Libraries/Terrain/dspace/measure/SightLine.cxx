#include <dspace/measure/SightLine.h>

#include <algorithm>
#include <cmath>

namespace dspace {
namespace {

constexpr double Unlimited = std::numeric_limits<double>::infinity();
constexpr double Degrees = 180.0 / M_PI;

double AngleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
  return std::atan2(a.cross(b).norm(), a.dot(b));
}

} // namespace

// In the ground's frame S, whose lengths are `Scale` root metres.
class SightLine::Course {
public:
  Course(const Obstacles& obstacles, const Obstacles::Ground& ground, const Eigen::Vector3d& from_S,
         const Eigen::Vector3d& to_S)
      : Obstacles_(obstacles), Ground_(ground), From_(from_S), To_(to_S) {
    // Known heights limit the search, and tell where the line is below ground that ends.
    constexpr int Samples = 16;
    for (int i = 0; i <= Samples; ++i) {
      const double place = double(i) / Samples;
      obstacles.Check();
      const double height = Obstacles::HeightOver(ground, this->At(place));
      if (std::isfinite(height)) {
        this->Known_.push_back({place, height});
      }
    }
  }

  // Of how many chords a line consists that follows its local verticals when it is lowered.
  int Chords() const {
    const TerrainSurface& surface = *this->Ground_.surface;
    return surface.Up(this->From_).dot(surface.Up(this->To_)) > 1.0 - 1e-6 ? 1 : 16;
  }

  // The greatest number by which the joints' weights can be multiplied so that the line that is
  // lowered by the products is clear of the ground; negative where the line is blocked.
  double Margin(const std::vector<Joint>& joints, double accuracy) const {
    double low = 0.0;
    double high = Unlimited;
    for (const auto& [place, height] : this->Known_) {
      const double weight = WeightAt(joints, place);
      if (weight > 0.0) {
        high = std::min(high, height / weight);
      }
    }
    if (high > 0.0 && !this->IsBlocked(joints, 0.0)) {
      if (std::isfinite(high)) {
        if (!this->IsBlocked(joints, high * (1.0 - 1e-9))) {
          return high;
        }
      } else {
        high = First;
        while (!this->IsBlocked(joints, high)) {
          low = high;
          high *= 4.0;
          if (high > Most) {
            return Unlimited;
          }
        }
      }
    } else {
      double step = std::max(First, high < 0.0 ? -high : 0.0);
      high = 0.0;
      low = -step;
      while (this->IsBlocked(joints, low)) {
        if (step > Most) {
          return -Unlimited;
        }
        high = low;
        step *= 2.0;
        low = -step;
      }
    }
    while (high - low > std::max(1e-6, accuracy * std::max(std::abs(low), std::abs(high)))) {
      const double middle = 0.5 * (low + high);
      (this->IsBlocked(joints, middle) ? high : low) = middle;
    }
    return 0.5 * (low + high);
  }

  // By how much the line can be turned down about its start until it meets the ground before the
  // vertical of its end; negative: must be turned up until it is clear. [deg]
  double Angle() const {
    const TerrainSurface& surface = *this->Ground_.surface;
    const Eigen::Vector3d up = surface.Up(this->From_);
    const Eigen::Vector3d line = this->To_ - this->From_;
    const double length = line.norm();
    Eigen::Vector3d level = line - line.dot(up) * up;
    const double across = level.norm();
    const bool isVertical = !(across > 1e-9 * length);
    level = isVertical ? surface.North(this->From_) : Eigen::Vector3d(level / across);
    const double elevation = std::atan2(line.dot(up), line.dot(level)) * Degrees;
    const auto isBlocked = [&](double at) {
      this->Obstacles_.Check();
      const Eigen::Vector3d direction =
          std::cos(at / Degrees) * level + std::sin(at / Degrees) * up;
      const double limit = isVertical ? length : across / std::cos(at / Degrees);
      return surface.Intersect(this->From_, direction, limit).hit;
    };
    double low = -90.0; // meets the ground
    double high = 90.0; // meets nothing
    if (isBlocked(elevation)) {
      low = elevation;
    } else if (std::isfinite(Obstacles::HeightOver(this->Ground_, this->From_))) {
      // Every ray below one that meets the ground meets it too.
      high = elevation;
      if (!isBlocked(low)) {
        return Unlimited;
      }
    } else {
      constexpr double Step = 0.25; // ground that ends may be passed below
      high = elevation;
      low = high - Step;
      while (low > -90.0 && !isBlocked(low)) {
        high = low;
        low -= Step;
      }
      if (low <= -90.0) {
        return Unlimited;
      }
    }
    constexpr double Accuracy_deg = 1e-8;
    while (high - low > Accuracy_deg) {
      const double middle = 0.5 * (low + high);
      (isBlocked(middle) ? low : high) = middle;
    }
    return elevation - 0.5 * (low + high);
  }

private:
  static constexpr double First = 1e-3; // [m] of a search without any known height
  static constexpr double Most = 1e10;

  Eigen::Vector3d At(double place) const { return this->From_ + place * (this->To_ - this->From_); }
  Eigen::Vector3d Lowered(const Joint& joint, double factor) const {
    const Eigen::Vector3d p = this->At(joint.place);
    return p - (factor * joint.weight / this->Ground_.X_RS.scale) * this->Ground_.surface->Up(p);
  }
  static double WeightAt(const std::vector<Joint>& joints, double place) {
    std::size_t k = 1;
    while (k + 1 < joints.size() && joints[k].place < place) {
      ++k;
    }
    const Joint& a = joints[k - 1];
    const Joint& b = joints[k];
    return a.weight + (place - a.place) / (b.place - a.place) * (b.weight - a.weight);
  }
  bool IsBlocked(const std::vector<Joint>& joints, double factor) const {
    for (const auto& [place, height] : this->Known_) {
      if (height < factor * WeightAt(joints, place)) {
        return true;
      }
    }
    Eigen::Vector3d from = this->Lowered(joints.front(), factor);
    for (std::size_t k = 1; k < joints.size(); ++k) {
      const Eigen::Vector3d to = this->Lowered(joints[k], factor);
      const double length = (to - from).norm();
      this->Obstacles_.Check();
      if (length > 0.0 && this->Ground_.surface->Intersect(from, to - from, length).hit) {
        return true;
      }
      from = to;
    }
    return false;
  }

  const Obstacles& Obstacles_;
  const Obstacles::Ground& Ground_;
  Eigen::Vector3d From_;
  Eigen::Vector3d To_;
  std::vector<std::pair<double, double>> Known_; // place, height [root metres]
};

SightLine::SightLine(const Obstacles& obstacles, const Eigen::Vector3d& from_R,
                     const Eigen::Vector3d& to_R, const std::string& fromLabel,
                     const std::string& toLabel)
    : Obstacles_(obstacles), From_(from_R), To_(to_R), FromLabel_(fromLabel), ToLabel_(toLabel),
      First_(obstacles.First(from_R, to_R, fromLabel, toLabel)) {}

std::vector<SightLine::Course> SightLine::Courses() const {
  std::vector<Course> courses;
  for (const Obstacles::Ground& ground : this->Obstacles_.Grounds()) {
    courses.emplace_back(this->Obstacles_, ground,
                         this->Obstacles_.Stand(ground, this->From_, this->FromLabel_),
                         this->Obstacles_.Stand(ground, this->To_, this->ToLabel_));
  }
  return courses;
}

double SightLine::Height() const {
  double least = Unlimited;
  for (const Course& course : this->Courses()) {
    std::vector<Joint> joints;
    const int chords = course.Chords();
    for (int i = 0; i <= chords; ++i) {
      joints.push_back({double(i) / chords, 1.0});
    }
    least = std::min(least, course.Margin(joints, 1e-6));
  }
  return least;
}

double SightLine::Angle() const {
  double least = Unlimited;
  for (const Course& course : this->Courses()) {
    least = std::min(least, course.Angle());
  }
  return least;
}

double SightLine::Fresnel(double wavelength) const {
  // The radius at distances d1 and d2 from the ends is sqrt(wavelength d1 d2 / (d1 + d2)): half a
  // circle over the line, stretched.
  constexpr int Chords = 32;
  std::vector<Joint> joints;
  for (int i = 0; i <= Chords; ++i) {
    const double angle = M_PI * i / Chords;
    const double place = i == 0 ? 0.0 : i == Chords ? 1.0 : 0.5 * (1.0 - std::cos(angle));
    const double weight =
        i == 0 || i == Chords ? 0.0 : 0.5 * std::sqrt(wavelength * this->Range()) * std::sin(angle);
    joints.push_back({place, weight});
  }
  double least = Unlimited;
  for (const Course& course : this->Courses()) {
    least = std::min(least, course.Margin(joints, 1e-4));
  }
  return least;
}

SightLine::Beside SightLine::Solids() const {
  Beside best;
  for (const Obstacles::Solid& solid : this->Obstacles_.Solids()) {
    this->Obstacles_.Check();
    const MeshRays::Near found =
        solid.rays->Nearest(solid.X_RM, this->From_, this->To_, best.distance);
    if (found.distance < best.distance) {
      best.distance = found.distance;
      best.angle_deg = AngleBetween(this->To_ - this->From_, found.point - this->From_) * Degrees;
    }
  }
  return best;
}

} // namespace dspace
