// Pictures through lenses.
#include <algorithm>
#include <cmath>

#include <dspace/Checks.h>
#include <dspace/camera/files/CameraJson.h>
#include <dspace/commands/viewports/BuriedCamera.h>
#include <dspace/commands/viewports/ViewportCommands.h>
#include <dspace/messages/Convert.h>
#include <dspace/scene/Light.h>

#include "vtkDspaceRenderContext.h"

namespace dspace::session {
namespace {

constexpr std::uint64_t MostPixels = 1u << 24; // of a tile

// sRGB (IEC 61966-2-1) of linear light, rounded.
std::uint8_t ToSrgb(double linear) {
  const double x = std::clamp(linear, 0.0, 1.0);
  const double encoded = x <= 0.0031308 ? 12.92 * x : 1.055 * std::pow(x, 1.0 / 2.4) - 0.055;
  return std::uint8_t(std::lround(255.0 * encoded));
}

std::vector<std::uint8_t> ColorsOf(const std::vector<float>& radiance, double exposure) {
  const double factor = exposure * M_PI / SolarConstant;
  std::vector<std::uint8_t> colors(radiance.size() / 3 * 4, 255);
  for (std::size_t i = 0; i < radiance.size() / 3; ++i) {
    for (std::size_t k = 0; k < 3; ++k) {
      colors[4 * i + k] = ToSrgb(factor * double(radiance[3 * i + k]));
    }
  }
  return colors;
}

// The tile in the command's request; a width or height of 0 reaches to the edge.
void SetTile(const v1::SimulateImage& command, const std::string& label,
             LensPictures::Request& request) {
  const dspace::CameraModel& model = request.lens.model;
  request.x = ToInt(command.x());
  request.y = ToInt(command.y());
  const auto side = [](std::uint32_t given, int begin, int whole) {
    return given == 0 ? std::max(whole - begin, 0) : ToInt(given);
  };
  request.width = side(command.tile_width(), request.x, model.width);
  request.height = side(command.tile_height(), request.y, model.height);
  const auto text = [](int a, int b) { return std::to_string(a) + " x " + std::to_string(b); };
  if (request.width < 1 || request.height < 1 || request.width > model.width - request.x ||
      request.height > model.height - request.y) {
    Reject(label, "a tile of " + text(request.width, request.height) + " pixels at (" +
                      std::to_string(request.x) + ", " + std::to_string(request.y) +
                      ") is rejected; accepted: tiles within its " +
                      text(model.width, model.height) + " pixels");
  }
  if (std::uint64_t(request.width) * std::uint64_t(request.height) > MostPixels) {
    throw Error(Error::Kind::Resource, label,
                "a tile of " + text(request.width, request.height) +
                    " pixels is rejected; accepted: up to " + std::to_string(MostPixels) +
                    " pixels in one tile");
  }
}

} // namespace

void ViewportCommands::Simulate(const Context& context, v1::SimulateImage& command) {
  LensPictures::Request request;
  request.lens = PlaceLens(context, command.camera());
  const std::string label = "image of " + request.lens.model.Label();
  LensWishes& wishes = request.wishes;
  wishes.radiance = command.radiance() || command.color();
  wishes.depth = command.depth();
  wishes.range = command.range();
  wishes.label = command.label();
  wishes.litFraction = command.lit_fraction();
  wishes.incidence = command.incidence();
  wishes.emission = command.emission();
  wishes.phase = command.phase();
  wishes.normal = command.normal();
  RequirePlane(wishes.radiance || wishes.depth || wishes.range || wishes.label ||
                   wishes.litFraction || wishes.incidence || wishes.emission || wishes.phase ||
                   wishes.normal,
               label);
  for (const std::string& fragment : command.hidden_fragment()) {
    context.GetScene().Fragments().Get(fragment); // throws where there is none
    request.hiddenFragments.insert(fragment);
  }
  request.ornaments = command.ornaments();
  request.samples = command.has_samples() ? ToInt(command.samples()) : 2;
  const double exposure = command.has_exposure() ? command.exposure() : 1.0;
  Require(exposure > 0.0 && exposure <= 1e12, label, "the exposure", exposure, "above 0, to 1e12");
  SetTile(command, label, request);
  constexpr double Rounding = 1e-3; // [m] of a camera on the ground
  for (const auto& [name, depth] : GroundsOver(*context.scene, request.lens.camera)) {
    const ObjectId terrain = context.scene->terrains.at(name)->Object();
    if (depth > Rounding &&
        request.hiddenFragments.count(context.GetScene().Object(terrain).fragment) == 0) {
      Reject(label, "the camera is " + NumberText(depth) + " m below the ground of terrain '" +
                        name + "'; accepted: a camera above ground, or a picture that hides it");
    }
  }
  v1::SimulateImage alike = command;
  alike.clear_x();
  alike.clear_y();
  alike.clear_tile_width();
  alike.clear_tile_height();
  alike.clear_inline_data();
  alike.clear_exposure();
  request.key = alike.SerializeAsString();
  // A model is the same lens from every camera; a projection of the scene's may change.
  const dspace::CameraModel& model = request.lens.model;
  request.lensKey = CameraJsonOf({"", "", model.width, model.height, model.lens});
  LensPictures::Result result =
      this->LensPictures_.Draw(this->GetRenderContext(), context.scene->scene, request);
  dspace::Capture& taken = this->LastCapture_;
  taken = {};
  taken.width = request.width;
  taken.height = request.height;
  if (command.color()) {
    taken.color = ColorsOf(result.planes.radiance, exposure);
  }
  if (command.radiance()) {
    taken.radiance = std::move(result.planes.radiance);
  }
  taken.depth = std::move(result.planes.depth);
  taken.range = std::move(result.planes.range);
  taken.label = std::move(result.planes.label);
  taken.litFraction = std::move(result.planes.litFraction);
  taken.incidence = std::move(result.planes.incidence);
  taken.emission = std::move(result.planes.emission);
  taken.phase = std::move(result.planes.phase);
  taken.normal = std::move(result.planes.normal);
  this->PutCapture(context, command.inline_data());
  v1::LensPicture* lens = context.reply.mutable_capture()->mutable_lens();
  lens->set_image_width(std::uint32_t(request.lens.model.width));
  lens->set_image_height(std::uint32_t(request.lens.model.height));
  lens->set_source_views(std::uint32_t(result.sourceViews));
  lens->set_source_pixels(result.sourcePixels);
  lens->set_without_ray(result.withoutRay);
  lens->set_half_angle_deg(result.halfAngle_deg);
  lens->set_pupil_shift(result.pupilShift);
  lens->set_pupil_pixels(result.pupilPixels);
  lens->set_pupil_beyond(result.pupilBeyond);
}

} // namespace dspace::session
