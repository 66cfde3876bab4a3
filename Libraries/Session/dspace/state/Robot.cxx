#include <dspace/state/Robot.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include <dspace/Checks.h>

namespace dspace::session {
namespace {

bool HasPosition(const UrdfJoint& joint) {
  return joint.type == UrdfJoint::Type::Revolute || joint.type == UrdfJoint::Type::Continuous ||
         joint.type == UrdfJoint::Type::Prismatic;
}

const char* UnitOf(const UrdfJoint& joint) {
  return joint.type == UrdfJoint::Type::Prismatic ? " m" : " degrees";
}

// Mimic joints, each after the one it follows.
std::vector<std::size_t> OrderOfMimics(const Urdf& urdf) {
  std::vector<std::size_t> order;
  std::vector<int> state(urdf.joints.size(), 0); // 1: being followed, 2: done
  for (std::size_t start = 0; start < urdf.joints.size(); ++start) {
    std::vector<std::size_t> chain;
    std::size_t joint = start;
    while (state[joint] == 0) {
      state[joint] = 1;
      chain.push_back(joint);
      if (urdf.joints[joint].mimic < 0) {
        break;
      }
      joint = std::size_t(urdf.joints[joint].mimic);
      if (state[joint] == 1) {
        throw Error(Error::Kind::Corrupt, "file '" + urdf.path + "'",
                    "joint '" + urdf.joints[joint].name + "' mimics itself through other joints");
      }
    }
    for (auto it = chain.rbegin(); it != chain.rend(); ++it) {
      state[*it] = 2;
      if (urdf.joints[*it].mimic >= 0) {
        order.push_back(*it);
      }
    }
  }
  return order;
}

} // namespace

Robot::Robot(std::string name, Urdf urdf, FrameId base, std::vector<FrameId> linkFrames,
             std::vector<std::vector<ObjectId>> linkObjects)
    : Name_(std::move(name)), Urdf_(std::move(urdf)), Base_(base),
      LinkFrames_(std::move(linkFrames)), LinkObjects_(std::move(linkObjects)),
      Positions_(Urdf_.joints.size(), 0.0), MimicOrder_(OrderOfMimics(Urdf_)) {
  for (std::size_t i = 0; i < this->Positions_.size(); ++i) {
    const UrdfJoint& joint = this->Urdf_.joints[i];
    if (joint.hasLimits && joint.mimic < 0) {
      this->Positions_[i] = std::min(std::max(0.0, joint.lower), joint.upper);
    }
  }
  this->FollowMimics(this->Positions_);
}

bool Robot::HasFrame(FrameId frame) const {
  return frame == this->Base_ || std::find(this->LinkFrames_.begin(), this->LinkFrames_.end(),
                                           frame) != this->LinkFrames_.end();
}

bool Robot::HasObject(ObjectId object) const {
  for (const std::vector<ObjectId>& objects : this->LinkObjects_) {
    if (std::find(objects.begin(), objects.end(), object) != objects.end()) {
      return true;
    }
  }
  return false;
}

double Robot::CheckedPosition(std::size_t index, double position, bool clamp) const {
  const UrdfJoint& joint = this->Urdf_.joints[index];
  const std::string label = "joint '" + joint.name + "' of robot '" + this->Name_ + "'";
  if (!HasPosition(joint)) {
    Reject(label, "it has no position to set; accepted: revolute, continuous and prismatic joints");
  }
  if (joint.mimic >= 0) {
    Reject(label, "it follows joint '" + this->Urdf_.joints[std::size_t(joint.mimic)].name +
                      "'; set that one");
  }
  RequireFinite(label, "the position", position);
  if (!joint.hasLimits) {
    // Beyond this, a ten-thousandth of a degree is lost, and a wheel's angle is meaningless.
    if (joint.type != UrdfJoint::Type::Prismatic) {
      Require(std::abs(position) <= 1e12, label, "the position", position,
              "within 1e12 degrees of 0");
    }
    return position;
  }
  // Rounded radians in a file must not reject the round number of degrees that they represent.
  const double slack = joint.type == UrdfJoint::Type::Prismatic ? 1e-6 : 1e-6 * 180.0 / M_PI;
  if (!clamp && (position < joint.lower - slack || position > joint.upper + slack)) {
    Reject(label, "the position is " + NumberText(position) + "; accepted: " +
                      NumberText(joint.lower) + " to " + NumberText(joint.upper) + UnitOf(joint));
  }
  return std::min(std::max(position, joint.lower), joint.upper);
}

void Robot::FollowMimics(std::vector<double>& positions) const {
  for (const std::size_t i : this->MimicOrder_) {
    const UrdfJoint& joint = this->Urdf_.joints[i];
    positions[i] = joint.mimicMultiplier * positions[std::size_t(joint.mimic)] + joint.mimicOffset;
  }
}

void Robot::SetPositions(FrameTree& frames, const std::uint32_t* joints, const double* positions,
                         std::size_t n, bool clamp) {
  std::vector<double> next = this->Positions_;
  for (std::size_t i = 0; i < n; ++i) {
    if (joints[i] >= next.size()) {
      throw Error(Error::Kind::NotFound, "robot '" + this->Name_ + "'",
                  "there is no joint " + std::to_string(joints[i]) + "; accepted: 0 to " +
                      std::to_string(next.size() - 1));
    }
    next[joints[i]] = this->CheckedPosition(joints[i], positions[i], clamp);
  }
  this->FollowMimics(next);
  this->Write(frames, next, false);
  this->Positions_ = std::move(next);
}

void Robot::Pose(FrameTree& frames) const {
  this->Write(frames, this->Positions_, true);
}

void Robot::Write(FrameTree& frames, const std::vector<double>& positions, bool all) const {
  std::vector<FrameId> ids;
  std::vector<double> rows;
  for (std::size_t i = 0; i < positions.size(); ++i) {
    if (!all && positions[i] == this->Positions_[i]) {
      continue;
    }
    const UrdfJoint& joint = this->Urdf_.joints[i];
    const dspace::Pose X = joint.ChildInParent(positions[i]);
    ids.push_back(this->LinkFrames_[std::size_t(joint.childLink)]);
    rows.insert(rows.end(), {X.position.x(), X.position.y(), X.position.z(), X.rotation.w(),
                             X.rotation.x(), X.rotation.y(), X.rotation.z(), X.scale});
  }
  if (!ids.empty()) {
    frames.SetLocalPoses(ids.data(), rows.data(), ids.size());
  }
}

} // namespace dspace::session
