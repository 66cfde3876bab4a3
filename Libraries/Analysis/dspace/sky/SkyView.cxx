#include <dspace/sky/SkyView.h>

#include <cmath>

#include <Eigen/Geometry>

#include <dspace/Checks.h>
#include <dspace/ephemeris/BodyNames.h>
#include <dspace/orientation/BodyConstants.h>

namespace dspace {
namespace {

constexpr int MostIterations = 10;

// Radii of bodies that have none stay unknown.
double LargestRadius(const Frames& frames, int body) {
  try {
    return BodyRadii(frames.Pool(), body).maxCoeff();
  } catch (const Error& error) {
    if (error.GetKind() != Error::Kind::NotFound) {
      throw;
    }
    return 0.0;
  }
}

} // namespace

Eigen::Vector3d Aberrated(const Eigen::Vector3d& toTarget, const Eigen::Vector3d& velocity) {
  const Eigen::Vector3d axis = toTarget.normalized().cross(velocity / SpeedOfLight);
  const double sine = axis.norm();
  if (sine == 0.0) {
    return toTarget;
  }
  return Eigen::AngleAxisd(std::asin(sine), axis / sine) * toTarget;
}

Sighting Sight(const Ephemeris& ephemeris, int target, const State& observer, double tdb) {
  Sighting out;
  for (int i = 0; i < MostIterations; ++i) {
    out.state = ephemeris.FromBarycenter(target, tdb - out.lightTime) - observer;
    const double before = out.lightTime;
    out.lightTime = out.state.position.norm() / SpeedOfLight;
    if (std::abs(out.lightTime - before) <= 1e-10 * out.lightTime) {
      break;
    }
  }
  return out;
}

SightedPoint SightPoint(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& from,
                        const std::function<SkyPlace(double tdb)>& point, double tdb) {
  const bool apart = point(tdb).body != from.body;
  const auto stateOf = [&](const SkyPlace& place, double at) {
    return apart ? PlaceState(ephemeris, frames, place, at) : StateAboutBody(frames, place, at);
  };
  SightedPoint seen;
  seen.observer = stateOf(from, tdb);
  for (int i = 0; i < MostIterations; ++i) {
    const double left = tdb - seen.lightTime;
    seen.place = point(left);
    seen.away = stateOf(seen.place, left).position - seen.observer.position;
    const double before = seen.lightTime;
    seen.lightTime = seen.away.norm() / SpeedOfLight;
    if (std::abs(seen.lightTime - before) <= 1e-10 * seen.lightTime) {
      break;
    }
  }
  return seen;
}

double ElevationFrom(const Frames& frames, const SightedPoint& seen, double tdb) {
  const SkyPlace& place = seen.place;
  return ToAzimuthElevation(
             place.axes.toLocal *
             (frames.Rotation("J2000", place.frame, tdb - seen.lightTime) * -seen.away))
      .elevation_deg;
}

State StateAboutBody(const Frames& frames, const SkyPlace& place, double tdb) {
  return frames.Turn(place.frame, "J2000", tdb) *
         State{place.axes.position, Eigen::Vector3d::Zero()};
}

State PlaceState(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place,
                 double tdb) {
  return ephemeris.FromBarycenter(place.body, tdb) + StateAboutBody(frames, place, tdb);
}

SkyBody Look(const Ephemeris& ephemeris, const Frames& frames, const SkyPlace& place, int target,
             double tdb) {
  if (target == place.body) {
    Reject("body '" + ephemeris.Names().NameOf(target) + "'",
           "it is the body of the site; accepted: another one");
  }
  const State observer = PlaceState(ephemeris, frames, place, tdb);
  const Sighting sighting = Sight(ephemeris, target, observer, tdb);
  const Eigen::Vector3d apparent = Aberrated(sighting.state.position, observer.velocity);
  SkyBody out;
  out.eastNorthUp =
      (place.axes.toLocal * (frames.Rotation("J2000", place.frame, tdb) * apparent)).normalized();
  out.direction = ToAzimuthElevation(out.eastNorthUp);
  out.range = sighting.state.position.norm();
  out.lightTime = sighting.lightTime;
  const double radius = LargestRadius(frames, target);
  if (radius > 0.0) {
    out.radius_deg = std::asin(std::min(1.0, radius / out.range)) * 180.0 / M_PI;
  }
  if (target != BodySun) {
    // The light that arrives now left the target then, and the Sun before.
    const double left = tdb - sighting.lightTime;
    const Eigen::Vector3d toSun =
        Sight(ephemeris, BodySun, ephemeris.FromBarycenter(target, left), left).state.position;
    const double cosine = toSun.normalized().dot(-sighting.state.position.normalized());
    out.litFraction = 0.5 * (1.0 + cosine);
  }
  return out;
}

} // namespace dspace
