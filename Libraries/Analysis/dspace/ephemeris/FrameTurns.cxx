#include <dspace/ephemeris/FrameTurns.h>

#include <cmath>

#include <dspace/Error.h>

namespace dspace {
namespace {

constexpr const char* Accepted = "accepted: J2000, ECLIPJ2000";

// Components in J2000 to those in the ecliptic of J2000: the IAU 1980 obliquity 84381.448".
const Eigen::Matrix3d& EclipticFromJ2000() {
  static const Eigen::Matrix3d turn = [] {
    const double obliquity = 84381.448 / 3600.0 * M_PI / 180.0;
    Eigen::Matrix3d matrix;
    matrix << 1.0, 0.0, 0.0,                           //
        0.0, std::cos(obliquity), std::sin(obliquity), //
        0.0, -std::sin(obliquity), std::cos(obliquity);
    return matrix;
  }();
  return turn;
}

void RequireKnown(int frame) {
  if (frame != FrameJ2000 && frame != FrameEclipJ2000) {
    throw Error(Error::Kind::NotFound, "frame " + std::to_string(frame),
                std::string("it is unknown; ") + Accepted);
  }
}

} // namespace

int InertialTurns::FrameId(const std::string& name) const {
  if (name == "J2000") {
    return FrameJ2000;
  }
  if (name == "ECLIPJ2000") {
    return FrameEclipJ2000;
  }
  throw Error(Error::Kind::NotFound, "frame '" + name + "'",
              std::string("it is unknown; ") + Accepted);
}

std::string InertialTurns::FrameName(int frame) const {
  return frame == FrameJ2000        ? "J2000"
         : frame == FrameEclipJ2000 ? "ECLIPJ2000"
                                    : "frame " + std::to_string(frame);
}

bool InertialTurns::IsInertial(int frame) const {
  RequireKnown(frame);
  return true;
}

int InertialTurns::Center(int frame) const {
  RequireKnown(frame);
  return 0;
}

StateTurn InertialTurns::Turn(int from, int to, double /*tdb*/) const {
  RequireKnown(from);
  RequireKnown(to);
  StateTurn turn;
  if (from != to) {
    turn.rotation = EclipticFromJ2000();
    if (from == FrameEclipJ2000) {
      turn.rotation.transposeInPlace();
    }
  }
  return turn;
}

} // namespace dspace
