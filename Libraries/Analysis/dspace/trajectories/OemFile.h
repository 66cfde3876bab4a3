// CCSDS Orbit Ephemeris Messages.
#ifndef DSPACE_TRAJECTORIES_OEM_FILE_H
#define DSPACE_TRAJECTORIES_OEM_FILE_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/time/TimeScales.h>
#include <dspace/trajectories/StateTable.h>

namespace dspace {

// The ephemeris of one object, from a file in keyword-value notation, versions 1.0 to 3.0. Blocks
// are read with the interpolation that they state: LINEAR, LAGRANGE, HERMITE with their degree. A
// block that states none is read by Hermite's of degree 7, or of as many states as there are.
// Accelerations and covariance blocks are checked for their form and skipped.
//
// Source: CCSDS 502.0-B-2, "Orbit Data Messages", 2009, section 5.
class OemFile {
public:
  struct Block {
    std::string center; // as written: "EARTH"
    std::string frame;  // as written: "EME2000"
    std::string timeSystem;
    std::shared_ptr<const StateTable> table;
    bool interpolationStated = false;
  };

  // Times are TDB by `scales`; time systems UTC, TAI, TT, TDB and GPS.
  // Throws as TextLines; Error(Corrupt) naming the line for what the standard does not allow,
  // Error(Unsupported) for another time system or version, Error(InvalidArgument) naming the file
  // for blocks whose useable spans overlap, and for blocks of several objects.
  OemFile(const std::string& path, const TimeScales& scales);

  const std::string& ObjectName() const { return this->ObjectName_; }
  const std::string& ObjectId() const { return this->ObjectId_; }
  const std::string& Originator() const { return this->Originator_; }
  const std::vector<Block>& Blocks() const { return this->Blocks_; } // in the order of the file
  // Of all blocks, which must be about one centre in one frame: Error(Unsupported) otherwise.
  TrajectoryPtr GetTrajectory() const;
  // "J2000" for EME2000, ICRF and GCRF, which differ by at most 0.023"; others as they are written.
  std::string Frame() const;

private:
  std::string Label_;
  std::string ObjectName_;
  std::string ObjectId_;
  std::string Originator_;
  std::vector<Block> Blocks_;
  std::shared_ptr<const JoinedTables> Joined_;
};

} // namespace dspace

#endif
