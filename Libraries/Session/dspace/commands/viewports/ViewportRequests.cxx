// Pictures and picks.
#include <algorithm>
#include <limits>
#include <map>
#include <set>

#include <dspace/Checks.h>
#include <dspace/commands/viewports/BuriedCamera.h>
#include <dspace/commands/viewports/ViewportCommands.h>
#include <dspace/layers/raster/RasterField.h>
#include <dspace/messages/Convert.h>
#include <dspace/render/ImageWriter.h>
#include <dspace/render/messages/VtkMessages.h>
#include <dspace/state/TerrainPlaces.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"

namespace dspace::session {
namespace {

// Takes the same members from a capture and from a save command.
template<class Command> CaptureRequest ToRequest(const Command& command, const Scene& scene) {
  CaptureRequest request;
  request.color = request.depth = request.range = request.label = false;
  request.physicalOnly = command.physical_only();
  for (const std::string& fragment : command.hidden_fragment()) {
    scene.Fragments().Get(fragment); // throws where there is none
    request.hiddenFragments.insert(fragment);
  }
  return request;
}

template<class T>
void AddPlane(v1::CaptureReply* reply, const char* name, v1::Plane::Type type, int channels,
              const std::vector<T>& values, bool inlineData) {
  if (values.empty()) {
    return;
  }
  v1::Plane* plane = reply->add_plane();
  plane->set_name(name);
  plane->set_type(type);
  plane->set_channels(std::uint32_t(channels));
  if (inlineData) {
    plane->set_data(values.data(), values.size() * sizeof(T));
  }
}

v1::ExplanationReply::Reason FromReason(ObjectVisibility::Reason reason) {
  using From = ObjectVisibility::Reason;
  using To = v1::ExplanationReply;
  switch (reason) {
  case From::Hidden:
    return To::HIDDEN;
  case From::FragmentHidden:
    return To::FRAGMENT_HIDDEN;
  case From::OrnamentsHidden:
    return To::ORNAMENTS_HIDDEN;
  case From::Empty:
    return To::EMPTY;
  case From::Transparent:
    return To::TRANSPARENT;
  case From::Behind:
    return To::BEHIND;
  case From::BeforeNear:
    return To::BEFORE_NEAR;
  case From::BeyondFar:
    return To::BEYOND_FAR;
  case From::Outside:
    return To::OUTSIDE;
  case From::TooSmall:
    return To::TOO_SMALL;
  case From::Occluded:
    return To::OCCLUDED;
  case From::Seen:
    break;
  }
  return To::SEEN;
}

void RemarkOnCamera(const Scene& scene, const SceneState& state, const CameraPose& camera,
                    v1::ExplanationReply& reply) {
  std::set<ObjectId> ground;
  for (const auto& [name, terrain] : state.terrains) {
    ground.insert(terrain->Object());
  }
  for (const auto& [name, depth] : GroundsOver(state, camera)) {
    reply.add_remark("The camera is " + NumberText(depth) + " m below the ground of terrain '" +
                     name + "'.");
  }
  for (const auto& [id, object] : scene.Objects()) {
    if (object.levels.empty() || object.billboard || !object.visible ||
        object.nature != Nature::Physical || ground.count(id)) {
      continue;
    }
    const Eigen::Vector3d p_F =
        scene.Frames().RelativePose(object.frame, camera.frame).Apply(camera.X_FC.position);
    if (object.levels.front().box.contains(object.X_FO.inverse() * p_F)) {
      reply.add_remark("The camera is inside the box around object '" + object.name + "'.");
    }
  }
}

// A plane that SaveImage writes: how it is asked for, and where its floats are.
struct SavedPlane {
  ImagePlane plane;
  bool CaptureRequest::*asked;
  std::vector<float> dspace::Capture::*values; // null: no floats
};

const std::map<int, SavedPlane>& SavedPlanes() {
  using S = v1::SaveImage;
  using Request = CaptureRequest;
  using Taken = dspace::Capture;
  static const std::map<int, SavedPlane> planes = {
      {S::COLOR, {ImagePlane::Color, &Request::color, nullptr}},
      {S::DEPTH, {ImagePlane::Depth, &Request::depth, &Taken::depth}},
      {S::RANGE, {ImagePlane::Range, &Request::range, &Taken::range}},
      {S::LABEL, {ImagePlane::Label, &Request::label, nullptr}},
      {S::RADIANCE, {ImagePlane::Radiance, &Request::radiance, &Taken::radiance}},
      {S::LIT_FRACTION, {ImagePlane::LitFraction, &Request::litFraction, &Taken::litFraction}},
      {S::INCIDENCE, {ImagePlane::Incidence, &Request::incidence, &Taken::incidence}},
      {S::EMISSION, {ImagePlane::Emission, &Request::emission, &Taken::emission}},
      {S::PHASE, {ImagePlane::Phase, &Request::phase, &Taken::phase}}};
  return planes;
}

} // namespace

void ViewportCommands::Explain(const Context& context, v1::ExplainViewport& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  const Scene& scene = *viewport.GetScene();
  const ViewportState& place = context.state.viewports[command.viewport()];
  v1::ExplanationReply& reply = *context.reply.mutable_explanation();
  bool any = false;
  int ornaments = 0;
  for (const ObjectVisibility& from : viewport.Explain()) {
    v1::ExplanationReply::Item* to = reply.add_object();
    to->set_object(from.object);
    to->set_name(scene.Object(from.object).name);
    to->set_reason(FromReason(from.reason));
    to->set_text(from.text);
    to->set_pixels(from.pixels);
    any = any || from.pixels > 0;
    ornaments += from.reason == ObjectVisibility::Reason::OrnamentsHidden;
  }
  if (scene.Objects().empty()) {
    reply.add_remark("The scene has no object.");
  } else if (!any) {
    reply.add_remark("No pixel shows an object.");
  }
  if (ornaments > 0) {
    reply.add_remark("Everything ornamental is hidden: " + std::to_string(ornaments) +
                     (ornaments == 1 ? " object." : " objects."));
  }
  const std::vector<Light>& lights = scene.Fragments().Lights();
  if (std::none_of(lights.begin(), lights.end(),
                   [](const Light& light) { return light.enabled && light.intensity > 0.0; })) {
    reply.add_remark("No light is on: lit surfaces are black.");
  }
  RemarkOnCamera(scene, context.state.FindScene(scene.Name()),
                 scene.PlaceCamera(place.vantage, place.camera), reply);
}

void ViewportCommands::Capture(const Context& context, v1::Capture& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  CaptureRequest request = ToRequest(command, *viewport.GetScene());
  request.color = command.color();
  request.depth = command.depth();
  request.range = command.range();
  request.label = command.label();
  request.radiance = command.radiance();
  request.litFraction = command.lit_fraction();
  request.incidence = command.incidence();
  request.emission = command.emission();
  request.phase = command.phase();
  const bool any = request.color || request.depth || request.range || request.label ||
                   request.radiance || request.litFraction || request.incidence ||
                   request.emission || request.phase;
  RequirePlane(any, "capture of viewport '" + command.viewport() + "'");
  this->LastCapture_ = viewport.GetCapture(request);
  this->PutCapture(context, command.inline_data());
}

void ViewportCommands::RequirePlane(bool any, const std::string& label) {
  if (!any) {
    Reject(label, "it requests no plane; accepted: color, depth, range, label, radiance, "
                  "lit_fraction, incidence, emission, phase");
  }
}

void ViewportCommands::PutCapture(const Context& context, bool data) {
  const dspace::Capture& taken = this->LastCapture_;
  v1::CaptureReply* reply = context.reply.mutable_capture();
  reply->set_width(std::uint32_t(taken.width));
  reply->set_height(std::uint32_t(taken.height));
  AddPlane(reply, "color", v1::Plane::UINT8, 4, taken.color, data);
  AddPlane(reply, "depth", v1::Plane::FLOAT32, 1, taken.depth, data);
  AddPlane(reply, "range", v1::Plane::FLOAT32, 1, taken.range, data);
  AddPlane(reply, "label", v1::Plane::UINT32, 1, taken.label, data);
  AddPlane(reply, "radiance", v1::Plane::FLOAT32, 3, taken.radiance, data);
  AddPlane(reply, "lit_fraction", v1::Plane::FLOAT32, 1, taken.litFraction, data);
  AddPlane(reply, "incidence", v1::Plane::FLOAT32, 1, taken.incidence, data);
  AddPlane(reply, "emission", v1::Plane::FLOAT32, 1, taken.emission, data);
  AddPlane(reply, "phase", v1::Plane::FLOAT32, 1, taken.phase, data);
  AddPlane(reply, "normal", v1::Plane::FLOAT32, 3, taken.normal, data);
}

void ViewportCommands::SaveImage(const Context&, v1::SaveImage& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  const std::string path = AbsolutePath(command.path());
  CaptureRequest request = ToRequest(command, *viewport.GetScene());
  ImageFileOptions options;
  if (command.has_quality()) {
    options.jpegQuality = ToInt(command.quality());
  }
  const auto found = SavedPlanes().find(command.plane());
  if (found == SavedPlanes().end()) {
    Reject("file '" + path + "'",
           "the plane is " + std::to_string(int(command.plane())) +
               "; accepted: COLOR (0), DEPTH (1), LABEL (2), RANGE (3), RADIANCE (4), "
               "LIT_FRACTION (5), INCIDENCE (6), EMISSION (7), PHASE (8)");
  }
  const SavedPlane& plane = found->second;
  CheckImageFile(path, plane.plane, options);
  request.*plane.asked = true;
  const dspace::Capture taken = viewport.GetCapture(request);
  if (plane.values) {
    WriteFloats(path, plane.plane, taken.width, taken.height, taken.*plane.values);
  } else if (plane.plane == ImagePlane::Label) {
    WriteLabel(path, taken.width, taken.height, taken.label);
  } else {
    WriteColor(path, taken.width, taken.height, taken.color, options);
  }
}

void ViewportCommands::Render(const Context& context, v1::Render& command) {
  std::uint32_t drawn = 0;
  if (!command.viewport().empty()) {
    drawn = this->Get(command.viewport()).Render();
  } else {
    for (const auto& [name, viewport] : this->Viewports_) {
      drawn += viewport->Render() ? 1 : 0;
    }
  }
  context.reply.mutable_render()->set_drawn(drawn);
}

void ViewportCommands::Pick(const Context& context, v1::Pick& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  const std::string label = "pick in viewport '" + command.viewport() + "'";
  RequireFinite(label, "x", command.x());
  RequireFinite(label, "y", command.y());
  const Scene& scene = *viewport.GetScene();
  if (command.in_frame() != NoFrame) {
    scene.Frames().Name(command.in_frame()); // throws where there is none
  }
  const int radius = ToInt(command.radius());
  const PickResult pick = viewport.Pick(command.x(), command.y(), radius);
  v1::PickReply* reply = context.reply.mutable_pick();
  reply->set_object(pick.object);
  if (pick.object == 0) {
    return;
  }
  reply->set_object_name(scene.Object(pick.object).name);
  reply->set_frame(pick.frame);
  reply->set_depth(pick.depth);
  reply->set_part(pick.part);
  Put(pick.p_camera, reply->mutable_in_camera());
  Put(pick.p_frame, reply->mutable_in_object_frame());
  Put(pick.p_root, reply->mutable_in_root());
  if (command.in_frame() != NoFrame) {
    const Pose X = scene.Frames().RelativePose(command.in_frame(), pick.frame);
    Put(X.Apply(pick.p_frame), reply->mutable_in_frame());
  }
  const SceneState& state = context.state.FindScene(scene.Name());
  for (const auto& [name, terrain] : state.terrains) {
    if (terrain->Object() == pick.object) {
      reply->set_terrain(name);
      const Rows3 point_S = pick.p_frame.transpose();
      const Rows3 map = terrain->Surface().SceneToMap(pick.p_frame).transpose();
      Put(map.row(0).transpose(), reply->mutable_map());
      if (terrain->Surface().GetCrs().HasGeographic()) {
        v1::CoordinatesReply coordinates;
        PutCoordinates(*terrain, scene.Frames().WorldPose(pick.frame), point_S, map,
                       *state.sky.kernels, scene.Time(), coordinates);
        reply->mutable_coordinates()->Swap(coordinates.mutable_point(0));
      }
      for (const TerrainField& from : terrain->Fields().All()) {
        v1::FieldValue* value = reply->add_field();
        value->set_name(from.source.name());
        value->set_value(from.field->Values(map.leftCols<2>().transpose())[0]);
        value->set_units(from.field->Units());
      }
    }
  }
}

void ViewportCommands::AddWarnings(v1::Reply& reply) {
  if (this->RenderContext_) {
    for (const std::string& warning : this->RenderContext_->GetMessages().TakeWarnings()) {
      reply.add_warning("VTK reported: " + warning);
    }
  }
}

void ViewportCommands::Statistics(const Context& context, v1::GetStatistics&) {
  vtkDspaceRenderContext* render = this->GetRenderContext();
  const RenderStatistics& from = render->GetStatistics();
  v1::StatisticsReply* to = context.reply.mutable_statistics();
  to->set_mesh_bytes(from.meshBytes);
  to->set_mesh_bytes_uploaded(from.meshBytesUploaded);
  to->set_texture_bytes(from.textureBytes);
  to->set_texture_bytes_uploaded(from.textureBytesUploaded);
  to->set_instance_bytes_uploaded(from.instanceBytesUploaded);
  to->set_frames_drawn(from.framesDrawn);
  to->set_frames_skipped(from.framesSkipped);
  to->set_triangles_drawn(from.trianglesDrawn);
  to->set_draw_calls(from.drawCalls);
  to->set_renderer(render->GetRendererName());
}

void ViewportCommands::AddRequestsTo(Registry& registry) {
  using C = v1::Command;
  const auto bind = [this](auto method) {
    return [this, method](const Context& context, auto& message) {
      (this->*method)(context, message);
      this->AddWarnings(context.reply);
    };
  };
  using V = ViewportCommands;
  const auto none = Needs::Nothing;
  registry.Add(C::kCapture, &C::mutable_capture, bind(&V::Capture), none);
  registry.Add(C::kSaveImage, &C::mutable_save_image, bind(&V::SaveImage), none);
  registry.Add(C::kRender, &C::mutable_render, bind(&V::Render), none);
  registry.Add(C::kPick, &C::mutable_pick, bind(&V::Pick), none);
  registry.Add(C::kExplainViewport, &C::mutable_explain_viewport, bind(&V::Explain), none);
  registry.Add(C::kSimulateImage, &C::mutable_simulate_image, bind(&V::Simulate));
  registry.Add(C::kGetStatistics, &C::mutable_get_statistics, bind(&V::Statistics), none);
}

} // namespace dspace::session
