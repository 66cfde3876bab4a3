// Root-relative poses of a frame tree, evaluated only where something changed.
#ifndef DSPACE_WORLD_POSES_H
#define DSPACE_WORLD_POSES_H

#include <cstddef>
#include <cstdint>
#include <vector>

#include <dspace/Pose.h>

namespace dspace {

// By slot of the tree: parents come before children, slot 0 is the root. Not synchronised.
class WorldPoses {
public:
  using SlotIndex = std::uint32_t;

  WorldPoses(); // of the root alone

  void Append(); // one slot more
  // Replaces slots [first, last) by the slots in `order`. Slots may be omitted (erased) only at the
  // end of the arrays.
  void Reorder(SlotIndex first, SlotIndex last, const std::vector<SlotIndex>& order);
  // The slot's local pose or parent has changed.
  void Mark(SlotIndex slot);
  // Brings marked slots and those below them up to date. `revision` is the tree's present one.
  void Evaluate(const std::vector<SlotIndex>& parents, const std::vector<Pose>& local,
                std::uint64_t revision);

  // As last evaluated.
  const Pose& Get(std::size_t slot) const { return this->Poses_[slot]; }
  // The revision that the slot was last evaluated with; 0 for the root.
  std::uint64_t ChangedAt(std::size_t slot) const { return this->ChangedAt_[slot]; }
  // Poses evaluated so far.
  std::uint64_t Evaluations() const { return this->Evaluations_; }

private:
  static constexpr std::size_t Clean = SIZE_MAX; // FirstDirty_ when no slot is marked

  std::vector<Pose> Poses_; // X_RootF
  std::vector<std::uint64_t> ChangedAt_;
  std::vector<char> Dirty_;
  std::size_t FirstDirty_ = Clean; // no marked slot lies before it
  std::uint64_t Evaluations_ = 0;
};

} // namespace dspace

#endif
