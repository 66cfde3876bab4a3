// A planet, a moon or the Sun.
#ifndef DSPACE_SCENE_CELESTIAL_BODY_H
#define DSPACE_SCENE_CELESTIAL_BODY_H

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/scene/CustomGeometry.h>
#include <dspace/scene/bodies/Atmosphere.h>

namespace dspace {

// A ring of even density in the plane of the body's equator.
struct RingBand {
  double inner = 0.0; // radii [m]
  double outer = 0.0;
  double opticalDepth = 1.0;               // along the normal, 0 to 100
  std::array<double, 3> color = {1, 1, 1}; // sRGB: of a surface of its matter, Lambertian
};

// The shape of a body, in its frame: X to longitude 0, Z to the north pole.
struct BodyShape {
  Eigen::Vector3d radii = Eigen::Vector3d::Ones(); // of an ellipsoid [m], 1 to 1e12
  // Of a texture in plate carree: the longitude [deg, east] of its left edge. Its rows are
  // planetocentric latitudes, or geodetic ones (of the normal).
  double leftEdge_deg = -180.0;
  bool geodetic = false;
  double brightness = 1.0; // multiplies colour and texture in linear light, 0 to 1000
  // As a star is drawn, where the disc has a radius below CelestialBody::PointRadius: a factor on
  // its light in pictures for the eye, 0 to 1e12, and the standard deviation of the point spread
  // [pixels], 0 (none) to 20. Both fade up to CelestialBody::DiscRadius. Not for the Sun.
  double pointGain = 1.0;
  double pointSpread = 0.0;
  // The light of the name "sun" comes from it, and its disc shines as bright as that light is.
  bool sun = false;
  bool eclipses = true;        // it hides the Sun from other things
  std::vector<RingBand> rings; // from the inside out
  std::optional<Atmosphere> atmosphere;
  // The object of a terrain, which is drawn in place of the ellipsoid while both have the same
  // frame and offset and the disc is not small (CelestialBody::SmallRadius); 0: none. It has the
  // body's brightness, and its photometric model unless it has one of its own.
  std::uint32_t ground = 0;
};

// Colour, texture, photometric model and emissive light are those of the object's material: by
// default Lambertian and grey. Seen from anywhere outside: where its disc is smaller than a few
// pixels, the light of the disc is shared out among them, so that a distant body has its
// irradiance.
class CelestialBody : public CustomGeometry {
public:
  // Of the apparent disc [pixels]: below it the light of the disc is shared out.
  static constexpr double SmallRadius = 12.0;
  // Likewise: where the body is a point, and where it is a disc, for BodyShape::pointGain.
  static constexpr double PointRadius = 0.5;
  static constexpr double DiscRadius = 2.0;

  // Throws Error(InvalidArgument) naming `object` and the value.
  CelestialBody(const std::string& object, BodyShape shape);

  const BodyShape& Shape() const { return this->Shape_; }
  // The body itself with rings and atmosphere, about its centre.
  BoundingSphere Bounds() const override;
  std::uint64_t Revision() const override { return 1; }

private:
  BodyShape Shape_;
};

} // namespace dspace

#endif
