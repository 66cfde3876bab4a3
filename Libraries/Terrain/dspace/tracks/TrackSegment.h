// The rut that a wheel leaves between two places: its cross-section and its tread.
#ifndef DSPACE_TERRAIN_TRACKSEGMENT_H
#define DSPACE_TERRAIN_TRACKSEGMENT_H

#include <limits>

#include <Eigen/Geometry>

namespace dspace {

// Across a rut, from its middle: a flat floor, a wall that rises evenly to the ground, and a rim
// above it, a parabola. The tread prints bars across the floor: it is deeper by
// treadDepth (1 - cos(2 pi s / treadPitch)) / 2, s the distance rolled there, measured along the
// wheel's heading. Metres.
struct TrackProfile {
  static constexpr double MaximumSinkage = 1.0; // [m]
  static constexpr double MaximumTread = 0.25;
  static constexpr double MaximumRim = 0.5;
  double width = 0.2;      // of the floor: the wheel's contact; > 0, at most 10
  double wall = 0.02;      // of one wall, seen from above; 0 to 2
  double rimWidth = 0.0;   // of one rim; 0 to 2
  double rimHeight = 0.0;  // 0 to MaximumRim
  double treadPitch = 0.0; // 0: no tread
  double treadDepth = 0.0; // 0 to MaximumTread

  double Reach() const { return 0.5 * this->width + this->wall + this->rimWidth; }
  bool operator==(const TrackProfile& o) const;
};

// A place where a wheel touched the ground, in the terrain's frame.
struct TrackContact {
  static constexpr double Unknown = std::numeric_limits<double>::quiet_NaN();
  Eigen::Vector2d place = Eigen::Vector2d::Zero(); // [m]
  double sinkage = 0.0;                            // [m] below the ground, 0 to MaximumSinkage
  double heading = Unknown; // [rad] counter-clockwise from X; unknown: along the path
  double rolled = Unknown;  // [m] by the wheel's rim; unknown: as far as it moved
};

// The effect on the ground at a place.
struct TrackDepth {
  float depth = 0.0f;  // [m] of the ground's surface, negative on a rim
  float weight = 0.0f; // 1 where it is rolled over, down to 0 at the top of the walls
  float aside = std::numeric_limits<float>::infinity(); // [m] of the rut, on its rim; 0 within

  // The deepest rut counts; outside of all the nearest one's rim.
  void Join(const TrackDepth& o) {
    if (o.aside < this->aside || (o.aside == this->aside && o.depth > this->depth)) {
      this->depth = o.depth;
    }
    this->aside = o.aside < this->aside ? o.aside : this->aside;
    this->weight = o.weight > this->weight ? o.weight : this->weight;
  }
};

// Between two contacts all values change evenly; the ends are round.
class TrackSegment {
public:
  // `stretch`: metres of the tracks' plane per metre of the profile, at most; for Box().
  TrackSegment(const TrackProfile& profile, const TrackContact& from, const TrackContact& to,
               double stretch = 1.0);

  // False beyond its reach. `scale`: metres of the tracks' plane per metre on the ground there.
  bool At(const Eigen::Vector2d& place, TrackDepth& depth, double scale = 1.0) const;
  Eigen::AlignedBox2d Box() const; // all that it reaches

private:
  TrackProfile Profile_;
  TrackContact From_;
  TrackContact To_;
  Eigen::Vector2d Along_;
  double Squared_; // length
  double Stretch_;
  Eigen::Vector2d FromHeading_;
  Eigen::Vector2d ToHeading_;
};

} // namespace dspace

#endif
