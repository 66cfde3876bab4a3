#include <dspace/sky/CelestialMotion.h>

#include <dspace/Checks.h>
#include <dspace/ephemeris/BodyNames.h>
#include <dspace/orientation/BodyConstants.h>

namespace dspace {
namespace {

LocalAxes LocalOf(const KernelSet& kernels, const CelestialPlace& place) {
  if (place.site) {
    return AxesAt(*place.site, BodyRadii(kernels.Pool(), place.body));
  }
  return {Eigen::Vector3d::Zero(), Eigen::Matrix3d::Identity()};
}

} // namespace

SkyPlace SkyPlaceOf(const KernelSet& kernels, const CelestialPlace& place, const Pose& X) {
  SkyPlace out;
  out.body = place.body;
  out.frame = place.axes;
  const LocalAxes local = LocalOf(kernels, place);
  out.axes.position = local.position + local.toLocal.transpose() * X.position;
  out.axes.toLocal = X.rotation.toRotationMatrix().transpose() * local.toLocal;
  return out;
}

Pose PoseOf(const KernelSet& kernels, const CelestialPlace& place, const CelestialPlace& parent,
            Correction correction, double tdb) {
  const Frames& frames = kernels.GetFrames();
  const LocalAxes local = LocalOf(kernels, place);
  const LocalAxes base = LocalOf(kernels, parent);
  const Eigen::Matrix3d turn = frames.Rotation(place.axes, parent.axes, tdb);
  // From the parent's body to the place, in the parent's reference axes.
  Eigen::Vector3d position = turn * local.position - base.position;
  if (place.body != parent.body) {
    Ephemeris::Query query;
    query.target = place.body;
    query.observer = parent.body;
    query.correction = correction;
    query.frame = "J2000";
    position += frames.Rotation("J2000", parent.axes, tdb) *
                kernels.GetEphemeris().Find(query, tdb).state.position;
  }
  Pose X_PF;
  X_PF.position = base.toLocal * position;
  X_PF.rotation =
      Eigen::Quaterniond(Eigen::Matrix3d(base.toLocal * turn * local.toLocal.transpose()))
          .normalized();
  return X_PF;
}

SunAt SunAtPlace(const KernelSet& kernels, const CelestialPlace& place, double tdb) {
  const SkyBody sun = Look(kernels.GetEphemeris(), kernels.GetFrames(),
                           SkyPlaceOf(kernels, place, Pose()), BodySun, tdb);
  return {sun.eastNorthUp, sun.range, sun.radius_deg};
}

} // namespace dspace
