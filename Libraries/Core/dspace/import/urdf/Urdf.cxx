#include <dspace/import/urdf/Urdf.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <filesystem>
#include <map>
#include <set>
#include <sstream>

#include <dspace/Error.h>
#include <dspace/FileText.h>
#include <dspace/FrameRules.h>
#include <dspace/Utf8.h>
#include <dspace/import/files/ImageReader.h>

#include <dspace/import/files/FileNames.h>
#include <dspace/import/files/ImportFile.h>
#include <dspace/import/files/TextureBudget.h>
#include <dspace/import/urdf/UrdfText.h>

namespace dspace {

namespace {

namespace fs = std::filesystem;

constexpr double DegreesPerRadian = 180.0 / 3.14159265358979323846;

class UrdfReader {
public:
  UrdfReader(const std::string& path, const ImportOptions& options)
      : Path_(path), Options_(options) {}

  Urdf Read() {
    this->Out_.path = this->Path_;
    std::string text = ReadFileBytes(this->Path_, std::size_t(1) << 28);
    const std::string declared = DeclaredEncoding(text);
    text = ToFileText(std::move(text), FileObject(this->Path_), declared);
    const urdf::ModelInterfaceSharedPtr model = ParseUrdfText(
        this->Path_, text, this->Out_.warnings, this->Options_.strict ? nullptr : &this->Repairs_);
    try {
      this->Convert(*model);
    } catch (...) {
      Unlink(*model);
      throw;
    }
    this->MakeTextUtf8();
    this->MapLinkNames();
    for (const std::string& warning : this->Repairs_.Texts()) {
      this->Warn(FileObject(this->Path_) + ": " + ToUtf8(warning), Error::Kind::Corrupt);
    }
    return std::move(this->Out_);
  }

private:
  [[noreturn]] void Fail(const std::string& message,
                         Error::Kind kind = Error::Kind::Corrupt) const {
    throw Error(kind, FileObject(this->Path_), message);
  }

  // urdfdom's links own their children; in a loop they would own themselves and never be freed.
  static void Unlink(urdf::ModelInterface& model) {
    for (auto& link : model.links_) {
      link.second->child_links.clear();
      link.second->child_joints.clear();
    }
  }

  // The parser makes other bytes of character references (&#228;) even in a text of UTF-8.
  void MakeTextUtf8() {
    std::set<std::string> links, joints;
    this->Out_.name = ToUtf8(this->Out_.name);
    for (UrdfLink& link : this->Out_.links) {
      this->MakeNameUtf8("link", link.name, links);
      for (UrdfVisual& visual : link.visuals) {
        visual.name = ToUtf8(visual.name);
        visual.material.name = ToUtf8(visual.material.name);
      }
    }
    for (UrdfJoint& joint : this->Out_.joints) {
      this->MakeNameUtf8("joint", joint.name, joints);
    }
    for (std::string& warning : this->Out_.warnings) {
      warning = ToUtf8(warning);
    }
  }

  void MakeNameUtf8(const char* kind, std::string& name, std::set<std::string>& taken) const {
    name = ToUtf8(name);
    if (!taken.insert(name).second) {
      this->Fail(std::string(kind) + " '" + name + "': two " + kind +
                 "s have this name in different encodings; accepted: one of each name");
    }
  }

  // Frames are named after links, and paths of frames are made of their names.
  void MapLinkNames() {
    std::set<std::string> taken;
    for (const UrdfLink& link : this->Out_.links) {
      taken.insert(link.name);
    }
    for (UrdfLink& link : this->Out_.links) {
      link.originalName = link.name;
      if (IsValidFrameName(link.name)) {
        continue;
      }
      const std::string mapped = MappedFrameName(link.name);
      link.name = mapped;
      for (int n = 2; !taken.insert(link.name).second; ++n) {
        link.name = mapped + "_" + std::to_string(n);
      }
      this->Repairs_.Add("links whose names a path of frames cannot hold are renamed",
                         "'" + link.originalName + "' is '" + link.name + "'");
    }
  }

  void Convert(const urdf::ModelInterface& model) {
    this->Out_.name = model.getName();
    std::map<std::string, const urdf::Joint*> parentOf; // by child link
    std::map<std::string, std::vector<const urdf::Joint*>> jointsOf;
    for (const auto& entry : model.joints_) {
      const urdf::Joint& joint = *entry.second;
      const auto [found, isNew] = parentOf.emplace(joint.child_link_name, &joint);
      if (!isNew) {
        this->Fail("link '" + joint.child_link_name + "' has two parents: joints '" +
                   found->second->name + "' and '" + joint.name + "'");
      }
      jointsOf[joint.parent_link_name].push_back(&joint);
    }
    if (!model.getRoot()) {
      this->Fail("has no link");
    }
    this->Walk(model, jointsOf);
    if (this->Out_.links.size() != model.links_.size()) {
      for (const auto& link : model.links_) {
        if (this->LinkIndex_.count(link.first) == 0) {
          this->Fail("link '" + link.first + "' is part of a loop: it is not reached from link '" +
                     this->Out_.links[0].name + "'");
        }
      }
    }
    this->ConnectMimics();
  }

