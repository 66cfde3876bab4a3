#include <dspace/sky/SubPoints.h>

#include <cmath>

#include <dspace/Checks.h>
#include <dspace/ephemeris/BodyNames.h>
#include <dspace/orientation/BodyConstants.h>
#include <dspace/orientation/Site.h>
#include <dspace/sky/SkyView.h>

namespace dspace {
namespace {

// The point below `direction` (J2000) at `epoch`.
SubPoint Below(const Frames& frames, int body, const std::string& frame, double epoch,
               const Eigen::Vector3d& direction) {
  const Eigen::Vector3d radii = BodyRadii(frames.Pool(), body);
  const Eigen::Vector3d d = (frames.Rotation("J2000", frame, epoch) * direction).normalized();
  const LongitudeLatitude place = ToLongitudeLatitude(d);
  SubPoint out;
  out.longitude_deg = place.longitude_deg;
  out.latitude_deg = place.latitude_deg;
  out.geodetic_latitude_deg = GeodeticLatitude(place.latitude_deg, radii);
  out.position = d / d.cwiseQuotient(radii).norm();
  out.epoch = epoch;
  return out;
}

std::string FrameOf(const Frames& frames, int body, const std::string& frame) {
  return frame.empty() ? frames.Table().BodyFixed(body).name : frame;
}

void RequireOther(const Ephemeris& ephemeris, int body, int other) {
  if (body == other) {
    Reject("body '" + ephemeris.Names().NameOf(body) + "'",
           "a point below itself is asked for; accepted: another body");
  }
}

// A target as an observer sees it with a correction, J2000.
Sighting Seen(const Ephemeris& ephemeris, int target, const State& observer, double tdb,
              Correction correction) {
  if (correction == Correction::None) {
    return {ephemeris.FromBarycenter(target, tdb) - observer, 0.0};
  }
  Sighting seen = Sight(ephemeris, target, observer, tdb);
  if (HasStar(correction)) {
    seen.state.position = Aberrated(seen.state.position, observer.velocity);
  }
  return seen;
}

// The Sun's direction as it arrives at the body's centre.
Eigen::Vector3d SunFrom(const Ephemeris& ephemeris, int body, double epoch, Correction correction) {
  const State at = ephemeris.FromBarycenter(body, epoch);
  return Seen(ephemeris, BodySun, at, epoch, correction).state.position;
}

} // namespace

SubPoint SubSolarPoint(const Ephemeris& ephemeris, const Frames& frames, int body,
                       const std::string& frame, double tdb, std::optional<int> observer,
                       Correction correction) {
  RequireOther(ephemeris, body, BodySun);
  const std::string axes = FrameOf(frames, body, frame);
  if (!observer) {
    return Below(frames, body, axes, tdb, SunFrom(ephemeris, body, tdb, correction));
  }
  RequireOther(ephemeris, body, *observer);
  const State eye = ephemeris.FromBarycenter(*observer, tdb);
  SubPoint out;
  double lightTime = Seen(ephemeris, body, eye, tdb, correction).lightTime; // of the centre
  for (int i = 0; i < 3; ++i) {
    const double epoch = tdb - lightTime;
    out = Below(frames, body, axes, epoch, SunFrom(ephemeris, body, epoch, correction));
    if (correction == Correction::None) {
      break;
    }
    const Eigen::Vector3d point = ephemeris.FromBarycenter(body, epoch).position +
                                  frames.Rotation(axes, "J2000", epoch) * out.position;
    lightTime = (point - eye.position).norm() / SpeedOfLight;
  }
  return out;
}

SubPoint SubObserverPoint(const Ephemeris& ephemeris, const Frames& frames, int body,
                          const std::string& frame, int observer, double tdb,
                          Correction correction) {
  RequireOther(ephemeris, body, observer);
  const std::string axes = FrameOf(frames, body, frame);
  const State eye = ephemeris.FromBarycenter(observer, tdb);
  const Sighting sighting = Seen(ephemeris, body, eye, tdb, correction);
  const Eigen::Vector3d back = -sighting.state.position;
  if (correction == Correction::None) {
    return Below(frames, body, axes, tdb, back);
  }
  const double radius = BodyRadii(frames.Pool(), body).maxCoeff();
  // The point is nearer than the centre by about a radius.
  return Below(frames, body, axes, tdb - sighting.lightTime + radius / SpeedOfLight, back);
}

} // namespace dspace
