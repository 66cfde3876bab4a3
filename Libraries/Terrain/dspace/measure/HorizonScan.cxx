#include <dspace/measure/HorizonScan.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace dspace {
namespace {

using V = Eigen::Vector3d;
constexpr double Degree = M_PI / 180.0;
constexpr double Accuracy_deg = 1e-6;

// One ground, azimuth after azimuth.
class GroundScan {
public:
  GroundScan(const Obstacles& obstacles, const Obstacles::Ground& ground, const V& place_R,
             const LevelAxes& axes, const std::string& label)
      : Obstacles_(obstacles), Ground_(ground), Place_(obstacles.Stand(ground, place_R, label)),
        IsOver_(std::isfinite(Obstacles::HeightOver(ground, this->Place_))), Axes_(axes) {
    const Eigen::Quaterniond toGround = ground.X_RS.rotation.conjugate();
    for (V* axis : {&this->Axes_.east, &this->Axes_.north, &this->Axes_.up}) {
      *axis = toGround * *axis;
    }
  }

  HorizonPoint Find(double azimuth) { // [rad]
    this->Level_ = std::sin(azimuth) * this->Axes_.east + std::cos(azimuth) * this->Axes_.north;
    this->Best_ = {};
    double low = -90.0; // meets the ground, if anything does
    double high = 90.0; // meets nothing
    if (this->IsOver_) {
      this->Bracket(low, high);
    } else if (!this->Search(low, high)) {
      return {};
    }
    while (high - low > Accuracy_deg) {
      const double middle = 0.5 * (low + high);
      (this->Meets(middle) ? low : high) = middle;
    }
    if (!this->Best_.hit && !this->Meets(low)) {
      return {};
    }
    this->Last_ = low;
    this->HasLast_ = true;
    HorizonPoint point;
    point.elevation_deg = low;
    point.distance = this->Ground_.X_RS.scale * this->Best_.distance;
    point.point = this->Ground_.X_RS.Apply(this->Best_.position_S);
    return point;
  }

private:
  // Keeps the hit of the highest ray that met the ground.
  bool Meets(double elevation) {
    this->Obstacles_.Check();
    const V direction =
        std::cos(elevation * Degree) * this->Level_ + std::sin(elevation * Degree) * this->Axes_.up;
    const RayHit hit = this->Ground_.surface->Intersect(this->Place_, direction);
    if (hit.hit) {
      this->Best_ = hit;
    }
    return hit.hit;
  }

  // From the last azimuth's elevation in growing steps.
  void Bracket(double& low, double& high) {
    double step = 0.05;
    double at = this->HasLast_ ? this->Last_ : 0.0;
    if (this->Meets(at)) {
      low = at;
      for (at += step; at < high; step *= 4.0, at += step) {
        if (!this->Meets(at)) {
          high = at;
          return;
        }
        low = at;
      }
    } else {
      high = at;
      for (at -= step; at > low; step *= 4.0, at -= step) {
        if (this->Meets(at)) {
          low = at;
          return;
        }
        high = at;
      }
    }
  }

  bool Search(double& low, double& high) {
    constexpr double Step = 0.25;
    for (double at = 90.0; at >= -90.0; at -= Step) {
      if (this->Meets(at)) {
        low = at;
        return true;
      }
      high = at;
    }
    return false;
  }

