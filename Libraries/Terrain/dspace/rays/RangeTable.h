// A table of heights that blocks lie between; later ones replace earlier ones.
#ifndef DSPACE_TERRAIN_RANGETABLE_H
#define DSPACE_TERRAIN_RANGETABLE_H

#include <array>
#include <cstdint>
#include <mutex>
#include <vector>

#include <dspace/rays/RayTiles.h>

namespace dspace {

// 2 MB once it is used. Any thread may call. A block is (c, r) of those of 2^bits cells, less than
// 2^29 of either.
class RangeTable {
public:
  bool Find(int bits, std::int64_t c, std::int64_t r, RayTile::Range& range) const {
    const std::uint64_t key = KeyOf(bits, c, r);
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    const Entry* entry = this->Entries_.empty() ? nullptr : &this->Entries_[PlaceOf(key)];
    if (!entry || entry->key != key) {
      return false;
    }
    range = entry->range;
    return true;
  }

  void Insert(int bits, std::int64_t c, std::int64_t r, const RayTile::Range& range) {
    const std::uint64_t key = KeyOf(bits, c, r);
    const std::lock_guard<std::mutex> lock(this->Mutex_);
    this->Entries_.resize(std::size_t(1) << IndexBits);
    this->Entries_[PlaceOf(key)] = {key, range};
  }

private:
  static constexpr int IndexBits = 17;
  struct Entry {
    std::uint64_t key = 0;
    RayTile::Range range;
  };
  static std::uint64_t KeyOf(int bits, std::int64_t c, std::int64_t r) {
    return (std::uint64_t(bits + 1) << 58) | (std::uint64_t(c) << 29) | std::uint64_t(r);
  }
  static std::size_t PlaceOf(std::uint64_t key) { // Fibonacci hashing
    return std::size_t((key * 0x9E3779B97F4A7C15u) >> (64 - IndexBits));
  }

  mutable std::mutex Mutex_; // of what follows
  std::vector<Entry> Entries_;
};

} // namespace dspace

#endif