  // Links from the root on, parents first, each with the joint above it.
  void Walk(const urdf::ModelInterface& model,
            const std::map<std::string, std::vector<const urdf::Joint*>>& jointsOf) {
    struct Waiting {
      std::string link;
      const urdf::Joint* joint;
      int parent;
      int depth;
    };
    std::deque<Waiting> waiting = {{model.getRoot()->name, nullptr, -1, 1}};
    while (!waiting.empty()) {
      const Waiting next = waiting.front();
      waiting.pop_front();
      if (next.depth > MaximumUrdfDepth) {
        this->Fail("link '" + next.link + "' is nested deeper than " +
                   std::to_string(MaximumUrdfDepth));
      }
      const int index = static_cast<int>(this->Out_.links.size());
      UrdfLink link;
      link.name = next.link;
      if (next.joint) {
        link.parentJoint = static_cast<int>(this->Out_.joints.size());
        this->Out_.joints.push_back(this->ConvertJoint(*next.joint, next.parent, index));
        this->Sources_.push_back(next.joint);
      }
      for (const urdf::VisualSharedPtr& visual : model.getLink(next.link)->visual_array) {
        if (visual && visual->geometry) {
          this->AddVisual(*visual, link);
        }
      }
      this->Out_.links.push_back(std::move(link));
      this->LinkIndex_[next.link] = index;
      const auto below = jointsOf.find(next.link);
      for (std::size_t i = 0; below != jointsOf.end() && i < below->second.size(); ++i) {
        const urdf::Joint* joint = below->second[i];
        waiting.push_back({joint->child_link_name, joint, index, next.depth + 1});
      }
    }
  }

  Pose ConvertPose(const urdf::Pose& from, const std::string& where) {
    Pose pose;
    pose.position = {from.position.x, from.position.y, from.position.z};
    pose.rotation =
        Eigen::Quaterniond(from.rotation.w, from.rotation.x, from.rotation.y, from.rotation.z);
    if (!(pose.position.array().abs() <= MaximumCoordinate).all() ||
        !pose.rotation.coeffs().allFinite() || !(pose.rotation.norm() > 1e-6)) {
      this->Repairs_.Add("origins that are not finite, or beyond 1e18 m, are taken as 0", where);
      return {};
    }
    pose.rotation.normalize();
    return pose;
  }

  UrdfJoint ConvertJoint(const urdf::Joint& from, int parent, int child) {
    const std::string where = "joint '" + from.name + "'";
    UrdfJoint joint;
    joint.name = from.name;
    joint.parentLink = parent;
    joint.childLink = child;
    joint.type = this->ConvertType(from, where);
    joint.X_PJ = this->ConvertPose(from.parent_to_joint_origin_transform, where);
    if (joint.type != UrdfJoint::Type::Fixed && joint.type != UrdfJoint::Type::Floating) {
      const Eigen::Vector3d axis(from.axis.x, from.axis.y, from.axis.z);
      if (axis.allFinite() && axis.norm() > 1e-9) {
        joint.axis = axis.normalized();
      } else {
        this->Repairs_.Add("joints whose axis has no direction are taken as fixed", where);
        joint.type = UrdfJoint::Type::Fixed;
      }
    }
    if (from.limits &&
        (joint.type == UrdfJoint::Type::Revolute || joint.type == UrdfJoint::Type::Prismatic)) {
      this->ConvertLimits(*from.limits, where, joint);
    }
    return joint;
  }

  void ConvertLimits(const urdf::JointLimits& from, const std::string& where, UrdfJoint& joint) {
    double lower = from.lower, upper = from.upper;
    if (std::isnan(lower) || std::isnan(upper)) {
      this->Repairs_.Add("limits that are no numbers are left out", where);
      return;
    }
    if (lower > upper) {
      std::ostringstream text;
      text << where << " (" << lower << " to " << upper << ")";
      this->Repairs_.Add("limits that are the wrong way round are exchanged", text.str());
      std::swap(lower, upper);
    }
    // Generators write the largest double where there is no limit.
    constexpr double boundless = 1e300;
    joint.hasLimits = lower > -boundless || upper < boundless;
    if (joint.hasLimits) {
      const double unit = Turns(joint) ? DegreesPerRadian : 1.0;
      joint.lower = std::max(lower, -boundless) * unit;
      joint.upper = std::min(upper, boundless) * unit;
    }
  }