  const Obstacles& Obstacles_;
  const Obstacles::Ground& Ground_;
  V Place_;
  bool IsOver_; // the place is over data
  LevelAxes Axes_;
  V Level_ = V::Zero();
  RayHit Best_;
  double Last_ = 0.0;
  bool HasLast_ = false;
};

// Raises the horizon where the triangle stands above it. Its corners are (east, north, up) from the
// place.
void AddTriangle(const std::array<V, 3>& corners, std::uint32_t object, const V& place_R,
                 const LevelAxes& axes, std::vector<HorizonPoint>& horizon) {
  const auto cross = [&](int i, int j) {
    return corners[i].x() * corners[j].y() - corners[i].y() * corners[j].x();
  };
  const std::array<double, 3> around = {cross(0, 1), cross(1, 2), cross(2, 0)};
  const bool above = (around[0] >= 0.0 && around[1] >= 0.0 && around[2] >= 0.0) ||
                     (around[0] <= 0.0 && around[1] <= 0.0 && around[2] <= 0.0);
  const auto count = std::int64_t(horizon.size());
  std::int64_t first = 0;
  std::int64_t last = count - 1;
  if (!above) { // it does not cross the vertical: its azimuths span less than half a turn
    const double start = std::atan2(corners[0].x(), corners[0].y());
    double least = 0.0;
    double greatest = 0.0;
    for (int i = 1; i < 3; ++i) {
      const double turn =
          std::remainder(std::atan2(corners[i].x(), corners[i].y()) - start, 2.0 * M_PI);
      least = std::min(least, turn);
      greatest = std::max(greatest, turn);
    }
    if (greatest - least < M_PI) {
      first = std::int64_t(std::floor((start + least) / (2.0 * M_PI) * double(count))) - 1;
      last =
          std::min(first + count - 1,
                   std::int64_t(std::ceil((start + greatest) / (2.0 * M_PI) * double(count))) + 1);
    }
  }
  for (std::int64_t k = first; k <= last; ++k) {
    const std::int64_t bin = ((k % count) + count) % count;
    const double azimuth = 2.0 * M_PI * double(bin) / double(count);
    const double sine = std::sin(azimuth);
    const double cosine = std::cos(azimuth);
    HorizonPoint& best = horizon[std::size_t(bin)];
    const auto offer = [&](double out, double up) { // a point of the half-plane
      if (out < 0.0 || (out == 0.0 && up <= 0.0)) {
        return;
      }
      const double elevation = std::atan2(up, out) / Degree;
      if (elevation > best.elevation_deg) {
        best.elevation_deg = elevation;
        best.distance = std::hypot(out, up);
        best.point = place_R + out * (sine * axes.east + cosine * axes.north) + up * axes.up;
        best.object = object;
      }
    };
    std::array<V, 3> cuts; // (out, up) of the points in the plane
    int n = 0;
    for (int i = 0; i < 3; ++i) {
      const V& a = corners[i];
      const V& b = corners[(i + 1) % 3];
      const double sideA = a.x() * cosine - a.y() * sine;
      const double sideB = b.x() * cosine - b.y() * sine;
      if (sideA == 0.0) {
        offer(a.x() * sine + a.y() * cosine, a.z());
      }
      if ((sideA <= 0.0 && sideB >= 0.0) || (sideA >= 0.0 && sideB <= 0.0)) {
        if (sideA == sideB) {
          continue;
        }
        const V p = a + sideA / (sideA - sideB) * (b - a);
        cuts[n++] = {p.x() * sine + p.y() * cosine, p.z(), 0.0};
        offer(cuts[n - 1].x(), cuts[n - 1].y());
      }
    }
    for (int i = 0; i < n; ++i) { // where a cut crosses the vertical
      const V& a = cuts[i];
      const V& b = cuts[(i + 1) % n];
      if ((a.x() < 0.0) != (b.x() < 0.0)) {
        offer(0.0, a.y() + a.x() / (a.x() - b.x()) * (b.y() - a.y()));
      }
    }
  }
}

} // namespace

std::vector<HorizonPoint> ScanHorizon(const Obstacles& obstacles, const V& place_R,
                                      const LevelAxes& axes, std::size_t count,
                                      const std::string& label,
                                      const std::function<void(double)>& progress) {
  std::vector<HorizonPoint> horizon(count);
  const double parts = double(obstacles.Grounds().size() + obstacles.Solids().size());
  double done = 0.0;
  for (const Obstacles::Ground& ground : obstacles.Grounds()) {
    GroundScan scan(obstacles, ground, place_R, axes, label);
    for (std::size_t k = 0; k < count; ++k) {
      if (progress) {
        progress((done + double(k) / double(count)) / parts);
      }
      const HorizonPoint found = scan.Find(2.0 * M_PI * double(k) / double(count));
      if (found.elevation_deg > horizon[k].elevation_deg || !std::isfinite(horizon[k].distance)) {
        horizon[k] = found;
      }
    }
    ++done;
  }
  Eigen::Matrix3d toLevel;
  toLevel << axes.east.transpose(), axes.north.transpose(), axes.up.transpose();
  for (const Obstacles::Solid& solid : obstacles.Solids()) {
    if (progress) {
      progress(done++ / parts);
    }
    constexpr int Together = 64; // triangles between two checks
    int triangle = 0;
    Eigen::Affine3d X_LM = solid.X_RM;
    X_LM.pretranslate(-place_R).prerotate(toLevel);
    solid.rays->ForEach([&](const V& a, const V& b, const V& c) {
      if (triangle++ % Together == 0) {
        obstacles.Check();
      }
      AddTriangle({X_LM * a, X_LM * b, X_LM * c}, solid.id, place_R, axes, horizon);
    });
  }
  return horizon;
}

} // namespace dspace
