#include <dspace/import/worker/UrdfBytes.h>

#include <cmath>
#include <utility>
#include <vector>

#include <dspace/FrameRules.h>
#include <dspace/import/worker/ModelBytes.h>

namespace dspace {
namespace {

// The least bytes of a record, for ByteReader::Count.
constexpr std::size_t LeastLineBytes = 8;
constexpr std::size_t LeastLinkBytes = 28;
constexpr std::size_t LeastVisualBytes = 115;
constexpr std::size_t LeastJointBytes = 142;
constexpr double UnitTolerance = 1e-6;

void WritePose(const Pose& pose, ByteWriter& into) {
  for (const double number :
       {pose.position.x(), pose.position.y(), pose.position.z(), pose.rotation.w(),
        pose.rotation.x(), pose.rotation.y(), pose.rotation.z(), pose.scale}) {
    into.Number(number);
  }
}

double ReadFinite(ByteReader& from) {
  const auto number = from.Number<double>();
  if (!std::isfinite(number)) {
    from.Fail("a number of a robot is not finite");
  }
  return number;
}

Eigen::Vector3d ReadVector(ByteReader& from) {
  Eigen::Vector3d vector;
  for (int i = 0; i < 3; ++i) {
    vector[i] = ReadFinite(from);
  }
  return vector;
}

Pose ReadPose(ByteReader& from) {
  Pose pose;
  pose.position = ReadVector(from);
  pose.rotation.w() = ReadFinite(from);
  pose.rotation.vec() = ReadVector(from);
  pose.scale = ReadFinite(from);
  if (std::abs(pose.rotation.norm() - 1.0) > UnitTolerance || !(pose.scale > 0.0)) {
    from.Fail("a pose of a robot is none");
  }
  return pose;
}

int ReadIndex(ByteReader& from, std::size_t count, int least) {
  const auto index = from.Number<std::int32_t>();
  if (index < least || index >= static_cast<std::int64_t>(count)) {
    from.Fail("a robot names a link, a joint or a warning that is not there");
  }
  return index;
}

void WriteVisual(const UrdfVisual& visual, ByteWriter& into) {
  into.Text(visual.name);
  WritePose(visual.X_LV, into);
  into.Number(static_cast<std::uint8_t>(visual.shape));
  into.Text(visual.meshPath);
  into.Number<std::uint8_t>(visual.missing);
  into.Number<std::uint64_t>(visual.warning);
  for (const double number : visual.size) {
    into.Number(number);
  }
  into.Number<std::uint8_t>(visual.hasMaterial);
}

void WriteJoint(const UrdfJoint& joint, ByteWriter& into) {
  into.Text(joint.name);
  into.Number(static_cast<std::uint8_t>(joint.type));
  into.Number<std::int32_t>(joint.parentLink);
  into.Number<std::int32_t>(joint.childLink);
  WritePose(joint.X_PJ, into);
  for (const double number : joint.axis) {
    into.Number(number);
  }
  into.Number<std::uint8_t>(joint.hasLimits);
  into.Number(joint.lower);
  into.Number(joint.upper);
  into.Number<std::int32_t>(joint.mimic);
  into.Number(joint.mimicMultiplier);
  into.Number(joint.mimicOffset);
}

class Reader {
public:
  Reader(ByteReader& from, const std::string& path) : From_(from) { this->Urdf_.path = path; }

  Urdf Read() {
    Model materials; // CheckModel's
    materials.path = this->Urdf_.path;
    materials.materials = ReadMaterialBytes(this->From_);
    CheckModel(materials);
    this->Materials_ = std::move(materials.materials);
    this->Urdf_.name = this->From_.Text();
    this->Urdf_.warnings.resize(this->From_.Count(LeastLineBytes));
    for (std::string& warning : this->Urdf_.warnings) {
      warning = this->From_.Text();
    }
    this->ReadLinks();
    this->Urdf_.joints.resize(this->From_.Count(LeastJointBytes));
    for (UrdfJoint& joint : this->Urdf_.joints) {
      this->ReadJoint(joint);
    }
    this->CheckTree();
    return std::move(this->Urdf_);
  }

private:
  void ReadLinks() {
    this->Urdf_.links.resize(this->From_.Count(LeastLinkBytes));
    for (UrdfLink& link : this->Urdf_.links) {
      link.name = this->From_.Text();
      link.originalName = this->From_.Text();
      link.parentJoint = this->From_.Number<std::int32_t>();
      link.visuals.resize(this->From_.Count(LeastVisualBytes));
      for (UrdfVisual& visual : link.visuals) {
        this->ReadVisual(visual);
      }
      if (!IsValidFrameName(link.name)) {
        this->From_.Fail("a link has a name that frames cannot have");
      }
    }
    if (this->NextMaterial_ != this->Materials_.size()) {
      this->From_.Fail("a robot has more materials than it uses");
    }
  }

