// States in the text format .xyzv of Celestia and Cosmographia.
#ifndef DSPACE_TRAJECTORIES_XYZV_FILE_H
#define DSPACE_TRAJECTORIES_XYZV_FILE_H

#include <memory>
#include <string>

#include <dspace/trajectories/StateTable.h>

namespace dspace {

// Lines of a Julian date (TDB), a position [km] and a velocity [km/s]; # begins comments, in which
// spice2xyzv writes the lines "Observer:", "Target:" and "Frame:". States between those of the file
// are by Hermite's interpolation of degree 3, as Celestia reads them, from two states.
//
// A Julian date resolves 4e-5 s near the present, and a file with five decimals of it a second: two
// states with the same time are merged, the later one stays.
class XyzvFile {
public:
  // Throws as TextLines; Error(Corrupt) naming the line for words that are not 7 numbers and for
  // times that descend; Error(InvalidArgument) as StateTable.
  explicit XyzvFile(const std::string& path);

  const std::string& Center() const { return this->Center_; } // "MARS"; empty: not stated
  const std::string& Target() const { return this->Target_; } // likewise
  const std::string& Frame() const { return this->Frame_; }   // "IAU_MARS"; empty: not stated
  std::size_t Merged() const { return this->Merged_; }        // states dropped for equal times
  const std::shared_ptr<const StateTable>& GetTrajectory() const { return this->Table_; }

private:
  std::string Center_;
  std::string Target_;
  std::string Frame_;
  std::size_t Merged_ = 0;
  std::shared_ptr<const StateTable> Table_;
};

} // namespace dspace

#endif
