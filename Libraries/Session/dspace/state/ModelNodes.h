// A model in a scene whose nodes are frames.
#ifndef DSPACE_SESSION_MODEL_NODES_H
#define DSPACE_SESSION_MODEL_NODES_H

#include <memory>
#include <string>
#include <vector>

#include <dspace/FrameTree.h>
#include <dspace/import/model/Model.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace::session {

// The frame of a node stands where the node's origin is and is turned as the node is. It has scale
// 1: what of the node's transform no frame can hold is between the frame and the node's geometry.
class ModelNodes {
public:
  // `scale` and `rotation` as in PartsOf.
  ModelNodes(std::shared_ptr<const Model> model, double scale, const Eigen::Quaterniond& rotation);

  const Model& GetModel() const { return *this->Model_; }
  // The local poses of the nodes' frames as the file has them.
  const std::vector<Pose>& RestPoses() const { return this->RestPoses_; }
  // The parts of each node, in the coordinates of its frame.
  std::vector<std::vector<Part>> NodeParts() const;

  // The frames and objects that were made; of objects, 0 for a node without geometry.
  FrameId base = NoFrame;
  std::vector<FrameId> frames;
  std::vector<ObjectId> objects;

  bool HasFrame(FrameId frame) const; // one of `frames`
  bool HasObject(ObjectId object) const;

  // Sets the frames that the animation moves to a time. Throws Error: NotFound, naming the
  // animations, for one that the file lacks (empty: the first); InvalidArgument for a time that is
  // not finite. Returns the names of nodes whose scale no frame can hold.
  std::vector<std::string> PoseAt(FrameTree& frames, const std::string& animation,
                                  double time_s) const;

private:
  struct Placed { // all in the coordinates of the base frame
    std::vector<Eigen::Affine3d> nodes;
    std::vector<Pose> frames;
  };
  Placed Place(const std::vector<Eigen::Affine3d>& local) const;
  std::vector<Pose> LocalPoses(const Placed& placed) const;
  const ModelAnimation& FindAnimation(const std::string& name) const;

  std::shared_ptr<const Model> Model_;
  double Scale_;
  Eigen::Quaterniond Rotation_;
  std::vector<double> RestVolumes_; // determinants, in file coordinates
  Placed Rest_;
  std::vector<Pose> RestPoses_;
};

} // namespace dspace::session

#endif
