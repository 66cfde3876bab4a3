// Moves the values of some slots of an array. Internal, not installed.
#ifndef DSPACE_REARRANGE_H
#define DSPACE_REARRANGE_H

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <utility>
#include <vector>

namespace dspace {

// Replaces values[first, last) by the values at the slots in `order`, in that order. Values of that
// range that `order` omits are erased.
template<class T>
void Rearrange(std::vector<T>& values, std::size_t first, std::size_t last,
               const std::vector<std::uint32_t>& order) {
  std::vector<T> kept;
  kept.reserve(order.size());
  for (const std::uint32_t slot : order) {
    kept.push_back(std::move(values[slot]));
  }
  const auto begin = values.begin() + static_cast<std::ptrdiff_t>(first);
  const auto rest = std::move(kept.begin(), kept.end(), begin);
  values.erase(rest, values.begin() + static_cast<std::ptrdiff_t>(last));
}

} // namespace dspace

#endif
