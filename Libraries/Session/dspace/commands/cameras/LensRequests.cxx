// Pixels of points and rays of pixels.
#include <limits>

#include <dspace/Checks.h>
#include <dspace/commands/cameras/PlacedLens.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

void Project(const Context& context, v1::ProjectPoints& command) {
  const PlacedLens placed = PlaceLens(context, command.camera());
  const FrameId frame = ToFrame(command.frame());
  const FrameTree& frames = context.Frames();
  frames.Name(frame); // throws where there is none
  const std::string label = "projection by " + placed.model.Label();
  const std::size_t count = RowsOf(command.point_size(), 3, label, "point");
  const Pose X_CG = placed.camera.X_FC.Inverse() * frames.RelativePose(placed.camera.frame, frame);
  v1::ProjectReply& reply = *context.reply.mutable_project();
  reply.mutable_pixel()->Reserve(int(2 * count));
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector3d p_G(command.point().data() + 3 * i);
    RequirePosition(label, "a point", p_G);
    Eigen::Vector2d pixel;
    if (!placed.model.lens->Project(X_CG.Apply(p_G), pixel)) {
      pixel.setConstant(std::numeric_limits<double>::quiet_NaN());
    }
    reply.add_pixel(pixel.x());
    reply.add_pixel(pixel.y());
  }
}

void Unproject(const Context& context, v1::UnprojectPixels& command) {
  const PlacedLens placed = PlaceLens(context, command.camera());
  const FrameId frame = ToFrame(command.frame());
  const FrameTree& frames = context.Frames();
  frames.Name(frame);
  const std::string label = "rays of " + placed.model.Label();
  const std::size_t count = RowsOf(command.pixel_size(), 2, label, "pixel");
  const Pose X_GC = frames.RelativePose(frame, placed.camera.frame) * placed.camera.X_FC;
  v1::UnprojectReply& reply = *context.reply.mutable_unproject();
  reply.mutable_ray()->Reserve(int(6 * count));
  for (std::size_t i = 0; i < count; ++i) {
    const Eigen::Vector2d pixel(command.pixel().data() + 2 * i);
    if (!pixel.allFinite()) {
      Reject(label, "a pixel is (" + NumberText(pixel.x()) + ", " + NumberText(pixel.y()) +
                        "); accepted: finite numbers");
    }
    LensRay ray;
    Eigen::Matrix<double, 6, 1> row;
    row.setConstant(std::numeric_limits<double>::quiet_NaN());
    if (placed.model.lens->Unproject(pixel, ray)) {
      row << X_GC.Apply(ray.origin), X_GC.rotation * ray.direction;
    }
    for (const double value : row) {
      reply.add_ray(value);
    }
  }
}

} // namespace

void AddLensRequests(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kProjectPoints, &C::mutable_project_points, Project);
  registry.Add(C::kUnprojectPixels, &C::mutable_unproject_pixels, Unproject);
}

} // namespace dspace::session
