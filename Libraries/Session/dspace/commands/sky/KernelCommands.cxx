// SPICE kernels.
#include <algorithm>
#include <filesystem>

#include <dspace/Checks.h>
#include <dspace/commands/sky/SkyTools.h>
#include <dspace/kernels/ClockKernel.h>
#include <dspace/kernels/FieldOfView.h>
#include <dspace/messages/Convert.h>

namespace dspace::session {
namespace {

const char* KindName(FrameClass kind) {
  static constexpr const char* Names[] = {"inertial", "PCK", "CK", "TK", "dynamic", "switch"};
  return Names[int(kind) - 1];
}

void Describe(const KernelSet& kernels, v1::KernelsReply* reply,
              google::protobuf::RepeatedPtrField<std::string>* warnings) {
  for (const std::string& path : kernels.Paths()) {
    reply->add_path(path);
  }
  for (const std::string& file : kernels.Files()) {
    reply->add_file(file);
  }
  for (const KernelSet::Segment& segment : kernels.Segments()) {
    v1::KernelsReply::Segment* out = reply->add_segment();
    out->set_file(segment.file);
    out->set_kind(segment.kind);
    out->set_name(segment.name);
    out->set_body(segment.body);
    out->set_center(segment.center);
    out->set_frame(kernels.GetFrames().FrameName(segment.frame));
    out->set_type(segment.type);
    out->set_begin_s(segment.begin);
    out->set_end_s(segment.end);
  }
  for (const KernelContent& content : kernels.Contents()) {
    v1::KernelsReply::Content* out = reply->add_content();
    out->set_file(content.file);
    out->set_kind(content.kind);
    out->set_variables(content.variables);
    for (const std::string& item : content.items) {
      out->add_item(item);
    }
  }
  for (const FrameInfo* info : kernels.GetFrames().Table().Loaded()) {
    v1::KernelsReply::Frame* frame = reply->add_frame();
    frame->set_name(info->name);
    frame->set_id(info->id);
    frame->set_kind(KindName(info->kind));
    frame->set_center(info->center);
    frame->set_kernel(info->kernel);
  }
  for (const int id : ClockKernel::Clocks(kernels.Pool())) {
    try {
      const ClockKernel clock(kernels.Pool(), id, kernels.Scales());
      v1::KernelsReply::Clock* out = reply->add_clock();
      out->set_id(id);
      out->set_begin_s(clock.FirstTdb());
      out->set_end_s(clock.LastTdb());
    } catch (const Error& error) {
      if (error.GetKind() != Error::Kind::Unsupported) {
        throw;
      }
    }
  }
  for (const int id : Instruments(kernels.Pool())) {
    FieldOfView field;
    try {
      field = FieldOfViewOf(kernels.Pool(), id);
    } catch (const Error& error) {
      *warnings->Add() = error.what(); // the other kernels are good all the same
      continue;
    }
    v1::KernelsReply::Instrument* out = reply->add_instrument();
    out->set_id(id);
    out->set_shape(FieldShapeName(field.shape));
    out->set_frame(field.frame);
    Put(field.boresight, out->mutable_boresight());
    for (const Eigen::Vector3d& v : field.boundary) {
      out->mutable_boundary()->Add(v.data(), v.data() + 3);
    }
  }
  for (const KernelConflict& conflict : kernels.Pool().Conflicts()) {
    v1::KernelsReply::Conflict* out = reply->add_conflict();
    out->set_name(conflict.name);
    out->set_winner(conflict.winner);
    out->set_loser(conflict.loser);
  }
}

void LoadKernels(const Context& context, v1::LoadKernels& command) {
  if (command.path().empty()) {
    Reject("command load_kernels", "it names no file; accepted: at least one");
  }
  std::shared_ptr<const KernelSet> kernels = context.scene->sky.kernels;
  for (std::string& path : *command.mutable_path()) {
    if (path.empty()) {
      Reject("command load_kernels", "a path is empty; accepted: the path of a file");
    }
    path = std::filesystem::absolute(path).lexically_normal().string();
    kernels = kernels->With(path);
  }
  Describe(*kernels, context.reply.mutable_kernels(), context.reply.mutable_warning());
  const std::string lacking = kernels->Scales().GetLeapSeconds().Lacking();
  if (!lacking.empty()) {
    context.reply.add_warning(lacking);
  }
  context.scene->sky.kernels = kernels;
}

void UnloadKernels(const Context& context, v1::UnloadKernels& command) {
  std::shared_ptr<const KernelSet> kernels = context.scene->sky.kernels;
  for (const std::string& path : command.path()) {
    kernels = kernels->Without(path);
  }
  if (command.path().empty()) {
    kernels = SkyMotions::Standard();
  }
  Describe(*kernels, context.reply.mutable_kernels(), context.reply.mutable_warning());
  context.scene->sky.kernels = kernels;
}

void ListKernels(const Context& context, v1::ListKernels&) {
  Describe(*context.scene->sky.kernels, context.reply.mutable_kernels(),
           context.reply.mutable_warning());
}

} // namespace

void AddKernelCommands(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kLoadKernels, &C::mutable_load_kernels, LoadKernels);
  registry.Add(C::kUnloadKernels, &C::mutable_unload_kernels, UnloadKernels);
  registry.Add(C::kListKernels, &C::mutable_list_kernels, ListKernels);
}

void AddSkyCommands(Registry& registry) {
  AddKernelCommands(registry);
  AddFrameMotions(registry);
  AddSkyRequests(registry);
  AddVisibilityRequests(registry);
}

} // namespace dspace::session
