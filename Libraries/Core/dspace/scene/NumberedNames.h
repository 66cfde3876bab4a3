// Chooses names for what is added without one.
#ifndef DSPACE_SCENE_NUMBERED_NAMES_H
#define DSPACE_SCENE_NUMBERED_NAMES_H

#include <cstdint>
#include <set>
#include <string>
#include <unordered_map>

namespace dspace {

// The first free one of "box", "box 2", "box 3", ... for each wanted name. The numbers below a
// counter are known to be taken, except those that were freed since, so that n names take time in
// proportion to n log n. The caller keeps the names that are taken. Not synchronised.
class NumberedNames {
public:
  // `taken(name)` tells whether a name is taken, by a name that this object chose or by any other.
  // The name stays free until the caller takes it.
  template<class Taken> std::string First(const std::string& wanted, const Taken& taken) {
    if (!taken(wanted)) {
      return wanted;
    }
    Numbers& numbers = this->Numbers_[wanted];
    const auto name = [&wanted](std::uint64_t n) { return wanted + " " + std::to_string(n); };
    while (!numbers.freed.empty()) {
      std::string freed = name(*numbers.freed.begin());
      if (!taken(freed)) {
        return freed;
      }
      numbers.freed.erase(numbers.freed.begin()); // it was given as a name meanwhile
    }
    std::string next = name(numbers.next);
    while (taken(next)) {
      next = name(++numbers.next);
    }
    return next;
  }

  // Call it when a name is free again. Amortised logarithmic time.
  void Freed(const std::string& name);

private:
  struct Numbers {
    std::uint64_t next = 2; // each number from 2 to below it is taken or in `freed`
    std::set<std::uint64_t> freed;
  };
  std::unordered_map<std::string, Numbers> Numbers_; // by wanted name
};

} // namespace dspace

#endif
