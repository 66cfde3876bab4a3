// The tree of frames: names, parents and poses, in flat arrays. Parents come before children.
#ifndef DSPACE_FRAME_TREE_H
#define DSPACE_FRAME_TREE_H

#include <cstddef>
#include <cstdint>
#include <string>
#include <unordered_map>
#include <unordered_set>
#include <vector>

#include <dspace/FrameEvents.h>
#include <dspace/Pose.h>
#include <dspace/WorldPoses.h>

namespace dspace {

// A frame F has a name, a parent P and a local pose X_PF (metres, unit quaternion, scale).
// The root frame (id 1, name "root") always exists; its axes are the world's, it has no pose of its
// own and cannot be removed, renamed, reparented or posed.
//
// Names have 1 to 255 bytes, are neither "." nor "..", hold no '/' and no control characters (bytes
// below 32, and 127), and differ among siblings. A path joins names by '/', beginning below the
// root: "rover/mast/camera". The root's own path is "/".
//
// Poses: position within 1e18 m on each axis, scale 1e-12 to 1e12, quaternion unit within 1e-6
// (FrameRules.h). A quaternion is stored normalised; one that is already unit to rounding is stored
// as it is, so that a pose that is read and set again stays the same to the bit. A pose equal to
// the stored one is no change.
//
// Every function that takes an id throws Error(NotFound) for one that is not in the tree. A
// function that throws an Error leaves the tree as it was. Exceptions of listeners (FrameEvents.h)
// are passed on after the change was made.
//
// Not synchronised. Const functions may run in several threads at once when none changes the tree;
// for WorldPose and ChangedAt this holds only after Update().
class FrameTree {
public:
  FrameTree();
  FrameTree(const FrameTree&) = delete;
  FrameTree& operator=(const FrameTree&) = delete;

  // --- Structure -------------------------------------------------------------------------------

  // A new frame at pose X_PF in `parent`. `id` 0 takes the id after the largest one ever used;
  // another value, at most 2^63 - 1, is taken as it is, so that a recording can be replayed.
  // Throws AlreadyExists when the id is or ever was in use or a sibling has the name;
  // InvalidArgument for a bad name or pose; NotFound for the parent. Amortised constant time.
  FrameId Create(FrameId parent, const std::string& name, const Pose& X_PF = {},
                 FrameId id = NoFrame);

  // New frames, all or none: the i-th has names[i], the parent parents[i] (or parents[0], where
  // there is one) and the pose of the i-th row of `poses` (px py pz qw qx qy qz scale; null:
  // identity). Ids ascend one by one from `first`, or from the one after the largest ever used.
  // A parent may be an earlier one of them. Returns the first id. Throws as Create(), and
  // InvalidArgument without names or where the numbers of names and parents do not fit.
  FrameId CreateMany(std::vector<std::string> names, const std::vector<FrameId>& parents,
                     const double* poses = nullptr, FrameId first = NoFrame);

  // Removes the frame and its subtree; returns their ids, children before parents. Takes time in
  // proportion to the slots from the frame's on.
  std::vector<FrameId> Remove(FrameId id);

  // Moves the frame with its subtree under `newParent`, as its last child. With `keepWorldPose` the
  // local pose becomes RelativePose(newParent, id), else it stays. Throws InvalidArgument when
  // newParent is in the subtree, AlreadyExists when it has a child of that name. Passing the
  // current parent is no change.
  void Reparent(FrameId id, FrameId newParent, bool keepWorldPose);

  // Passing the current name is no change. Throws as Create() for a bad or taken name.
  void Rename(FrameId id, const std::string& name);

  bool Contains(FrameId id) const { return this->SlotOf_.count(id) != 0; }
  // Frames, the root among them.
  std::size_t Size() const { return this->Ids_.size(); }
  // The frame at `path` below `base`, or NoFrame; "/" is `base` itself.
  FrameId Find(const std::string& path, FrameId base = RootFrame) const;
  std::string Path(FrameId id) const;
  const std::string& Name(FrameId id) const;
  // NoFrame for the root.
  FrameId Parent(FrameId id) const;
  // In the order in which they were created under (or moved to) this frame.
  const std::vector<FrameId>& Children(FrameId id) const;

  // --- Poses -----------------------------------------------------------------------------------

  void SetLocalPose(FrameId id, const Pose& X_PF);
  // n frames at once; `poses` holds n rows of px py pz qw qx qy qz scale. Every row is checked
  // before any is applied. Throws InvalidArgument where an id comes twice.
  void SetLocalPoses(const FrameId* ids, const double* poses, std::size_t n);

