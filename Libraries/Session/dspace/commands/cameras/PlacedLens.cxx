#include <dspace/commands/cameras/PlacedLens.h>

#include <cmath>

#include <dspace/Checks.h>
#include <dspace/camera/files/CameraJson.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

constexpr int MostSide = 1000000;
constexpr std::size_t MostModelBytes = 65536; // as lenses.proto states it

// The lens that a projection of the scene's is.
LensPtr LensOf(const Projection& from, int width, int height, const std::string& label) {
  const double w = width, h = height;
  const std::vector<double> middle = {0.5 * w - 0.5, 0.5 * h - 0.5};
  switch (from.kind) {
  case Projection::Kind::Orthographic:
    return MakeLens("orthographic",
                    {{"scale", {h / from.height, h / from.height}}, {"center", middle}}, label);
  case Projection::Kind::Frustum: {
    const double fx = w / (from.right - from.left), fy = h / (from.bottom - from.top);
    return MakeLens(
        "pinhole", {{"focal", {fx, fy}}, {"center", {-from.left * fx - 0.5, -from.top * fy - 0.5}}},
        label);
  }
  case Projection::Kind::Perspective:
    break;
  }
  const double f = 0.5 * h / std::tan(0.5 * from.verticalFov_deg * M_PI / 180.0);
  return MakeLens("pinhole", {{"focal", {f, f}}, {"center", middle}}, label);
}

std::string SizeText(int width, int height) {
  return std::to_string(width) + " x " + std::to_string(height);
}

void SetSize(dspace::CameraModel& model, int width, int height, bool scale) {
  if ((width == 0) != (height == 0) || width > MostSide || height > MostSide) {
    Reject(model.Label(), "the size is " + SizeText(width, height) +
                              "; accepted: 1 to 1000000 a side, or 0 x 0 for the model's own");
  }
  if (width == 0) {
    if (model.width == 0) {
      Reject(model.Label(),
             "it does not say for which size of image it is; accepted: a size with it");
    }
    return;
  }
  if (model.width == 0) {
    model.width = width;
    model.height = height;
  } else if (model.width != width || model.height != height) {
    if (!scale) {
      Reject(model.Label(), "the size is " + SizeText(width, height) + "; accepted: its own, " +
                                SizeText(model.width, model.height) +
                                ", or another of the same shape with scale");
    }
    model = model.Scaled(width, height);
  }
}

} // namespace

dspace::CameraModel ParseModel(const std::string& json) {
  if (json.size() > MostModelBytes) {
    Reject("camera model",
           "the model has " + std::to_string(json.size()) + " bytes; accepted: up to 65,536");
  }
  const std::vector<dspace::CameraModel> models = ParseCameraJson(json, "camera model");
  if (models.size() != 1) {
    Reject("camera model", "it holds " + std::to_string(models.size()) + " models; accepted: one");
  }
  return models.front();
}

PlacedLens PlaceLens(const Context& context, const v1::CameraModel& from) {
  PlacedLens placed;
  const Scene& scene = context.GetScene();
  const std::string vantage = from.vantage().empty() ? DefaultVantage : from.vantage();
  const int width = ToInt(from.width()), height = ToInt(from.height());
  if (!from.model().empty()) {
    placed.model = ParseModel(from.model());
    SetSize(placed.model, width, height, from.scale());
  } else if (from.own_pose()) {
    Reject("camera model", "own_pose is set without a model; accepted: a model with it");
  }
  if (from.own_pose()) {
    placed.camera.frame = ToFrame(from.frame());
    scene.Frames().Name(placed.camera.frame); // throws where there is none
    placed.camera.X_FC.position = placed.model.p_MC;
    placed.camera.X_FC.rotation = placed.model.q_MC;
    return placed;
  }
  placed.camera = scene.PlaceCamera(vantage, from.camera());
  if (from.model().empty()) {
    const SceneVantage& found = scene.Vantage(vantage);
    const Camera& camera =
        from.camera().empty() ? found.ActiveCamera() : found.GetCamera(from.camera());
    placed.model.name = camera.name;
    if (width < 1 || height < 1 || width > MostSide || height > MostSide) {
      Reject(placed.model.Label(), "the size is " + SizeText(width, height) +
                                       "; accepted: 1 to 1000000 a side, or a model");
    }
    placed.model.width = width;
    placed.model.height = height;
    placed.model.lens = LensOf(camera.projection, width, height, placed.model.Label());
  }
  return placed;
}

} // namespace dspace::session
