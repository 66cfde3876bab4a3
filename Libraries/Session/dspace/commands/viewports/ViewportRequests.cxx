// Pictures and picks.
#include <algorithm>

#include <dspace/commands/viewports/ViewportCommands.h>
#include <dspace/messages/Convert.h>
#include <dspace/render/ImageWriter.h>
#include <dspace/render/VtkMessages.h>
#include <dspace/scene/Checks.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"

namespace dspace::session {
namespace {

// Takes the same members from a capture and from a save command.
template<class Command> CaptureRequest ToRequest(const Command& command, const Scene& scene) {
  CaptureRequest request;
  request.color = request.depth = request.label = false;
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

} // namespace

void ViewportCommands::Capture(const Context& context, v1::Capture& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  CaptureRequest request = ToRequest(command, *viewport.GetScene());
  request.color = command.color();
  request.depth = command.depth();
  request.label = command.label();
  if (!request.color && !request.depth && !request.label) {
    Reject("capture of viewport '" + command.viewport() + "'",
           "it requests no plane; accepted: color, depth, label");
  }
  this->LastCapture_ = viewport.GetCapture(request);
  const dspace::Capture& taken = this->LastCapture_;
  v1::CaptureReply* reply = context.reply.mutable_capture();
  reply->set_width(std::uint32_t(taken.width));
  reply->set_height(std::uint32_t(taken.height));
  const bool data = command.inline_data();
  AddPlane(reply, "color", v1::Plane::UINT8, 4, taken.color, data);
  AddPlane(reply, "depth", v1::Plane::FLOAT32, 1, taken.depth, data);
  AddPlane(reply, "label", v1::Plane::UINT32, 1, taken.label, data);
}

void ViewportCommands::SaveImage(const Context&, v1::SaveImage& command) {
  vtkDspaceViewport& viewport = this->Get(command.viewport());
  const std::string path = AbsolutePath(command.path());
  CaptureRequest request = ToRequest(command, *viewport.GetScene());
  ImageFileOptions options;
  if (command.has_quality()) {
    options.jpegQuality = ToInt(command.quality());
  }
  switch (command.plane()) {
  case v1::SaveImage::COLOR:
    CheckImageFile(path, ImagePlane::Color, options);
    request.color = true;
    break;
  case v1::SaveImage::DEPTH:
    CheckImageFile(path, ImagePlane::Depth, options);
    request.depth = true;
    break;
  case v1::SaveImage::LABEL:
    CheckImageFile(path, ImagePlane::Label, options);
    request.label = true;
    break;
  default:
    Reject("file '" + path + "'", "the plane is " + std::to_string(int(command.plane())) +
                                      "; accepted: COLOR (0), DEPTH (1), LABEL (2)");
  }
  const dspace::Capture taken = viewport.GetCapture(request);
  if (request.color) {
    WriteColor(path, taken.width, taken.height, taken.color, options);
  } else if (request.depth) {
    WriteDepth(path, taken.width, taken.height, taken.depth);
  } else {
    WriteLabel(path, taken.width, taken.height, taken.label);
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
      Put(terrain->Surface().SceneToMap(pick.p_frame), reply->mutable_map());
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
  registry.Add(C::kGetStatistics, &C::mutable_get_statistics, bind(&V::Statistics), none);
}

} // namespace dspace::session
