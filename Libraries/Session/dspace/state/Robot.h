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

// Joint positions are degrees for revolute and continuous joints, metres for prismatic ones.
class Robot {
public:
  // `linkFrames` has the frame and `linkObjects` the objects of each link of `urdf`, in its order.
  // Every joint starts at zero, or at the limit nearest to zero; call Pose() afterwards. Throws
  // Error(Corrupt), naming the joint, if joints mimic each other in a cycle.
  Robot(std::string name, Urdf urdf, FrameId base, std::vector<FrameId> linkFrames,
        std::vector<std::vector<ObjectId>> linkObjects);

  const std::string& Name() const { return this->Name_; }
  const Urdf& Description() const { return this->Urdf_; }
  FrameId Base() const { return this->Base_; }
  FrameId LinkFrame(std::size_t link) const { return this->LinkFrames_[link]; }
  const std::vector<ObjectId>& LinkObjects(std::size_t link) const {
    return this->LinkObjects_[link];
  }
  // Whether the frame is the base or a link's frame.
  bool HasFrame(FrameId frame) const;
  bool HasObject(ObjectId object) const;

  double Position(std::size_t joint) const { return this->Positions_[joint]; }

  // Sets n joints and moves the frames of their child links and of the joints that mimic them. All
  // values are checked before any joint moves. Throws Error(InvalidArgument), naming the joint, for
  // a joint without its own position (fixed, floating, planar, mimic), for a value that is not
  // finite, and for a value beyond the limits unless `clamp` (a value within 1e-6 rad or m of a
  // limit becomes the limit); NotFound for an index out of range.
  void SetPositions(FrameTree& frames, const std::uint32_t* joints, const double* positions,
                    std::size_t n, bool clamp);

  // Sets the frames of all links to the present joint positions.
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
  std::vector<double> Positions_;       // by joint
  std::vector<std::size_t> MimicOrder_; // mimic joints, each after the one it follows
};

} // namespace dspace::session

#endif