  UrdfJoint::Type ConvertType(const urdf::Joint& from, const std::string& where) const {
    switch (from.type) {
    case urdf::Joint::FIXED:
      return UrdfJoint::Type::Fixed;
    case urdf::Joint::REVOLUTE:
      return UrdfJoint::Type::Revolute;
    case urdf::Joint::CONTINUOUS:
      return UrdfJoint::Type::Continuous;
    case urdf::Joint::PRISMATIC:
      return UrdfJoint::Type::Prismatic;
    case urdf::Joint::FLOATING:
      return UrdfJoint::Type::Floating;
    case urdf::Joint::PLANAR:
      return UrdfJoint::Type::Planar;
    default:
      this->Fail(where + " has no known type");
    }
  }

  static bool Turns(const UrdfJoint& joint) {
    return joint.type == UrdfJoint::Type::Revolute || joint.type == UrdfJoint::Type::Continuous;
  }

  // Mimics refer to joints by name, and in radians; here by index, and in degrees.
  void ConnectMimics() {
    std::map<std::string, int> indexOf;
    for (std::size_t i = 0; i < this->Out_.joints.size(); ++i) {
      indexOf[this->Out_.joints[i].name] = static_cast<int>(i);
    }
    for (std::size_t i = 0; i < this->Out_.joints.size(); ++i) {
      const urdf::JointMimicSharedPtr& mimic = this->Sources_[i]->mimic;
      if (!mimic) {
        continue;
      }
      UrdfJoint& joint = this->Out_.joints[i];
      const std::string where = "joint '" + joint.name + "'";
      const auto found = indexOf.find(mimic->joint_name);
      if (found == indexOf.end()) {
        this->Repairs_.Add("joints that mimic one that does not exist move by themselves",
                           where + " ('" + mimic->joint_name + "')");
        continue;
      }
      if (!std::isfinite(mimic->multiplier) || !std::isfinite(mimic->offset)) {
        this->Repairs_.Add(
            "joints that mimic by a factor or an offset that is not finite move by themselves",
            where);
        continue;
      }
      const double unit = Turns(joint) ? DegreesPerRadian : 1.0;
      const double otherUnit =
          Turns(this->Out_.joints[std::size_t(found->second)]) ? DegreesPerRadian : 1.0;
      joint.mimic = found->second;
      joint.mimicMultiplier = mimic->multiplier * unit / otherUnit;
      joint.mimicOffset = mimic->offset * unit;
    }
    for (UrdfJoint& joint : this->Out_.joints) {
      std::size_t steps = 0;
      for (int i = joint.mimic; i >= 0; i = this->Out_.joints[std::size_t(i)].mimic) {
        if (++steps > this->Out_.joints.size()) {
          this->Repairs_.Add("joints that mimic themselves, through others too, move by themselves",
                             "joint '" + joint.name + "'");
          joint.mimic = -1;
          break;
        }
      }
    }
  }

  void AddVisual(const urdf::Visual& from, UrdfLink& link) {
    const std::string where = "link '" + link.name + "'";
    UrdfVisual visual;
    visual.name = from.name;
    visual.X_LV = this->ConvertPose(from.origin, where);
    switch (from.geometry->type) {
    case urdf::Geometry::BOX: {
      const auto& box = dynamic_cast<const urdf::Box&>(*from.geometry);
      visual.shape = UrdfVisual::Shape::Box;
      visual.size = {box.dim.x, box.dim.y, box.dim.z};
      break;
    }
    case urdf::Geometry::CYLINDER: {
      const auto& cylinder = dynamic_cast<const urdf::Cylinder&>(*from.geometry);
      visual.shape = UrdfVisual::Shape::Cylinder;
      visual.size = {cylinder.radius, cylinder.radius, cylinder.length};
      break;
    }
    case urdf::Geometry::SPHERE:
      visual.shape = UrdfVisual::Shape::Sphere;
      visual.size.setConstant(dynamic_cast<const urdf::Sphere&>(*from.geometry).radius);
      break;
    case urdf::Geometry::MESH: {
      const auto& mesh = dynamic_cast<const urdf::Mesh&>(*from.geometry);
      visual.size = {mesh.scale.x, mesh.scale.y, mesh.scale.z};
      visual.meshPath = this->Resolve(mesh.filename);
      break;
    }
    }
    // A mesh may be mirrored; other shapes have sizes.
    const bool isMesh = visual.shape == UrdfVisual::Shape::Mesh;
    Eigen::Array3d size = visual.size;
    size = isMesh ? size.abs().eval() : size;
    if (!(size >= (isMesh ? MinimumScale : 1e-9) && size <= (isMesh ? MaximumScale : 1e15)).all()) {
      std::ostringstream text;
      text << where << " has " << visual.size.x() << " " << visual.size.y() << " "
           << visual.size.z();
      this->Repairs_.Add(isMesh ? "visuals are left out for the scale of their mesh (accepted: "
                                  "1e-12 to 1e12, or the negative of it)"
                                : "visuals are left out for their size (accepted: 1e-9 to 1e15 "
                                  "metres)",
                         text.str());
      return;
    }
    if (from.material) {
      visual.hasMaterial = true;
      visual.material = this->ConvertMaterial(*from.material, where);
    }
    std::error_code error;
    visual.missing = isMesh && !fs::is_regular_file(visual.meshPath, error);
    if (visual.missing) {
      this->Warn(where + ": its mesh '" + visual.meshPath + "' does not exist");
      visual.warning = this->Out_.warnings.size() - 1;
    }
    link.visuals.push_back(std::move(visual));
  }