  // X_PF.
  const Pose& LocalPose(FrameId id) const;
  // X_WG, through the nearest common ancestor of W and G: what lies above it adds no rounding, so
  // that two frames that share a far-away ancestor keep their precision. Local poses are returned
  // to the bit: RelativePose(Parent(id), id) == LocalPose(id).
  Pose RelativePose(FrameId W, FrameId G) const;
  // X_WF of every frame F, by slot; equal to the bit to RelativePose(W, F). One pass.
  void RelativePoses(FrameId W, std::vector<Pose>& out) const;

  // --- Evaluation, once a step and only where something changed ----------------------------------

  // Evaluates the root-relative poses of changed frames and of their subtrees. Returns the frames
  // whose root-relative pose was evaluated since the previous Update() (including new frames),
  // parents first. The reference is valid until the next Update().
  const std::vector<FrameId>& Update();
  // X_RootF, equal to the bit to RelativePose(RootFrame, id). Up to date without Update().
  const Pose& WorldPose(FrameId id) const;
  // Grows with every change of the tree; equal revisions mean nothing changed.
  std::uint64_t Revision() const { return this->Revision_; }
  // The revision with which the frame's root-relative pose was last evaluated; 0 for the root.
  std::uint64_t ChangedAt(FrameId id) const;
  // Root-relative poses evaluated so far in this tree's life.
  std::uint64_t Evaluations() const { return this->World_.Evaluations(); }

  // --- Flat order --------------------------------------------------------------------------------

  // Place in the arrays: 0 for the root, smaller for a parent than for its children, below Size().
  // Slots stay until a Remove or Reparent.
  std::size_t Slot(FrameId id) const { return this->FindSlot(id); }
  FrameId IdAt(std::size_t slot) const;

  // --- Events ------------------------------------------------------------------------------------

  FrameNotifier::Token AddListener(FrameNotifier::Listener listener);
  // False when the token is unknown.
  bool RemoveListener(FrameNotifier::Token token) { return this->Notifier_.Remove(token); }

private:
  using SlotIndex = std::uint32_t;
  // Data that evaluating poses does not need.
  struct Node {
    std::string name;
    std::vector<FrameId> children;
  };
  struct ChildKey {
    FrameId parent;
    std::string name;
    bool operator==(const ChildKey& o) const {
      return this->parent == o.parent && this->name == o.name;
    }
  };
  struct ChildKeyHash {
    std::size_t operator()(const ChildKey& key) const {
      return std::hash<std::string>()(key.name) ^ (key.parent * 0x9E3779B97F4A7C15ull);
    }
  };

  void Append(FrameId parent, std::string name, const Pose& X_PF, FrameId id);
  void DropFrom(std::size_t first);
  SlotIndex FindSlot(FrameId id) const;
  std::string PathOfSlot(SlotIndex slot) const;
  std::string Label(FrameId id) const; // "frame 'rover/mast'", for messages
  void RejectRoot(FrameId id, const char* what) const;
  void RejectTakenName(FrameId parent, const std::string& name) const;
  void DetachFromParent(SlotIndex slot);
  std::vector<char> SubtreeFrom(SlotIndex slot) const;
  void Reorder(SlotIndex first, SlotIndex last, const std::vector<SlotIndex>& order);
  bool StorePose(SlotIndex slot, const Pose& X_PF);
  void Evaluate() const;
  void Emit(FrameEvent::Type type, std::vector<FrameId> ids);

  // By slot.
  std::vector<FrameId> Ids_;
  std::vector<SlotIndex> Parents_; // the root's is 0
  std::vector<Pose> Local_;        // X_PF
  std::vector<Node> Nodes_;
  mutable WorldPoses World_; // X_RootF, evaluated on demand

  std::unordered_map<FrameId, SlotIndex> SlotOf_;
  std::unordered_map<ChildKey, FrameId, ChildKeyHash> ChildOf_;
  std::unordered_set<FrameId> Retired_; // ids of removed frames
  FrameId LargestId_ = RootFrame;
  std::uint64_t Revision_ = 0;
  std::uint64_t ReportedRevision_ = 0; // of the last Update()
  std::vector<FrameId> Changed_;
  // Scratch of SetLocalPoses: slots by row, and by slot in which row of which call it came last.
  std::vector<SlotIndex> BatchSlots_;
  std::vector<std::uint64_t> BatchRows_;
  std::uint64_t BatchStart_ = 1; // what the present call's row 0 is in BatchRows_
  FrameNotifier Notifier_;
};

} // namespace dspace

#endif
