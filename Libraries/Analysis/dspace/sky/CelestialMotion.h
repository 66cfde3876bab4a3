// Frames of a scene that move with time: bodies, spacecraft and sites.
#ifndef DSPACE_SKY_CELESTIAL_MOTION_H
#define DSPACE_SKY_CELESTIAL_MOTION_H

#include <optional>
#include <string>

#include <dspace/Pose.h>
#include <dspace/orientation/Site.h>
#include <dspace/sky/KernelSet.h>
#include <dspace/sky/SkyView.h>

namespace dspace {

// What a frame stands for: its origin and its axes.
struct CelestialPlace {
  int body = 0;             // NAIF id at the origin, or whose site the origin is
  std::string axes;         // reference frame; with a site the body-fixed frame of its coordinates
  std::optional<Site> site; // then the axes are east, north, up of the site
};

// A place in a scene as Look takes it: `offset` [m] and the axes `toLocal` are those of a frame
// that hangs on the place's frame: its pose in it.
SkyPlace SkyPlaceOf(const KernelSet& kernels, const CelestialPlace& place,
                    const Pose& X_PlaceFrame);

// X_PF at `tdb`: the pose of the frame that stands for `place` in one that stands for `parent`,
// both at this time: positions are geometric (Correction::None) or as `correction` shows the
// place's body from the parent's. Between places of one body in the same axes no ephemeris is
// asked, so that sites keep their precision. Throws what Ephemeris and Frames throw.
Pose PoseOf(const KernelSet& kernels, const CelestialPlace& place, const CelestialPlace& parent,
            Correction correction, double tdb);

// The Sun as it shines on a place's origin.
struct SunAt {
  Eigen::Vector3d direction; // unit, towards it, in the place's axes (with a site: east, north, up)
  double distance = 0.0;     // [m]
  double radius_deg = 0.0;   // of its disc
};
SunAt SunAtPlace(const KernelSet& kernels, const CelestialPlace& place, double tdb);

} // namespace dspace

#endif
