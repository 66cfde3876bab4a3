// An articulated model in a scene: its links are frames, its joints move them.
#ifndef DSPACE_SESSION_ROBOT_H
#define DSPACE_SESSION_ROBOT_H

#include <cstdint>
#include <string>
#include <vector>

#include <dspace/FrameTree.h>
#include <dspace/import/urdf/Urdf.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace::session {

// Positions of joints: degrees for revolute and continuous ones, metres for prismatic ones.
class Robot {
public:
  // `linkFrames` holds a frame and `linkObjects` the objects of each link of `urdf`, in its order.
  // Starts with every joint at zero, or at the limit nearest to zero; call Pose() then.
  // Throws Error(Corrupt) naming the joint where joints mimic each other in a circle.
  Robot(std::string name, Urdf urdf, FrameId base, std::vector<FrameId> linkFrames,
        std::vector<std::vector<ObjectId>> linkObjects);

  const std::string& Name() const { return this->Name_; }
  const Urdf& Description() const { return this->Urdf_; }
  FrameId Base() const { return this->Base_; }
  FrameId LinkFrame(std::size_t link) const { return this->LinkFrames_[link]; }
  const std::vector<ObjectId>& LinkObjects(std::size_t link) const {
    return this->LinkObjects_[link];
  }
  // The base, or a link's frame.
  bool HasFrame(FrameId frame) const;
  bool HasObject(ObjectId object) const;

  double Position(std::size_t joint) const { return this->Positions_[joint]; }

  // Sets n joints and moves the frames of their child links and of those that mimic them. All are
  // checked before any moves. Throws Error(InvalidArgument) naming the joint for one that has no
  // position of its own (fixed, floating, planar, mimic), a value that is not finite, and one
  // beyond its limits unless `clamp` (by less than 1e-6 rad or m: the limit is taken); NotFound for
  // an index out of range.
  void SetPositions(FrameTree& frames, const std::uint32_t* joints, const double* positions,
                    std::size_t n, bool clamp);

  // Writes the frames of all links as the joints stand.
  void Pose(FrameTree& frames) const;

private:
  double CheckedPosition(std::size_t joint, double position, bool clamp) const;
  void FollowMimics(std::vector<double>& positions) const;
  void Write(FrameTree& frames, const std::vector<double>& positions, bool all) const;

  std::string Name_;
  Urdf Urdf_;
  FrameId Base_;
  std::vector<FrameId> LinkFrames_;
  std::vector<std::vector<ObjectId>> LinkObjects_;
  std::vector<double> Positions_;       // a joint
  std::vector<std::size_t> MimicOrder_; // mimic joints, each after the one it follows
};

} // namespace dspace::session

#endif
