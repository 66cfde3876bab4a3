#include <dspace/scene/bodies/CelestialBody.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {

CelestialBody::CelestialBody(const std::string& object, BodyShape shape)
    : Shape_(std::move(shape)) {
  const BodyShape& s = this->Shape_;
  for (const double radius : {s.radii.x(), s.radii.y(), s.radii.z()}) {
    Require(radius >= 1.0 && radius <= 1e12, object, "a radius", radius, "1 to 1e12 metres");
  }
  Require(s.radii.maxCoeff() <= 20.0 * s.radii.minCoeff(), object, "the ratio of its radii",
          s.radii.maxCoeff() / s.radii.minCoeff(), "1 to 20");
  Require(s.leftEdge_deg >= -360.0 && s.leftEdge_deg <= 360.0, object,
          "the longitude of the texture's left edge", s.leftEdge_deg, "-360 to 360 degrees");
  Require(s.brightness >= 0.0 && s.brightness <= 1000.0, object, "brightness", s.brightness,
          "0 to 1000");
  Require(s.pointGain >= 0.0 && s.pointGain <= 1e12, object, "the gain of its point", s.pointGain,
          "0 to 1e12");
  Require(s.pointSpread >= 0.0 && s.pointSpread <= 20.0, object, "the spread of its point",
          s.pointSpread, "0 to 20 pixels");
  Require(s.rings.size() <= 16, object, "the number of its rings", double(s.rings.size()),
          "0 to 16");
  double last = std::max(s.radii.x(), s.radii.y());
  for (const RingBand& ring : s.rings) {
    Require(ring.inner >= last && ring.inner <= 1e12, object, "the inner radius of a ring",
            ring.inner, "from the body's radius, or the ring before it, to 1e12 metres");
    Require(ring.outer > ring.inner && ring.outer <= 1e12, object, "the outer radius of a ring",
            ring.outer, "above its inner radius, to 1e12 metres");
    Require(ring.opticalDepth >= 0.0 && ring.opticalDepth <= 100.0, object,
            "the optical depth of a ring", ring.opticalDepth, "0 to 100");
    for (const double channel : ring.color) {
      Require(channel >= 0.0 && channel <= 1.0, object, "the colour of a ring", channel, "0 to 1");
    }
    last = ring.outer;
  }
  if (s.atmosphere) {
    s.atmosphere->Check(object, s.radii);
  }
}

BoundingSphere CelestialBody::Bounds() const {
  const BodyShape& s = this->Shape_;
  double radius = s.radii.maxCoeff();
  if (s.atmosphere) {
    radius += s.atmosphere->top;
  }
  if (!s.rings.empty()) {
    radius = std::max(radius, s.rings.back().outer);
  }
  return {Eigen::Vector3d::Zero(), radius};
}

} // namespace dspace
