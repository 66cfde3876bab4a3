// Shader code of objects: needs OpenGL, which compiles it before an object takes it.
#include <dspace/commands/objects/ObjectTools.h>
#include <dspace/commands/objects/ShaderMessages.h>
#include <dspace/commands/viewports/ViewportCommands.h>
#include <dspace/render/ShaderCheck.h>

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"

namespace dspace::session {

void ViewportCommands::SetShader(const Context& context, v1::SetShader& command) {
  Scene& scene = context.GetScene();
  const GraphicsObject& object = scene.Object(command.object());
  const std::shared_ptr<const ShaderCode> code =
      ToShaderCode(command, ObjectLabel(scene, command.object()));
  if (code && !(object.shader && HaveSamePrograms(*code, *object.shader))) {
    vtkDspaceRenderContext* drawing = this->GetRenderContext();
    drawing->Initialize();
    drawing->GetHub()->MakeCurrent();
    for (const std::string& warning : CheckShaderCode(drawing->GetHub(), object, *code)) {
      context.reply.add_warning(warning);
    }
  }
  scene.SetObjectShader(command.object(), code);
}

void ViewportCommands::AddShadersTo(Registry& registry) {
  using C = v1::Command;
  registry.Add(C::kSetShader, &C::mutable_set_shader,
               [this](const Context& context, v1::SetShader& command) {
                 this->SetShader(context, command);
               });
}

} // namespace dspace::session
