// SPICE's binary kernels of trajectories (SPK).
#ifndef DSPACE_ANALYSIS_SPK_FILE_H
#define DSPACE_ANALYSIS_SPK_FILE_H

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

#include <dspace/kernels/DafFile.h>
#include <dspace/kernels/State.h>

namespace dspace {

class SpkArray; // one segment's words

// Reads an SPK of segments of types 1, 2, 3, 8, 9, 13 and 21. Others are listed, and named in the
// error when their states are asked for.
//
// Source: NAIF, "SPK Required Reading".
class SpkFile {
public:
  // Ids are NAIF's.
  struct Segment {
    std::string name;
    int target = 0;
    int center = 0;
    int frame = 0; // 1: J2000
    int type = 0;
    double begin = 0.0; // TDB [s past J2000]
    double end = 0.0;
    bool IsRead() const; // a type that is read
  };

  // Throws as DafFile does; Error(WrongType)...: Error(Corrupt) where the file is of another kind.
  explicit SpkFile(const std::string& path);
  explicit SpkFile(std::shared_ptr<const DafFile> file);
  ~SpkFile();

  const DafFile& File() const { return *this->File_; }
  const std::vector<Segment>& Segments() const {
    return this->Segments_;
  } // in the order of the file

  // The state of segment `index`'s target from its centre [m, m/s] in its frame. Throws
  // Error(InvalidArgument) outside begin to end, Error(Unsupported) for types that are not read,
  // and Error(Corrupt) for words that make no sense.
  State At(std::size_t index, double tdb) const;

private:
  const SpkArray& ArrayOf(std::size_t index) const;

  struct Opened;
  std::shared_ptr<const DafFile> File_;
  std::vector<Segment> Segments_;
  std::unique_ptr<Opened[]> Opened_;
};

} // namespace dspace

#endif
