// Position and velocity of a point.
#ifndef DSPACE_ANALYSIS_STATE_H
#define DSPACE_ANALYSIS_STATE_H

#include <Eigen/Core>

namespace dspace {

struct State {
  Eigen::Vector3d position = Eigen::Vector3d::Zero(); // [m]
  Eigen::Vector3d velocity = Eigen::Vector3d::Zero(); // [m/s]

  State& operator+=(const State& other) {
    this->position += other.position;
    this->velocity += other.velocity;
    return *this;
  }
  State& operator-=(const State& other) {
    this->position -= other.position;
    this->velocity -= other.velocity;
    return *this;
  }
};

inline State operator+(State a, const State& b) {
  return a += b;
}

inline State operator-(State a, const State& b) {
  return a -= b;
}

} // namespace dspace

#endif
