// SPICE's binary kernels of attitude (CK).
#ifndef DSPACE_ANALYSIS_CK_FILE_H
#define DSPACE_ANALYSIS_CK_FILE_H

#include <cstddef>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <dspace/kernels/DafFile.h>

namespace dspace {

// Reads a CK of segments of type 3 (pointings that are interpolated within intervals). Times are
// ticks of the spacecraft's clock: an SCLK kernel converts them (ClockKernel.h).
//
// Source: NAIF, "CK Required Reading".
class CkFile {
public:
  struct Segment {
    std::string name;
    int instrument = 0; // NAIF id of the structure whose attitude it is: -82000 for Cassini's
    int frame = 0;      // NAIF id of the frame that it refers to
    int type = 0;
    bool hasRates = false;
    double begin = 0.0; // [ticks]
    double end = 0.0;
  };
  struct Pointing {
    double ticks = 0.0;                  // the time that it is valid for
    Eigen::Matrix3d rotation;            // components in `frame` to those in the structure's frame
    std::optional<Eigen::Vector3d> rate; // angular velocity of the structure in `frame` [rad/s]
  };

  explicit CkFile(const std::string& path);
  explicit CkFile(std::shared_ptr<const DafFile> file);

  const DafFile& File() const { return *this->File_; }
  const std::vector<Segment>& Segments() const { return this->Segments_; }

  // The pointing at `ticks`: interpolated within an interval (rotation about a fixed axis, at
  // constant rate), else the nearest recorded one within `tolerance` [ticks], else none.
  // Throws Error(Unsupported) for types that are not read, Error(Corrupt) for words that make no
  // sense.
  std::optional<Pointing> At(std::size_t index, double ticks, double tolerance = 0.0) const;
  // Begin and end [ticks] of the intervals within which pointings are interpolated.
  std::vector<std::pair<double, double>> Intervals(std::size_t index) const;

private:
  std::shared_ptr<const DafFile> File_;
  std::vector<Segment> Segments_;
};

} // namespace dspace

#endif
