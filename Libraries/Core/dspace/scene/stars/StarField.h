// Stars that are infinitely far away.
#ifndef DSPACE_SCENE_STAR_FIELD_H
#define DSPACE_SCENE_STAR_FIELD_H

#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include <dspace/scene/CustomGeometry.h>

namespace dspace {

// Apparent V magnitude of the Sun at 1 au (C. Willmer, ApJS 236 (2018) 47, Vega system).
inline constexpr double SunMagnitude = -26.76;

struct Star {
  Eigen::Vector3f direction = Eigen::Vector3f::UnitX(); // unit, in the object's axes
  float magnitude = 0.0f;                               // apparent, V
  float colorIndex = 0.0f;                              // B-V; NaN: unknown, drawn white
};

// How stars are drawn.
struct StarLook {
  double gain = 1.0;        // on their light in pictures for the eye, 0 to 1e12; captures of
                            // radiance have 1
  double spread = 0.6;      // standard deviation of the Gaussian of each [pixels], 0.2 to 20
  double faintest = 1000.0; // V magnitude of the faintest that is drawn
};

// Seen behind everything else through perspective cameras. The frame that the object is attached to
// gives their axes (for a catalogue: right ascension from X to Y, declination to Z), its position
// does not matter. A star of magnitude V has the irradiance
// SolarConstant * 10^(-0.4 (V - SunMagnitude)): that of the Sun, if it were so far away.
class StarField : public CustomGeometry {
public:
  // Throws Error(InvalidArgument) naming `object` and the star: directions that are not unit to
  // 1e-3, magnitudes that are not finite or outside -30 to 40, no star.
  StarField(const std::string& object, std::vector<Star> stars);
  // Throws Error(InvalidArgument) naming `object` and the value; then nothing changes.
  void SetLook(const std::string& object, const StarLook& look);

  // Brightest first.
  const std::vector<Star>& Stars() const { return this->Stars_; }
  const StarLook& Look() const { return this->Look_; }

  BoundingSphere Bounds() const override; // a point: it takes no part in fits
  std::uint64_t Revision() const override { return this->Revision_; }
  bool IsBackdrop() const override { return true; }

private:
  std::vector<Star> Stars_;
  StarLook Look_;
  std::uint64_t Revision_ = 1;
};

} // namespace dspace

#endif
