// SPICE's binary kernels of body orientation (PCK).
#ifndef DSPACE_ANALYSIS_BINARY_PCK_H
#define DSPACE_ANALYSIS_BINARY_PCK_H

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <dspace/kernels/DafFile.h>

namespace dspace {

// Reads a binary PCK of segments of type 2 (Chebyshev polynomials of Euler angles).
//
// Source: NAIF, "PCK Required Reading".
class BinaryPck {
public:
  struct Segment {
    std::string name;
    int frameClass = 0; // the body-fixed frame's class id: 31006 for MOON_PA_DE421, 3000 for ITRF93
    int inertial = 0;   // NAIF id of the frame that the angles refer to: 1 J2000, 17 ECLIPJ2000
    int type = 0;
    double begin = 0.0; // TDB [s past J2000]
    double end = 0.0;
  };
  // The rotation from `inertial` to the body-fixed frame is [w]3 [delta]1 [phi]3: coordinate axes
  // turned by phi about z, then by delta about x, then by w about z. phi = right ascension of the
  // pole + 90 degrees, delta = 90 degrees - its declination, w = the prime meridian's angle.
  struct Angles {
    double phi = 0.0, delta = 0.0, w = 0.0;             // [rad]
    double phiRate = 0.0, deltaRate = 0.0, wRate = 0.0; // [rad/s]
  };

  explicit BinaryPck(const std::string& path);
  explicit BinaryPck(std::shared_ptr<const DafFile> file);

  const DafFile& File() const { return *this->File_; }
  const std::vector<Segment>& Segments() const { return this->Segments_; }
  // Throws as SpkFile::At does.
  Angles At(std::size_t index, double tdb) const;

private:
  std::shared_ptr<const DafFile> File_;
  std::vector<Segment> Segments_;
};

} // namespace dspace

#endif
