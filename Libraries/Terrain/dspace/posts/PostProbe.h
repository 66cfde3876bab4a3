// Reads single posts of level 0. Not for public headers of other libraries.
#ifndef DSPACE_TERRAIN_POSTPROBE_H
#define DSPACE_TERRAIN_POSTPROBE_H

#include <cstdint>

namespace dspace {

// Keeps what neighbouring posts share, so that a post costs far less than a block of one. The
// heights are those of PostSource::Read, to the bit. One thread uses it; its source outlives it.
class PostProbe {
public:
  virtual ~PostProbe() = default;
  // Whether it reads the posts of rows `first` to `last`.
  virtual bool HasRows(std::int64_t first, std::int64_t last) const = 0;
  // NaN where there is no data and outside the lattice. Throws Error if the data cannot be read.
  virtual float At(std::int64_t column, std::int64_t row) = 0;
};

} // namespace dspace

#endif
