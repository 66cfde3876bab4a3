// The states in one segment of an SPK.
#ifndef DSPACE_ANALYSIS_SPK_ARRAY_H
#define DSPACE_ANALYSIS_SPK_ARRAY_H

#include <memory>

#include <dspace/kernels/DafFile.h>
#include <dspace/kernels/State.h>

namespace dspace {

class SpkArray {
public:
  virtual ~SpkArray() = default;
  // At a time within the segment [m, m/s]. Throws Error(Corrupt).
  virtual State At(double tdb) const = 0;

  static bool IsRead(int type); // whether Open knows the type
  // `file` and `array` must live as long. Throws Error(Unsupported, Corrupt).
  static std::unique_ptr<SpkArray> Open(const DafFile& file, const DafFile::Array& array, int type);
};

} // namespace dspace

#endif
