#include <dspace/session/UrdfVisuals.h>

#include <dspace/Error.h>
#include <dspace/scene/Primitives.h>
#include <dspace/session/PrimitiveParts.h>

namespace dspace::session {
namespace {

constexpr double StandInSize = 0.1; // [m]

Eigen::Affine3d ToAffine(const Pose& X) {
  return Eigen::Affine3d(X.Matrix());
}

// Orange, so that nobody takes it for the part itself.
UrdfGeometry StandIn(const UrdfVisual& visual) {
  auto material = std::make_shared<Material>();
  material->name = "stand-in";
  material->color = {1.0, 0.45, 0.0};
  UrdfGeometry made;
  made.X_LO = ToAffine(visual.X_LV);
  made.parts.push_back(PartOf(MakeBox(Eigen::Vector3d::Constant(StandInSize))));
  made.parts.back().material = std::move(material);
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
    return StandIn(visual); // ReadUrdf has warned of it
  }
  try {
    return MeshOf(context, visual, options);
  } catch (const Error& error) {
    if (options.strict) {
      throw;
    }
    context.reply.add_warning(std::string(error.what()) + "; a stand-in takes its place");
    return StandIn(visual);
  }
}

} // namespace

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