  void ReadVisual(UrdfVisual& visual) {
    visual.name = this->From_.Text();
    visual.X_LV = ReadPose(this->From_);
    visual.shape = this->From_.Enumerator(UrdfVisual::Shape::Sphere);
    visual.meshPath = this->From_.Text();
    visual.missing = this->From_.Flag();
    visual.warning = static_cast<std::size_t>(this->From_.Number<std::uint64_t>());
    if (visual.missing && visual.warning >= this->Urdf_.warnings.size()) {
      this->From_.Fail("a robot names a link, a joint or a warning that is not there");
    }
    visual.size = ReadVector(this->From_);
    visual.hasMaterial = this->From_.Flag();
    if (visual.hasMaterial) {
      if (this->NextMaterial_ >= this->Materials_.size()) {
        this->From_.Fail("a robot has fewer materials than it uses");
      }
      visual.material = this->Materials_[this->NextMaterial_++];
    }
  }

  void ReadJoint(UrdfJoint& joint) {
    const std::size_t links = this->Urdf_.links.size();
    joint.name = this->From_.Text();
    joint.type = this->From_.Enumerator(UrdfJoint::Type::Planar);
    joint.parentLink = ReadIndex(this->From_, links, 0);
    joint.childLink = ReadIndex(this->From_, links, 0);
    joint.X_PJ = ReadPose(this->From_);
    joint.axis = ReadVector(this->From_);
    const bool turns = joint.type == UrdfJoint::Type::Revolute ||
                       joint.type == UrdfJoint::Type::Continuous ||
                       joint.type == UrdfJoint::Type::Prismatic;
    if (turns && std::abs(joint.axis.norm() - 1.0) > UnitTolerance) {
      this->From_.Fail("an axis of a joint is not of unit length");
    }
    joint.hasLimits = this->From_.Flag();
    joint.lower = ReadFinite(this->From_);
    joint.upper = ReadFinite(this->From_);
    joint.mimic = ReadIndex(this->From_, this->Urdf_.joints.size(), -1); // Robot rejects loops
    joint.mimicMultiplier = ReadFinite(this->From_);
    joint.mimicOffset = ReadFinite(this->From_);
  }

  void CheckTree() const {
    const std::vector<UrdfLink>& links = this->Urdf_.links;
    bool good = !links.empty() && links[0].parentJoint == -1 &&
                this->Urdf_.joints.size() + 1 == links.size();
    for (std::size_t i = 1; good && i < links.size(); ++i) {
      const int parent = links[i].parentJoint;
      good = parent >= 0 && static_cast<std::size_t>(parent) < this->Urdf_.joints.size();
      if (good) {
        const UrdfJoint& joint = this->Urdf_.joints[static_cast<std::size_t>(parent)];
        good = static_cast<std::size_t>(joint.childLink) == i &&
               static_cast<std::size_t>(joint.parentLink) < i;
      }
    }
    if (!good) {
      this->From_.Fail("the links of a robot are no tree");
    }
  }

  ByteReader& From_;
  Urdf Urdf_;
  std::vector<Material> Materials_; // one for each visual that has one, in their order
  std::size_t NextMaterial_ = 0;
};

} // namespace

void WriteUrdf(const Urdf& urdf, ByteWriter& into) {
  std::vector<const Material*> materials;
  for (const UrdfLink& link : urdf.links) {
    for (const UrdfVisual& visual : link.visuals) {
      if (visual.hasMaterial) {
        materials.push_back(&visual.material);
      }
    }
  }
  WriteMaterials(materials, into);
  into.Text(urdf.name);
  into.Number<std::uint64_t>(urdf.warnings.size());
  for (const std::string& warning : urdf.warnings) {
    into.Text(warning);
  }
  into.Number<std::uint64_t>(urdf.links.size());
  for (const UrdfLink& link : urdf.links) {
    into.Text(link.name);
    into.Text(link.originalName);
    into.Number<std::int32_t>(link.parentJoint);
    into.Number<std::uint64_t>(link.visuals.size());
    for (const UrdfVisual& visual : link.visuals) {
      WriteVisual(visual, into);
    }
  }
  into.Number<std::uint64_t>(urdf.joints.size());
  for (const UrdfJoint& joint : urdf.joints) {
    WriteJoint(joint, into);
  }
}

Urdf ReadUrdfBytes(ByteReader& from, const std::string& path) {
  return Reader(from, path).Read();
}

} // namespace dspace
