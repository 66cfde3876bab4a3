// The margins of a line of sight over ground and beside triangles.
#ifndef DSPACE_MEASURE_SIGHT_LINE_H
#define DSPACE_MEASURE_SIGHT_LINE_H

#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/measure/Obstacles.h>

namespace dspace {

// A line between two places that differ. Margins over ground are found by lowering or raising the
// line in its vertical plane until a ray just meets the ground, which every ray tells exactly: the
// line and the local verticals at its ends span the plane. What a margin is:
//   Height()  both ends are moved along their verticals by the same length. The result is the least
//             height of the line above the ground, and where that is negative the greatest depth.
//   Angle()   the line turns about its start. Only ground before the vertical of its end counts.
//   Fresnel() the line bends as the first Fresnel zone does, in 32 chords (0.1 % of its radius).
// All are +infinity where there is no ground below.
class SightLine {
public:
  // Keeps a reference to `obstacles`. Throws what Obstacles::Stand throws; the labels name the
  // places.
  SightLine(const Obstacles& obstacles, const Eigen::Vector3d& from_R, const Eigen::Vector3d& to_R,
            const std::string& fromLabel, const std::string& toLabel);

  double Range() const { return (this->To_ - this->From_).norm(); } // [m]
  const Obstacles::Hit& First() const { return this->First_; }

  double Height() const;                   // [m], to 1e-6 of itself, at least 1e-6 m
  double Angle() const;                    // [deg] at the start, to 1e-8 deg
  double Fresnel(double wavelength) const; // of the zone's radius, to 1e-3 of itself

  // The triangles: the distance from the nearest one, and the angle at the start between the line
  // and its point.
  struct Beside {
    double distance = std::numeric_limits<double>::infinity(); // [m]
    double angle_deg = std::numeric_limits<double>::infinity();
  };
  Beside Solids() const;

private:
  // A point of the line that moves: where it is in the line, 0 to 1, and how much it moves.
  struct Joint {
    double place = 0.0;
    double weight = 0.0; // [m]
  };
  class Course; // of the line over one ground
  std::vector<Course> Courses() const;

  const Obstacles& Obstacles_;
  Eigen::Vector3d From_;
  Eigen::Vector3d To_;
  std::string FromLabel_;
  std::string ToLabel_;
  Obstacles::Hit First_;
};

} // namespace dspace

#endif
