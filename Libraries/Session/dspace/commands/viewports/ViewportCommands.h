// The viewport commands: the part of a session that draws. Needs VTK.
#ifndef DSPACE_SESSION_VIEWPORT_COMMANDS_H
#define DSPACE_SESSION_VIEWPORT_COMMANDS_H

#include <functional>
#include <map>
#include <string>
#include <typeindex>

#include <vtkSmartPointer.h>

#include <dspace/commands/viewports/LensPictures.h>
#include <dspace/commands/viewports/LiveTables.h>
#include <dspace/interpreter/Registry.h>
#include <dspace/render/Capture.h>
#include <dspace/render/CustomDrawers.h>
#include <dspace/scene/controls/OrbitController.h>

class vtkDspaceRenderContext;
class vtkDspaceViewport;

namespace dspace::session {

// A session's viewports by name. Must live as long as the registry that it was added to.
class ViewportCommands {
public:
  ViewportCommands();
  ~ViewportCommands();
  ViewportCommands(const ViewportCommands&) = delete;
  ViewportCommands& operator=(const ViewportCommands&) = delete;

  void AddTo(Registry& registry);

  // Null if there is none of this name.
  vtkDspaceViewport* Find(const std::string& name) const;
  void SetRenderContext(vtkDspaceRenderContext* context);
  vtkDspaceRenderContext* GetRenderContext(); // made on demand
  void ReleaseRenderContext();                // vtkDspaceRenderContext::Release(), if it is there
  // Registers a drawer with the context, and with one that is set later.
  void AddDrawer(std::type_index geometry, const CustomDrawers::Maker& maker);

  // The planes of the last capture command. The caller may move them.
  dspace::Capture& LastCapture() { return this->LastCapture_; }
  void Clear();                       // viewports first, then the context
  void AddWarnings(v1::Reply& reply); // warnings of VTK while drawing, since the last call

private:
  vtkDspaceViewport& Get(const std::string& name) const; // throws Error(NotFound)

  void Create(const Context& context, v1::CreateViewport& command);
  void Remove(const Context& context, v1::RemoveViewport& command);
  void Resize(const Context& context, v1::ResizeViewport& command);
  void Move(const Context& context, v1::MoveViewport& command);
  void Set(const Context& context, v1::SetViewport& command);
  void SetLens(const std::string& viewport, const std::string& json); // empty: none
  void SetFragment(const Context& context, v1::SetViewportFragment& command);
  void SetTable(const Context& context, v1::SetTextTable& command);
  void RemoveTable(const Context& context, v1::RemoveTextTable& command);
  void Describe(const Context& context, v1::DescribeViewport& command);
  void List(const Context& context, v1::ListViewports& command);

  // ColorBarCommands.cxx
  void AddColorBarsTo(Registry& registry);
  void SetBar(const Context& context, v1::SetColorBar& command);
  void RemoveBar(const Context& context, v1::RemoveColorBar& command);

  // ShaderCommands.cxx
  void AddShadersTo(Registry& registry);
  void SetShader(const Context& context, v1::SetShader& command);

  void Event(const Context& context, v1::ViewportEvent& command); // ViewportEvents.cxx

  // ViewportRequests.cxx
  void AddRequestsTo(Registry& registry);
  void Capture(const Context& context, v1::Capture& command);
  void PutCapture(const Context& context, bool inlineData); // of LastCapture()
  // Throws Error(InvalidArgument) unless a request for `label` has `any` plane.
  static void RequirePlane(bool any, const std::string& label);
  void SaveImage(const Context& context, v1::SaveImage& command);
  void Render(const Context& context, v1::Render& command);
  void Pick(const Context& context, v1::Pick& command);
  void Explain(const Context& context, v1::ExplainViewport& command);
  void Statistics(const Context& context, v1::GetStatistics& command);

  void Simulate(const Context& context, v1::SimulateImage& command); // SimulateRequest.cxx

  vtkSmartPointer<vtkDspaceRenderContext> RenderContext_;
  std::map<std::type_index, CustomDrawers::Maker> Drawers_; // of plug-ins
  std::map<std::string, vtkSmartPointer<vtkDspaceViewport>> Viewports_;
  std::map<std::string, std::string> Lenses_;          // JSON, of viewports that have one
  std::map<std::string, OrbitController> Controllers_; // of viewports that have received events
  LensPictures LensPictures_;
  LiveTables LiveTables_;
  dspace::Capture LastCapture_;
};

} // namespace dspace::session

#endif
