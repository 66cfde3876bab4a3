#include <dspace/WorldPoses.h>

#include <algorithm>

#include <dspace/Rearrange.h>

namespace dspace {

WorldPoses::WorldPoses() : Poses_{Pose()}, ChangedAt_{0}, Dirty_{0} {}

void WorldPoses::Append() {
  this->Poses_.emplace_back();
  this->ChangedAt_.push_back(0);
  this->Dirty_.push_back(0);
}

void WorldPoses::Reorder(SlotIndex first, SlotIndex last, const std::vector<SlotIndex>& order) {
  Rearrange(this->Poses_, first, last, order);
  Rearrange(this->ChangedAt_, first, last, order);
  Rearrange(this->Dirty_, first, last, order);
  if (this->FirstDirty_ != Clean) {
    this->FirstDirty_ = std::min<std::size_t>(this->FirstDirty_, first);
  }
}

void WorldPoses::Mark(SlotIndex slot) {
  this->Dirty_[slot] = 1;
  this->FirstDirty_ = std::min<std::size_t>(this->FirstDirty_, slot);
}

// A marked slot was marked with the present revision or an earlier one that was not evaluated, so
// that a parent with ChangedAt_ == revision was evaluated in this very pass.
void WorldPoses::Evaluate(const std::vector<SlotIndex>& parents, const std::vector<Pose>& local,
                          std::uint64_t revision) {
  if (this->FirstDirty_ == Clean) {
    return;
  }
  for (std::size_t s = this->FirstDirty_; s < this->Poses_.size(); ++s) {
    const SlotIndex parent = parents[s];
    if (this->Dirty_[s] || this->ChangedAt_[parent] == revision) {
      this->Poses_[s] = parent == 0 ? local[s] : this->Poses_[parent] * local[s];
      this->ChangedAt_[s] = revision;
      this->Dirty_[s] = 0;
      ++this->Evaluations_;
    }
  }
  this->FirstDirty_ = Clean;
}

} // namespace dspace
