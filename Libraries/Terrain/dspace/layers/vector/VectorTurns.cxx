#include <dspace/layers/vector/VectorTurns.h>

#include <cmath>
#include <optional>

namespace dspace {

void Unwrap(std::vector<Eigen::Vector2d>& places, double turn, bool frames) {
  std::optional<double> given, moved; // x of the place before
  for (Eigen::Vector2d& place : places) {
    if (!(turn > 0.0) || !place.allFinite()) {
      continue;
    }
    const double x = place.x();
    if (given) {
      const bool along = frames && std::abs(std::abs(x - *given) - turn) <= 1e-9 * turn;
      const double step = along ? x - *given : std::remainder(x - *given, turn);
      place.x() = *moved + step;
    }
    given = x;
    moved = place.x();
  }
}

void BesideOf(const std::vector<Eigen::Vector2d>& other, double turn,
              std::vector<Eigen::Vector2d>& places) {
  const auto middle = [](const std::vector<Eigen::Vector2d>& ring) {
    Eigen::AlignedBox<double, 1> box;
    for (const Eigen::Vector2d& place : ring) {
      box.extend(Eigen::Matrix<double, 1, 1>(place.x()));
    }
    return box.center().x();
  };
  const double apart = middle(places) - middle(other);
  for (Eigen::Vector2d& place : places) {
    place.x() -= turn * std::round(apart / turn);
  }
}

void CloseOverPole(VectorRing& ring, double turn, const std::array<double, 2>& poles) {
  if (ring.places.size() < 3) {
    return;
  }
  const Eigen::Vector2d first = ring.places.front(), last = ring.places.back();
  if (std::abs(std::abs(last.x() - first.x()) - turn) > 1e-6 * turn) {
    return;
  }
  double sum = 0.0;
  for (const Eigen::Vector2d& place : ring.places) {
    sum += place.y();
  }
  const double mean = sum / double(ring.places.size());
  const double pole = std::abs(poles[0] - mean) < std::abs(poles[1] - mean) ? poles[0] : poles[1];
  // In steps that are no half turn, by which the way around would be lost.
  for (int k = 0; k <= 8; ++k) {
    ring.places.emplace_back(last.x() + (first.x() - last.x()) * (k / 8.0), pole);
  }
  ring.places.push_back(first);
}

} // namespace dspace