  Material ConvertMaterial(const urdf::Material& from, const std::string& where) {
    const auto unit = [&](double v) {
      if (!std::isfinite(v)) {
        this->Repairs_.Add("colours that are not finite are taken as 1",
                           where + ", material '" + from.name + "'");
        return 1.0;
      }
      return std::clamp(v, 0.0, 1.0);
    };
    Material material;
    material.name = from.name;
    material.color = {unit(from.color.r), unit(from.color.g), unit(from.color.b)};
    material.opacity = unit(from.color.a);
    if (!from.texture_filename.empty()) {
      const std::string path = this->Resolve(from.texture_filename);
      auto found = this->Images_.find(path);
      if (found == this->Images_.end()) {
        std::shared_ptr<const Image> image;
        try {
          image = ReadImage(path);
        } catch (const Error& e) {
          this->Warn("material '" + from.name + "': its texture is left out: " + e.what());
        }
        this->TextureBudget_.Add(image.get(), FileObject(this->Path_));
        found = this->Images_.emplace(path, image).first;
      }
      material.texture = found->second;
    }
    return material;
  }

  void Warn(const std::string& message, Error::Kind kind = Error::Kind::NotFound) {
    if (this->Options_.strict) {
      this->Fail(message + " (rejected: strict)", kind);
    }
    this->Out_.warnings.push_back(message);
  }

  // Absolute path of a mesh or texture: file:// and plain names as they are, relative ones from the
  // URDF's folder; package://name/rest as name/rest in that folder or one above it.
  std::string Resolve(const std::string& text) const {
    const std::string name = ToUtf8(text);
    const fs::path folder = fs::absolute(fs::path(this->Path_)).parent_path();
    const std::size_t scheme = name.find("://");
    if (scheme == std::string::npos) {
      return (folder / name).lexically_normal().string();
    }
    const std::string rest = ToUtf8(PercentDecode(name.substr(scheme + 3)));
    if (name.compare(0, scheme, "file") == 0) {
      return (folder / rest).lexically_normal().string();
    }
    if (name.compare(0, scheme, "package") != 0 && name.compare(0, scheme, "model") != 0) {
      return name; // http and others: missing
    }
    const std::size_t slash = std::min(rest.find('/'), rest.size());
    const std::string package = rest.substr(0, slash);
    const std::string inside = slash < rest.size() ? rest.substr(slash + 1) : "";
    std::error_code error;
    for (fs::path above = folder; !above.empty(); above = above.parent_path()) {
      for (const fs::path& candidate :
           {above / rest, above.filename() == package ? above / inside : fs::path()}) {
        if (!candidate.empty() && fs::is_regular_file(candidate, error)) {
          return candidate.lexically_normal().string();
        }
      }
      if (above == above.root_path()) {
        break;
      }
    }
    return (folder / rest).lexically_normal().string();
  }

  const std::string& Path_;
  const ImportOptions& Options_;
  Urdf Out_;
  GroupedWarnings Repairs_;
  std::map<std::string, int> LinkIndex_;
  std::vector<const urdf::Joint*> Sources_; // one a joint of Out_
  std::map<std::string, std::shared_ptr<const Image>> Images_;
  TextureBudget TextureBudget_;
};

} // namespace

Pose UrdfJoint::ChildInParent(double position) const {
  Pose X_JC; // child in the joint's frame
  if (this->type == Type::Revolute || this->type == Type::Continuous) {
    X_JC.rotation = Eigen::AngleAxisd(position / DegreesPerRadian, this->axis);
  } else if (this->type == Type::Prismatic) {
    X_JC.position = position * this->axis;
  }
  return this->X_PJ * X_JC;
}

Urdf ReadUrdf(const std::string& path, const ImportOptions& options) {
  try {
    return UrdfReader(path, options).Read();
  } catch (const Error&) {
    throw;
  } catch (const std::bad_alloc&) {
    throw Error(Error::Kind::Resource, FileObject(path), "not enough memory to read it");
  } catch (const std::exception& e) {
    throw Error(Error::Kind::Corrupt, FileObject(path), std::string("cannot be read: ") + e.what());
  }
}

} // namespace dspace
