#include <dspace/state/ModelNodes.h>

#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/Error.h>
#include <dspace/FrameRules.h>

namespace dspace::session {
namespace {

// Of a product of a rotation and scales; of mirrored axes the first counts as turned over.
Eigen::Quaterniond RotationOf(const Eigen::Affine3d& local) {
  Eigen::Matrix3d turned = Eigen::Matrix3d::Identity();
  for (int k = 0; k < 3; ++k) {
    const double length = local.linear().col(k).norm();
    if (!(length > 0.0)) {
      return Eigen::Quaterniond::Identity();
    }
    turned.col(k) = local.linear().col(k) / length;
  }
  if (turned.determinant() < 0.0) {
    turned.col(0) = -turned.col(0);
  }
  return Eigen::Quaterniond(turned).normalized();
}

} // namespace

ModelNodes::ModelNodes(std::shared_ptr<const Model> model, double scale,
                       const Eigen::Quaterniond& rotation)
    : Model_(std::move(model)), Scale_(scale), Rotation_(rotation.normalized()) {
  std::vector<Eigen::Affine3d> local;
  for (const ModelNode& node : this->Model_->nodes) {
    local.push_back(node.local);
  }
  this->Rest_ = this->Place(local);
  for (const Eigen::Affine3d& node : this->Rest_.nodes) {
    this->RestVolumes_.push_back(std::abs(node.linear().determinant()));
  }
  this->RestPoses_ = this->LocalPoses(this->Rest_);
}

ModelNodes::Placed ModelNodes::Place(const std::vector<Eigen::Affine3d>& local) const {
  Placed placed;
  Eigen::Affine3d X_BM = Eigen::Affine3d::Identity();
  X_BM.linear() = this->Scale_ * this->Rotation_.toRotationMatrix();
  for (std::size_t i = 0; i < local.size(); ++i) {
    const int parent = this->Model_->nodes[i].parent;
    placed.nodes.push_back((parent < 0 ? X_BM : placed.nodes[std::size_t(parent)]) * local[i]);
    Pose frame;
    frame.position = placed.nodes.back().translation();
    frame.rotation = (parent < 0 ? this->Rotation_ : placed.frames[std::size_t(parent)].rotation) *
                     RotationOf(local[i]);
    frame.rotation.normalize();
    if (i < this->RestVolumes_.size() && this->RestVolumes_[i] > 0.0) {
      const double volume = std::abs(placed.nodes.back().linear().determinant());
      const double scale = std::cbrt(volume / this->RestVolumes_[i]);
      // What did not change stays 1 to the bit.
      frame.scale =
          std::abs(scale - 1.0) < 1e-9 ? 1.0 : std::clamp(scale, MinimumScale, MaximumScale);
    }
    placed.frames.push_back(frame);
  }
  return placed;
}

std::vector<Pose> ModelNodes::LocalPoses(const Placed& placed) const {
  std::vector<Pose> poses;
  for (std::size_t i = 0; i < placed.frames.size(); ++i) {
    const int parent = this->Model_->nodes[i].parent;
    const Pose pose = parent < 0 ? placed.frames[i]
                                 : placed.frames[std::size_t(parent)].Inverse() * placed.frames[i];
    if (!IsValidPose(pose)) {
      RejectPose("file '" + this->Model_->path + "', node '" + this->Model_->nodes[i].name + "'",
                 pose);
    }
    poses.push_back(NormalisedPose(pose));
  }
  return poses;
}

std::vector<std::vector<Part>> ModelNodes::NodeParts() const {
  std::vector<Part> all = PartsOf(this->Model_, this->Scale_, this->Rotation_);
  std::vector<std::vector<Part>> parts(this->Model_->nodes.size());
  std::size_t next = 0; // of all, which are in the order of nodes and of their meshes
  for (std::size_t i = 0; i < parts.size(); ++i) {
    const Eigen::Affine3d X_FB(this->Rest_.frames[i].Inverse().Matrix());
    for (std::size_t k = 0; k < this->Model_->nodes[i].meshes.size(); ++k) {
      Part part = std::move(all[next++]);
      part.X_OP = X_FB * part.X_OP;
      if (part.range) {
        part.range->center = X_FB * part.range->center;
      }
      parts[i].push_back(std::move(part));
    }
  }
  return parts;
}

bool ModelNodes::HasFrame(FrameId frame) const {
  return std::find(this->frames.begin(), this->frames.end(), frame) != this->frames.end();
}

bool ModelNodes::HasObject(ObjectId object) const {
  return object != 0 &&
         std::find(this->objects.begin(), this->objects.end(), object) != this->objects.end();
}

const ModelAnimation& ModelNodes::FindAnimation(const std::string& name) const {
  const std::vector<ModelAnimation>& all = this->Model_->animations;
  std::string names;
  for (const ModelAnimation& animation : all) {
    if (name.empty() || animation.name == name) {
      return animation;
    }
    names += (names.empty() ? "'" : ", '") + animation.name + "'";
  }
  throw Error(Error::Kind::NotFound, "file '" + this->Model_->path + "'",
              "it has no animation '" + name + "'; it has: " + (names.empty() ? "none" : names));
}

std::vector<std::string> ModelNodes::PoseAt(FrameTree& tree, const std::string& name,
                                            double time_s) const {
  const ModelAnimation& animation = this->FindAnimation(name);
  if (!std::isfinite(time_s)) {
    Reject("animation '" + animation.name + "'",
           "the time is " + NumberText(time_s) + "; accepted: a finite number of seconds");
  }
  std::vector<bool> moved(this->frames.size(), false), scaled(this->frames.size(), false);
  for (const ModelChannel& channel : animation.channels) {
    moved[std::size_t(channel.node)] = true;
    scaled[std::size_t(channel.node)] =
        scaled[std::size_t(channel.node)] || channel.property == ModelChannel::Property::Scale;
  }
  const Placed placed = this->Place(PoseModel(*this->Model_, animation, time_s));
  const std::vector<Pose> poses = this->LocalPoses(placed);
  std::vector<std::string> uneven;
  std::vector<FrameId> ids;
  std::vector<double> rows;
  for (std::size_t i = 0; i < poses.size(); ++i) {
    const int parent = this->Model_->nodes[i].parent;
    if (parent >= 0 && scaled[std::size_t(parent)]) {
      moved[i] = scaled[i] = true;
    }
    if (!moved[i]) {
      continue;
    }
    ids.push_back(this->frames[i]);
    const Pose& X = poses[i];
    rows.insert(rows.end(), {X.position.x(), X.position.y(), X.position.z(), X.rotation.w(),
                             X.rotation.x(), X.rotation.y(), X.rotation.z(), X.scale});
    // Drawn is the frame with the geometry as it rests in it.
    const Eigen::Affine3d drawn = Eigen::Affine3d(placed.frames[i].Matrix()) *
                                  Eigen::Affine3d(this->Rest_.frames[i].Inverse().Matrix()) *
                                  this->Rest_.nodes[i];
    if ((drawn.linear() - placed.nodes[i].linear()).norm() >
        1e-4 * (drawn.linear().norm() + placed.nodes[i].linear().norm())) {
      uneven.push_back(this->Model_->nodes[i].name);
    }
  }
  tree.SetLocalPoses(ids.data(), rows.data(), ids.size());
  return uneven;
}

} // namespace dspace::session
