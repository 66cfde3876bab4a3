#include <dspace/FrameTree.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Error.h>
#include <dspace/FrameRules.h>
#include <dspace/Rearrange.h>

namespace dspace {

namespace {

constexpr FrameId MaximumId = std::numeric_limits<std::int64_t>::max(); // SQLite's integers

// What NormalisedPose leaves as it is.
bool IsNormalised(const Eigen::Quaterniond& q) {
  return std::abs(q.squaredNorm() - 1.0) <= 8.0 * std::numeric_limits<double>::epsilon();
}

// Whether a row is valid for certain, without a root: where the square of a quaternion's norm is
// within the tolerance, the norm is within half of it. Else IsValidPose says it.
bool IsPlainlyValid(const double* row) {
  const double squared = row[3] * row[3] + row[4] * row[4] + row[5] * row[5] + row[6] * row[6];
  return (std::abs(row[0]) <= MaximumCoordinate) & (std::abs(row[1]) <= MaximumCoordinate) &
         (std::abs(row[2]) <= MaximumCoordinate) & (row[7] >= MinimumScale) &
         (row[7] <= MaximumScale) & (std::abs(squared - 1.0) <= UnitQuaternionTolerance);
}

} // namespace

FrameTree::FrameTree()
    : Ids_{RootFrame}, Parents_{0}, Local_{Pose()}, Nodes_{{"root", {}}}, SlotOf_{{RootFrame, 0}} {}

FrameId FrameTree::Create(FrameId parent, const std::string& name, const Pose& X_PF, FrameId id) {
  const FrameId made = id == NoFrame ? this->LargestId_ + 1 : id;
  this->Append(parent, name, X_PF, made);
  this->Emit(FrameEvent::Type::Created, {made});
  return made;
}

FrameId FrameTree::CreateMany(std::vector<std::string> names, const std::vector<FrameId>& parents,
                              const double* poses, FrameId first) {
  const std::size_t n = names.size();
  if (n == 0 || (parents.size() != 1 && parents.size() != n)) {
    throw Error(Error::Kind::InvalidArgument, "new frames",
                std::to_string(n) + " names and " + std::to_string(parents.size()) +
                    " parents are given; accepted: one name or more, and one parent, or one each");
  }
  const std::size_t before = this->Size();
  const FrameId largest = this->LargestId_;
  const FrameId made = first == NoFrame ? largest + 1 : first;
  if (n > before) { // else they grow by themselves, in constant time for each
    this->Ids_.reserve(before + n);
    this->Parents_.reserve(before + n);
    this->Local_.reserve(before + n);
    this->Nodes_.reserve(before + n);
    this->SlotOf_.reserve(before + n);
    this->ChildOf_.reserve(before + n);
  }
  try {
    for (std::size_t i = 0; i < n; ++i) {
      this->Append(parents[parents.size() == 1 ? 0 : i], std::move(names[i]),
                   poses ? PoseFromRow(poses + PoseSize * i) : Pose(), made + i);
    }
  } catch (...) {
    this->DropFrom(before);
    this->LargestId_ = largest;
    throw;
  }
  this->Emit(FrameEvent::Type::Created, {this->Ids_.end() - std::ptrdiff_t(n), this->Ids_.end()});
  return made;
}

// All of a creation but its event.
void FrameTree::Append(FrameId parent, std::string name, const Pose& X_PF, FrameId id) {
  const SlotIndex parentSlot = this->FindSlot(parent);
  if (!IsValidFrameName(name)) {
    RejectFrameName("child of " + this->Label(parent), name);
  }
  this->RejectTakenName(parent, name);
  const auto label = [&] { // only for messages: a path takes time in proportion to its depth
    return "frame '" + (parentSlot == 0 ? "" : this->PathOfSlot(parentSlot) + "/") + name + "'";
  };
  if (!IsValidPose(X_PF)) {
    RejectPose(label(), X_PF);
  }
  if (id <= this->LargestId_ && (this->Contains(id) || this->Retired_.count(id) != 0)) {
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
  this->World_.Append();
  this->Nodes_[parentSlot].children.push_back(id);
  this->SlotOf_.emplace(id, slot);
  this->ChildOf_.emplace(ChildKey{parent, name}, id);
  this->Nodes_.push_back({std::move(name), {}});
  this->LargestId_ = std::max(this->LargestId_, id);
  this->World_.Mark(slot);
}

// Takes back what Append() has added since there were `first` frames.
void FrameTree::DropFrom(std::size_t first) {
  for (std::size_t slot = this->Size(); slot-- > first;) {
    const SlotIndex parent = this->Parents_[slot];
    this->Nodes_[parent].children.pop_back(); // the last was added last
    this->ChildOf_.erase({this->Ids_[parent], this->Nodes_[slot].name});
    this->SlotOf_.erase(this->Ids_[slot]);
  }
  this->Reorder(static_cast<SlotIndex>(first), static_cast<SlotIndex>(this->Size()), {});
}

std::vector<FrameId> FrameTree::Remove(FrameId id) {
  const SlotIndex first = this->FindSlot(id);
  this->RejectRoot(id, "removed");
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
  this->RejectRoot(id, "reparented");
  if (this->Parents_[slot] == newParentSlot) {
    return;
  }
  SlotIndex above = newParentSlot;
  while (above > slot) { // slots shrink upwards
    above = this->Parents_[above];
  }
  if (above == slot) {
    throw Error(Error::Kind::InvalidArgument, this->Label(id),
                "cannot be moved under " + this->Label(newParent) +
                    ", which is itself or one of its descendants");
  }
  this->RejectTakenName(newParent, this->Nodes_[slot].name);
  Pose X_PF = this->Local_[slot];
  if (keepWorldPose) {
    X_PF = this->RelativePose(newParent, id);
    if (!IsValidPose(X_PF)) { // scales or positions that leave the range of doubles
      RejectPose(this->Label(id), X_PF);
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
  this->World_.Mark(newSlot);
  this->Emit(FrameEvent::Type::Reparented, {id});
}

void FrameTree::Rename(FrameId id, const std::string& name) {
  const SlotIndex slot = this->FindSlot(id);
  this->RejectRoot(id, "renamed");
  if (!IsValidFrameName(name)) {
    RejectFrameName(this->Label(id), name);
  }
  if (this->Nodes_[slot].name == name) {
    return;
  }
  const FrameId parent = this->Ids_[this->Parents_[slot]];
  this->RejectTakenName(parent, name);
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
    throw Error(Error::Kind::InvalidArgument, "frame listener", "the function is empty");
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

void FrameTree::RejectRoot(FrameId id, const char* what) const {
  if (id == RootFrame) {
    throw Error(Error::Kind::InvalidArgument, this->Label(id),
                std::string("the root frame cannot be ") + what);
  }
}

void FrameTree::RejectTakenName(FrameId parent, const std::string& name) const {
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
  this->World_.Reorder(first, last, order);
  for (std::size_t s = first; s < this->Size(); ++s) {
    SlotIndex& parent = this->Parents_[s];
    if (parent >= first && parent < last) {
      parent = newSlot[parent - first];
    }
  }
  for (std::size_t s = first; s < first + order.size(); ++s) {
    this->SlotOf_[this->Ids_[s]] = static_cast<SlotIndex>(s);
  }
}

void FrameTree::SetLocalPose(FrameId id, const Pose& X_PF) {
  const SlotIndex slot = this->FindSlot(id);
  this->RejectRoot(id, "posed");
  if (!IsValidPose(X_PF)) {
    RejectPose(this->Label(id), X_PF);
  }
  if (this->StorePose(slot, NormalisedPose(X_PF))) {
    this->Emit(FrameEvent::Type::PosesChanged, {id});
  }
}

void FrameTree::SetLocalPoses(const FrameId* ids, const double* poses, std::size_t n) {
  if (n != 0 && (!ids || !poses)) {
    throw Error(Error::Kind::InvalidArgument, "poses of " + std::to_string(n) + " frames",
                "the array of ids or of poses is missing");
  }
  this->BatchSlots_.resize(std::max(n, this->BatchSlots_.size()), 0);
  this->BatchRows_.resize(this->Size(), 0);
  const std::uint64_t start = this->BatchStart_;
  this->BatchStart_ += n; // also if this call is rejected
  for (std::size_t i = 0; i < n; ++i) {
    // A simulation usually sends the same frames each time: try the slot of the last call first.
    SlotIndex& slot = this->BatchSlots_[i];
    if (slot >= this->Ids_.size() || this->Ids_[slot] != ids[i]) {
      slot = this->FindSlot(ids[i]);
    }
    this->RejectRoot(ids[i], "posed");
    std::uint64_t& row = this->BatchRows_[slot];
    if (row >= start) {
      throw Error(Error::Kind::InvalidArgument, this->Label(ids[i]),
                  "it is given twice, in rows " + std::to_string(row - start) + " and " +
                      std::to_string(i) + "; accepted: each frame once");
    }
    row = start + i;
    const double* pose = poses + PoseSize * i;
    if (!IsPlainlyValid(pose)) {
      const Pose X_PF = PoseFromRow(pose);
      if (!IsValidPose(X_PF)) {
        RejectPose(this->Label(ids[i]) + " (row " + std::to_string(i) + ")", X_PF);
      }
    }
  }
  std::vector<SlotIndex> changed;
  const bool tell = this->Notifier_.HasListeners();
  bool any = false;
  for (std::size_t i = 0; i < n; ++i) {
    const double* row = poses + PoseSize * i;
    const SlotIndex slot = this->BatchSlots_[i];
    const Pose X_PF = {{row[0], row[1], row[2]}, {row[3], row[4], row[5], row[6]}, row[7]};
    if (this->StorePose(slot, IsNormalised(X_PF.rotation) ? X_PF : NormalisedPose(X_PF))) {
      any = true;
      if (tell) {
        changed.push_back(slot);
      }
    }
  }
  if (!any) {
    return;
  }
  std::vector<FrameId> news(changed.size());
  std::sort(changed.begin(), changed.end());
  std::transform(changed.begin(), changed.end(), news.begin(),
                 [this](SlotIndex slot) { return this->Ids_[slot]; });
  this->Emit(FrameEvent::Type::PosesChanged, std::move(news));
}

const Pose& FrameTree::LocalPose(FrameId id) const {
  return this->Local_[this->FindSlot(id)];
}

Pose FrameTree::RelativePose(FrameId W, FrameId G) const {
  SlotIndex w = this->FindSlot(W);
  SlotIndex g = this->FindSlot(G);
  bool any = false; // no factor yet: the first is taken as it is, not multiplied by the identity
  Pose X_WG;
  const auto append = [&](const Pose& next) {
    X_WG = any ? X_WG * next : next;
    any = true;
  };
  std::vector<SlotIndex> down; // from G up to below the common ancestor
  while (w != g) {             // the larger slot cannot be the other's ancestor
    if (w > g) {
      append(this->Local_[w].Inverse());
      w = this->Parents_[w];
    } else {
      down.push_back(g);
      g = this->Parents_[g];
    }
  }
  for (auto it = down.rbegin(); it != down.rend(); ++it) {
    append(this->Local_[*it]);
  }
  return X_WG;
}

void FrameTree::RelativePoses(FrameId W, std::vector<Pose>& out) const {
  const SlotIndex w = this->FindSlot(W);
  out.resize(this->Size());
  out[w] = Pose();
  // Same factors in the same order as RelativePose: first those of W's ancestors, upwards, ...
  std::vector<SlotIndex> ancestors; // of W and W itself, slots shrinking
  ancestors.push_back(w);
  for (SlotIndex s = w; s != 0; s = this->Parents_[s]) {
    const Pose up = this->Local_[s].Inverse();
    out[this->Parents_[s]] = s == w ? up : out[s] * up;
    ancestors.push_back(this->Parents_[s]);
  }
  // ... then everything that hangs on them, downwards.
  for (SlotIndex s = 0; s < this->Size(); ++s) {
    if (!ancestors.empty() && ancestors.back() == s) {
      ancestors.pop_back();
      continue;
    }
    const SlotIndex parent = this->Parents_[s];
    out[s] = parent == w ? this->Local_[s] : out[parent] * this->Local_[s];
  }
}

const std::vector<FrameId>& FrameTree::Update() {
  this->Changed_.clear();
  if (this->ReportedRevision_ == this->Revision_) {
    return this->Changed_;
  }
  this->Evaluate();
  for (std::size_t slot = 1; slot < this->Size(); ++slot) {
    if (this->World_.ChangedAt(slot) > this->ReportedRevision_) {
      this->Changed_.push_back(this->Ids_[slot]);
    }
  }
  this->ReportedRevision_ = this->Revision_;
  return this->Changed_;
}

const Pose& FrameTree::WorldPose(FrameId id) const {
  this->Evaluate();
  return this->World_.Get(this->FindSlot(id));
}

std::uint64_t FrameTree::ChangedAt(FrameId id) const {
  this->Evaluate();
  return this->World_.ChangedAt(this->FindSlot(id));
}

// False when nothing differs.
bool FrameTree::StorePose(SlotIndex slot, const Pose& X_PF) {
  if (this->Local_[slot] == X_PF) {
    return false;
  }
  this->Local_[slot] = X_PF;
  this->World_.Mark(slot);
  return true;
}

void FrameTree::Evaluate() const {
  this->World_.Evaluate(this->Parents_, this->Local_, this->Revision_);
}

// Called last in every change.
void FrameTree::Emit(FrameEvent::Type type, std::vector<FrameId> ids) {
  ++this->Revision_;
  if (this->Notifier_.HasListeners()) {
    this->Notifier_.Emit({type, std::move(ids), this->Revision_});
  }
}

} // namespace dspace
