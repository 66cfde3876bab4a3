#include <dspace/FrameTree.h>

#include <algorithm>
#include <limits>

#include <dspace/Error.h>
#include <dspace/FrameRules.h>

namespace dspace {

namespace {

constexpr FrameId MaximumId = std::numeric_limits<std::int64_t>::max(); // SQLite's integers

// values[first, last) becomes what stood at the slots named by `order`, in that order.
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

} // namespace

FrameTree::FrameTree()
    : Ids_{RootFrame}, Parents_{0}, Local_{Pose()}, Nodes_{{"root", {}}}, World_{Pose()},
      ChangedAt_{0}, Dirty_{0}, SlotOf_{{RootFrame, 0}} {}

FrameId FrameTree::Create(FrameId parent, const std::string& name, const Pose& X_PF, FrameId id) {
  const SlotIndex parentSlot = this->FindSlot(parent);
  if (!IsValidFrameName(name)) {
    RefuseFrameName("child of " + this->Label(parent), name);
  }
  this->RefuseTakenName(parent, name);
  const auto label = [&] { // only for messages: a path takes time in proportion to its depth
    return "frame '" + (parentSlot == 0 ? "" : this->PathOfSlot(parentSlot) + "/") + name + "'";
  };
  if (!IsValidPose(X_PF)) {
    RefusePose(label(), X_PF);
  }
  if (id == NoFrame) {
    id = this->LargestId_ + 1;
  } else if (this->Contains(id) || this->Retired_.count(id) != 0) {
    throw Error(Error::Kind::AlreadyExists, label(),
                "the id " + std::to_string(id) + " is taken by " +
                    (this->Contains(id) ? this->Label(id) : "a frame that was removed") +
                    "; 0 takes the next free one");
  }
  if (id > MaximumId) {
    throw Error(Error::Kind::InvalidArgument, label(),
                "the id " + std::to_string(id) + " is beyond the largest, 2^63 - 1");
  }

  const auto slot = static_cast<SlotIndex>(this->Size());
  this->Ids_.push_back(id);
  this->Parents_.push_back(parentSlot);
  this->Local_.push_back(NormalisedPose(X_PF));
  this->Nodes_.push_back({name, {}});
  this->World_.emplace_back();
  this->ChangedAt_.push_back(0);
  this->Dirty_.push_back(0);
  this->Nodes_[parentSlot].children.push_back(id);
  this->SlotOf_.emplace(id, slot);
  this->ChildOf_.emplace(ChildKey{parent, name}, id);
  this->LargestId_ = std::max(this->LargestId_, id);
  this->MarkDirty(slot);
  this->Emit(FrameEvent::Type::Created, {id});
  return id;
}

std::vector<FrameId> FrameTree::Remove(FrameId id) {
  const SlotIndex first = this->FindSlot(id);
  this->RefuseRoot(id, "removed");
  this->DetachFromParent(first);
  const std::vector<char> inSubtree = this->SubtreeFrom(first);
  std::vector<SlotIndex> staying;
  std::vector<FrameId> removed;
  for (std::size_t i = 0; i < inSubtree.size(); ++i) {
    const auto slot = static_cast<SlotIndex>(first + i);
    if (inSubtree[i]) {
      removed.push_back(this->Ids_[slot]);
    } else {
      staying.push_back(slot);
    }
  }
  for (const FrameId gone : removed) {
    Node& node = this->Nodes_[this->SlotOf_.at(gone)];
    for (const FrameId child : node.children) {
      this->ChildOf_.erase({gone, this->Nodes_[this->SlotOf_.at(child)].name});
    }
  }
  for (const FrameId gone : removed) {
    this->SlotOf_.erase(gone);
    this->Retired_.insert(gone);
  }
  this->Reorder(first, static_cast<SlotIndex>(this->Size()), staying);
  std::reverse(removed.begin(), removed.end());
  this->Emit(FrameEvent::Type::Removed, removed);
  return removed;
}

void FrameTree::Reparent(FrameId id, FrameId newParent, bool keepWorldPose) {
  const SlotIndex slot = this->FindSlot(id);
  const SlotIndex newParentSlot = this->FindSlot(newParent);
  this->RefuseRoot(id, "reparented");
  if (this->Parents_[slot] == newParentSlot) {
    return;
  }
  SlotIndex above = newParentSlot;
  while (above > slot) { // slots shrink upwards
    above = this->Parents_[above];
  }
  if (above == slot) {
    throw Error(Error::Kind::InvalidArgument, this->Label(id),
                "cannot be hung under " + this->Label(newParent) +
                    ", which is itself or one of its descendants");
  }
  this->RefuseTakenName(newParent, this->Nodes_[slot].name);
  Pose X_PF = this->Local_[slot];
  if (keepWorldPose) {
    X_PF = this->RelativePose(newParent, id);
    if (!IsValidPose(X_PF)) { // scales or positions that leave the range of doubles
      RefusePose(this->Label(id), X_PF);
    }
  }

  this->DetachFromParent(slot);
  this->Nodes_[newParentSlot].children.push_back(id);
  this->ChildOf_.emplace(ChildKey{newParent, this->Nodes_[slot].name}, id);
  this->Local_[slot] = NormalisedPose(X_PF);
  if (newParentSlot > slot) {
    // The subtree's frames in between go behind the new parent; each part keeps its order.
    const std::vector<char> inSubtree = this->SubtreeFrom(slot);
    std::vector<SlotIndex> order;
    for (const char wanted : {0, 1}) {
      for (SlotIndex s = slot; s <= newParentSlot; ++s) {
        if (inSubtree[s - slot] == wanted) {
          order.push_back(s);
        }
      }
    }
    this->Reorder(slot, newParentSlot + 1, order);
  }
  const SlotIndex newSlot = this->FindSlot(id);
  this->Parents_[newSlot] = this->FindSlot(newParent);
  this->MarkDirty(newSlot);
  this->Emit(FrameEvent::Type::Reparented, {id});
}

void FrameTree::Rename(FrameId id, const std::string& name) {
  const SlotIndex slot = this->FindSlot(id);
  this->RefuseRoot(id, "renamed");
  if (!IsValidFrameName(name)) {
    RefuseFrameName(this->Label(id), name);
  }
  if (this->Nodes_[slot].name == name) {
    return;
  }
  const FrameId parent = this->Ids_[this->Parents_[slot]];
  this->RefuseTakenName(parent, name);
  this->ChildOf_.erase({parent, this->Nodes_[slot].name});
  this->ChildOf_.emplace(ChildKey{parent, name}, id);
  this->Nodes_[slot].name = name;
  this->Emit(FrameEvent::Type::Renamed, {id});
}

FrameId FrameTree::Find(const std::string& path, FrameId base) const {
  this->FindSlot(base);
  if (path == "/") {
    return base;
  }
  FrameId id = base;
  std::size_t begin = 0;
  while (true) {
    const std::size_t end = path.find('/', begin);
    const std::size_t length = (end == std::string::npos ? path.size() : end) - begin;
    const auto child = this->ChildOf_.find({id, path.substr(begin, length)});
    if (child == this->ChildOf_.end()) {
      return NoFrame;
    }
    id = child->second;
    if (end == std::string::npos) {
      return id;
    }
    begin = end + 1;
  }
}

std::string FrameTree::Path(FrameId id) const {
  return this->PathOfSlot(this->FindSlot(id));
}

const std::string& FrameTree::Name(FrameId id) const {
  return this->Nodes_[this->FindSlot(id)].name;
}

FrameId FrameTree::Parent(FrameId id) const {
  const SlotIndex slot = this->FindSlot(id);
  return slot == 0 ? NoFrame : this->Ids_[this->Parents_[slot]];
}

const std::vector<FrameId>& FrameTree::Children(FrameId id) const {
  return this->Nodes_[this->FindSlot(id)].children;
}

FrameId FrameTree::IdAt(std::size_t slot) const {
  if (slot >= this->Size()) {
    throw Error(Error::Kind::NotFound, "slot " + std::to_string(slot),
                "the tree has " + std::to_string(this->Size()) + " frames");
  }
  return this->Ids_[slot];
}

FrameNotifier::Token FrameTree::AddListener(FrameNotifier::Listener listener) {
  if (!listener) {
    throw Error(Error::Kind::InvalidArgument, "frame listener", "an empty function cannot listen");
  }
  return this->Notifier_.Add(std::move(listener));
}

FrameTree::SlotIndex FrameTree::FindSlot(FrameId id) const {
  const auto it = this->SlotOf_.find(id);
  if (it == this->SlotOf_.end()) {
    throw Error(Error::Kind::NotFound, "frame " + std::to_string(id),
                this->Retired_.count(id) != 0 ? "the frame with this id was removed"
                                              : "no frame has this id");
  }
  return it->second;
}

std::string FrameTree::PathOfSlot(SlotIndex slot) const {
  if (slot == 0) {
    return "/";
  }
  std::vector<const std::string*> names;
  for (; slot != 0; slot = this->Parents_[slot]) {
    names.push_back(&this->Nodes_[slot].name);
  }
  std::string path = *names.back();
  for (auto it = names.rbegin() + 1; it != names.rend(); ++it) {
    path += '/';
    path += **it;
  }
  return path;
}

std::string FrameTree::Label(FrameId id) const {
  return "frame '" + this->PathOfSlot(this->FindSlot(id)) + "'";
}

void FrameTree::RefuseRoot(FrameId id, const char* what) const {
  if (id == RootFrame) {
    throw Error(Error::Kind::InvalidArgument, this->Label(id),
                std::string("the root frame cannot be ") + what);
  }
}

void FrameTree::RefuseTakenName(FrameId parent, const std::string& name) const {
  const auto sibling = this->ChildOf_.find({parent, name});
  if (sibling != this->ChildOf_.end()) {
    throw Error(Error::Kind::AlreadyExists, this->Label(sibling->second),
                "the name '" + name + "' is taken (by id " + std::to_string(sibling->second) +
                    "); names differ among the children of a frame");
  }
}

void FrameTree::DetachFromParent(SlotIndex slot) {
  const SlotIndex parent = this->Parents_[slot];
  std::vector<FrameId>& siblings = this->Nodes_[parent].children;
  siblings.erase(std::find(siblings.begin(), siblings.end(), this->Ids_[slot]));
  this->ChildOf_.erase({this->Ids_[parent], this->Nodes_[slot].name});
}

// For the slots from `slot` on, whether they belong to its subtree.
std::vector<char> FrameTree::SubtreeFrom(SlotIndex slot) const {
  std::vector<char> inSubtree(this->Size() - slot, 0);
  inSubtree[0] = 1;
  for (std::size_t s = slot + 1; s < this->Size(); ++s) {
    const SlotIndex parent = this->Parents_[s];
    inSubtree[s - slot] = parent >= slot ? inSubtree[parent - slot] : 0;
  }
  return inSubtree;
}

// Slots [first, last) take the frames that stood at `order`; those left out are dropped, which only
// the end of the arrays allows.
void FrameTree::Reorder(SlotIndex first, SlotIndex last, const std::vector<SlotIndex>& order) {
  std::vector<SlotIndex> newSlot(last - first, 0);
  for (std::size_t i = 0; i < order.size(); ++i) {
    newSlot[order[i] - first] = static_cast<SlotIndex>(first + i);
  }
  Rearrange(this->Ids_, first, last, order);
  Rearrange(this->Parents_, first, last, order);
  Rearrange(this->Local_, first, last, order);
  Rearrange(this->Nodes_, first, last, order);
  Rearrange(this->World_, first, last, order);
  Rearrange(this->ChangedAt_, first, last, order);
  Rearrange(this->Dirty_, first, last, order);
  for (std::size_t s = first; s < this->Size(); ++s) {
    SlotIndex& parent = this->Parents_[s];
    if (parent >= first && parent < last) {
      parent = newSlot[parent - first];
    }
  }
  for (std::size_t s = first; s < first + order.size(); ++s) {
    this->SlotOf_[this->Ids_[s]] = static_cast<SlotIndex>(s);
  }
  if (this->FirstDirty_ != Clean) {
    this->FirstDirty_ = std::min<std::size_t>(this->FirstDirty_, first);
  }
}

// Called last in every change.
void FrameTree::Emit(FrameEvent::Type type, std::vector<FrameId> ids) {
  ++this->Revision_;
  if (this->Notifier_.HasListeners()) {
    this->Notifier_.Emit({type, std::move(ids), this->Revision_});
  }
}

} // namespace dspace
