#include <dspace/commands/objects/UrdfVisuals.h>

#include <sstream>

#include <dspace/Error.h>
#include <dspace/commands/objects/PrimitiveParts.h>
#include <dspace/import/gltf/StatedBounds.h>
#include <dspace/scene/Primitives.h>

namespace dspace::session {
namespace {

constexpr double StandInSize = 0.1; // [m], where nothing says how large the part is
constexpr const char* CubePlaceholder = "; a cube of 0.1 m replaces it";

Eigen::Affine3d ToAffine(const Pose& X) {
  return Eigen::Affine3d(X.Matrix());
}

constexpr double BeamWidth = 0.01; // of the longest edge of a box of beams

// Orange, to distinguish it from the part itself.
std::shared_ptr<const Material> StandInMaterial() {
  auto material = std::make_shared<Material>();
  material->name = "stand-in";
  material->color = {1.0, 0.45, 0.0};
  return material;
}

UrdfGeometry SmallCube(const UrdfVisual& visual) {
  UrdfGeometry made;
  made.X_LO = ToAffine(visual.X_LV);
  made.parts.push_back(PartOf(MakeBox(Eigen::Vector3d::Constant(StandInSize))));
  made.parts.back().material = StandInMaterial();
  return made;
}

// The twelve edges of a box, centred: its faces would hide what is mounted on the part, and blind
// a camera there.
std::vector<Part> Beams(const Eigen::Array3d& size) {
  const auto material = StandInMaterial();
  const Eigen::Array3d width = size.min(BeamWidth * size.maxCoeff());
  std::vector<Part> parts;
  for (int along = 0; along < 3; ++along) {
    Eigen::Array3d edges = width;
    edges[along] = size[along];
    Part beam = PartOf(MakeBox(edges));
    beam.material = material;
    for (int corner = 0; corner < 4; ++corner) {
      Eigen::Array3d side = Eigen::Array3d::Zero();
      side[(along + 1) % 3] = corner % 2 ? 0.5 : -0.5;
      side[(along + 2) % 3] = corner / 2 ? 0.5 : -0.5;
      beam.X_OP = Eigen::Translation3d(side * (size - width));
      parts.push_back(beam);
    }
  }
  return parts;
}

// For a mesh that cannot be read: a box of beams about the bounds that its file states, or a small
// cube.
// `text` ends the warning.
UrdfGeometry StandInForMesh(const UrdfVisual& visual, std::string& text) {
  const Eigen::AlignedBox3d bounds = ReadStatedBounds(visual.meshPath);
  Eigen::Array3d size = Eigen::Array3d::Zero();
  Eigen::Vector3d center = Eigen::Vector3d::Zero();
  if (!bounds.isEmpty()) {
    size = bounds.sizes().array() * visual.size.array().abs();
    center = visual.size.asDiagonal() * bounds.center();
  }
  // No part is larger than this.
  if (!(size.maxCoeff() >= 1e-6 && size.maxCoeff() <= 1e9 && center.norm() <= 1e9)) {
    text = CubePlaceholder;
    return SmallCube(visual);
  }
  std::ostringstream out;
  out.precision(3);
  out << "; the edges of an orange box of " << size.x() << " x " << size.y() << " x " << size.z()
      << " m, the bounds that it states, replace it";
  text = out.str();
  UrdfGeometry made;
  made.X_LO = ToAffine(visual.X_LV) * Eigen::Translation3d(center);
  made.parts = Beams(size.max(1e-3 * size.maxCoeff())); // a flat part has a box all the same
  return made;
}

UrdfGeometry Shape(const UrdfVisual& visual) {
  UrdfGeometry made;
  made.X_LO = ToAffine(visual.X_LV);
  switch (visual.shape) {
  case UrdfVisual::Shape::Cylinder:
    made.parts.push_back(PartOf(MakeCylinder(visual.size.x(), visual.size.z())));
    break;
  case UrdfVisual::Shape::Sphere:
    made.parts.push_back(PartOf(MakeSphere(visual.size.x())));
    break;
  default:
    made.parts.push_back(PartOf(MakeBox(visual.size)));
  }
  if (visual.hasMaterial) {
    made.parts.back().material = std::make_shared<const Material>(visual.material);
  }
  return made;
}

UrdfGeometry MeshOf(const Context& context, const UrdfVisual& visual,
                    const ImportOptions& options) {
  const auto model = context.state.models.LoadModel(visual.meshPath, options);
  for (const std::string& warning : model->warnings) {
    context.reply.add_warning(warning);
  }
  const std::string leftOut = LeftOutWarning(*model, false, false);
  if (!leftOut.empty()) {
    context.reply.add_warning(leftOut);
  }
  UrdfGeometry made;
  made.X_LO = ToAffine(visual.X_LV) * Eigen::Scaling(visual.size);
  made.parts = PartsOf(model);
  // A mesh with materials of its own keeps them: URDF's single colour is for those without (STL).
  if (visual.hasMaterial && model->materials.empty()) {
    const auto material = std::make_shared<const Material>(visual.material);
    for (Part& part : made.parts) {
      part.material = material;
    }
  }
  return made;
}

UrdfGeometry Load(const Context& context, const UrdfVisual& visual, const ImportOptions& options) {
  if (visual.shape != UrdfVisual::Shape::Mesh) {
    return Shape(visual);
  }
  if (visual.missing) {
    return SmallCube(visual); // UrdfWarnings says so
  }
  try {
    return MeshOf(context, visual, options);
  } catch (const Error& error) {
    if (options.strict) {
      throw;
    }
    std::string text;
    UrdfGeometry made = StandInForMesh(visual, text);
    context.reply.add_warning(error.what() + text);
    return made;
  }
}

} // namespace

std::vector<std::string> UrdfWarnings(const Urdf& urdf) {
  std::vector<std::string> warnings = urdf.warnings;
  for (const UrdfLink& link : urdf.links) {
    for (const UrdfVisual& visual : link.visuals) {
      if (visual.missing) {
        warnings[visual.warning] += CubePlaceholder;
      }
    }
  }
  return warnings;
}

std::vector<std::vector<UrdfGeometry>> LoadVisuals(const Context& context, const Urdf& urdf,
                                                   const ImportOptions& options) {
  std::vector<std::vector<UrdfGeometry>> geometry(urdf.links.size());
  for (std::size_t i = 0; i < urdf.links.size(); ++i) {
    for (const UrdfVisual& visual : urdf.links[i].visuals) {
      geometry[i].push_back(Load(context, visual, options));
    }
  }
  return geometry;
}

} // namespace dspace::session
