// The frame tree's poses: setting, composing, evaluating. Its structure is in FrameTree.cxx.
#include <dspace/FrameTree.h>

#include <algorithm>
#include <cmath>
#include <limits>

#include <dspace/Error.h>
#include <dspace/FrameRules.h>

namespace dspace {
namespace {

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

void FrameTree::SetLocalPose(FrameId id, const Pose& X_PF) {
  const SlotIndex slot = this->FindSlot(id);
  this->RefuseRoot(id, "posed");
  if (!IsValidPose(X_PF)) {
    RefusePose(this->Label(id), X_PF);
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
  this->BatchStart_ += n; // also when this call is refused
  for (std::size_t i = 0; i < n; ++i) {
    // A simulation sends the same frames again and again: most often it is the last call's slot.
    SlotIndex& slot = this->BatchSlots_[i];
    if (slot >= this->Ids_.size() || this->Ids_[slot] != ids[i]) {
      slot = this->FindSlot(ids[i]);
    }
    this->RefuseRoot(ids[i], "posed");
    std::uint64_t& row = this->BatchRows_[slot];
    if (row >= start) {
      throw Error(Error::Kind::InvalidArgument, this->Label(ids[i]),
                  "it comes twice, in rows " + std::to_string(row - start) + " and " +
                      std::to_string(i) + "; accepted: each frame once");
    }
    row = start + i;
    const double* pose = poses + PoseSize * i;
    if (!IsPlainlyValid(pose)) {
      const Pose X_PF = PoseFromRow(pose);
      if (!IsValidPose(X_PF)) {
        RefusePose(this->Label(ids[i]) + " (row " + std::to_string(i) + ")", X_PF);
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
  while (w != g) {             // whoever has the larger slot cannot be the other's ancestor
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
    if (this->ChangedAt_[slot] > this->ReportedRevision_) {
      this->Changed_.push_back(this->Ids_[slot]);
    }
  }
  this->ReportedRevision_ = this->Revision_;
  return this->Changed_;
}

const Pose& FrameTree::WorldPose(FrameId id) const {
  this->Evaluate();
  return this->World_[this->FindSlot(id)];
}

std::uint64_t FrameTree::ChangedAt(FrameId id) const {
  this->Evaluate();
  return this->ChangedAt_[this->FindSlot(id)];
}

// False when nothing differs.
bool FrameTree::StorePose(SlotIndex slot, const Pose& X_PF) {
  if (this->Local_[slot] == X_PF) {
    return false;
  }
  this->Local_[slot] = X_PF;
  this->MarkDirty(slot);
  return true;
}

void FrameTree::MarkDirty(SlotIndex slot) {
  this->Dirty_[slot] = 1;
  this->FirstDirty_ = std::min<std::size_t>(this->FirstDirty_, slot);
}

// Whatever is marked dirty was marked with the present revision or an earlier one that was not
// evaluated, so that a parent with ChangedAt_ == Revision_ was evaluated in this very pass.
void FrameTree::Evaluate() const {
  if (this->FirstDirty_ == Clean) {
    return;
  }
  for (std::size_t s = this->FirstDirty_; s < this->Size(); ++s) {
    const SlotIndex parent = this->Parents_[s];
    if (this->Dirty_[s] || this->ChangedAt_[parent] == this->Revision_) {
      this->World_[s] = parent == 0 ? this->Local_[s] : this->World_[parent] * this->Local_[s];
      this->ChangedAt_[s] = this->Revision_;
      this->Dirty_[s] = 0;
      ++this->Evaluations_;
    }
  }
  this->FirstDirty_ = Clean;
}

} // namespace dspace
