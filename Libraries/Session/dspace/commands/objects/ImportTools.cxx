#include <dspace/commands/objects/ImportTools.h>

#include <dspace/Checks.h>
#include <dspace/FrameRules.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

// Files seldom say their unit: a size that no vehicle or building has is pointed out, not changed.
void WarnOfSize(const Model& model, double scale, v1::Reply& reply) {
  const Eigen::AlignedBox3d bounds = model.Bounds();
  const double size = bounds.isEmpty() ? 0.0 : scale * bounds.sizes().maxCoeff();
  if (size > 1000.0 || (size > 0.0 && size < 1e-3)) {
    reply.add_warning("file '" + model.path + "': the model is " + NumberText(size) +
                      " m across; give `scale` if its unit is not the metre");
  }
}

} // namespace

std::string ImportLabel(const v1::ImportObject& command) {
  if (command.level_size() == 0 || command.level(0).path().empty()) {
    Reject("command import_object", "it names no file; accepted: at least one level with a path");
  }
  return "file '" + command.level(0).path() + "'";
}

double ImportScale(const v1::ImportObject& command) {
  const double scale = command.has_scale() ? command.scale() : 1.0;
  Require(scale >= MinimumScale && scale <= MaximumScale, ImportLabel(command), "the scale", scale,
          "1e-12 to 1e12");
  return scale;
}

Eigen::Quaterniond ImportRotation(const v1::ImportObject& command) {
  const std::string file = ImportLabel(command);
  const Eigen::Quaterniond rotation = RotationToZUp(command.up(), file);
  return command.has_rotation() ? ToRotation(command.rotation(), file) * rotation : rotation;
}

std::shared_ptr<const Model> ImportLevel(const Context& context, const v1::ImportObject& command,
                                         v1::ImportObject::Level& level, bool usesLights,
                                         bool usesAnimations) {
  level.set_path(AbsolutePath(level.path()));
  ImportOptions options;
  options.strict = command.strict();
  options.pointCloud = command.point_cloud();
  std::shared_ptr<const Model> model = context.state.models.LoadModel(level.path(), options);
  for (const std::string& warning : model->warnings) {
    context.reply.add_warning(warning);
  }
  const std::string leftOut = LeftOutWarning(*model, usesLights, usesAnimations);
  if (!leftOut.empty()) {
    context.reply.add_warning(leftOut);
  }
  WarnOfSize(*model, command.has_scale() ? command.scale() : 1.0, context.reply);
  return model;
}

} // namespace dspace::session
