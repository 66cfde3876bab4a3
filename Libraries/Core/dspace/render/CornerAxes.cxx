#include <dspace/render/CornerAxes.h>

#include <algorithm>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkOpenGLState.h"

#include <dspace/scene/Primitives.h>

namespace dspace {

CornerAxes::CornerAxes(vtkDspaceRenderContext* context) : Context_(context) {
  GraphicsObject axes;
  axes.name = "axes";
  const auto arrow = std::make_shared<const Mesh>(MakeArrow(1.0));
  DetailLevel level;
  for (int axis = 0; axis < 3; ++axis) {
    auto material = std::make_shared<Material>();
    material->color = {0.1, 0.1, 0.1};
    material->color[axis] = 0.9;
    const Eigen::Quaterniond turn =
        Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitX(), Eigen::Vector3d::Unit(axis));
    level.parts.push_back({arrow, material, Eigen::Affine3d(turn)});
  }
  axes.levels.push_back(std::move(level));
  this->Axes_.AddObject(axes);
  Light head;
  head.name = "head";
  head.kind = Light::Kind::Head;
  head.intensity = 0.7;
  this->Axes_.SetLight(head);
  Light ambient;
  ambient.name = "ambient";
  ambient.kind = Light::Kind::Ambient;
  ambient.intensity = 0.4;
  this->Axes_.SetLight(ambient);
}

void CornerAxes::Draw(const Scene& scene, const DrawView& view, RenderTarget& target, int samples) {
  const int size = std::max(std::min(view.width, view.height) / 6, 1);
  // The root's axes as the camera sees them, from three metres away.
  Pose X_RC = scene.Frames().RelativePose(RootFrame, view.camera.frame) * view.camera.X_FC;
  X_RC.scale = 1.0;
  X_RC.position = X_RC.rotation * Eigen::Vector3d(0.0, 0.0, -3.0);
  DrawView corner;
  corner.camera = {RootFrame, X_RC};
  corner.projection.kind = Projection::Kind::Orthographic;
  corner.projection.height = 2.6;
  corner.projection.nearDistance = 0.1;
  corner.projection.farDistance = 10.0;
  corner.width = corner.height = size;
  this->List_.Build(this->Axes_, corner, {});
  vtkOpenGLState* state = this->Context_->GetHub()->GetState();
  state->vtkglViewport(0, 0, size, size);
  state->vtkglScissor(0, 0, size, size);
  state->vtkglEnable(GL_SCISSOR_TEST);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglClearDepth(0.0);
  state->vtkglClear(GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
  RenderStatistics& statistics = this->Context_->CountStatistics();
  if (!this->Drawer_) {
    this->Drawer_ =
        std::make_unique<SceneDrawer>(this->Context_->GetHub(), this->Context_->GetStore(),
                                      this->Context_->GetDrawers(), statistics);
  }
  const RenderStatistics before = statistics;
  this->Drawer_->DrawColor(this->List_, corner, target, samples);
  // The read-outs speak of the scene.
  statistics.trianglesDrawn = before.trianglesDrawn;
  statistics.drawCalls = before.drawCalls;
  statistics.translucentLayers = before.translucentLayers;
  state->vtkglViewport(0, 0, view.width, view.height);
  state->vtkglScissor(0, 0, view.width, view.height);
}

} // namespace dspace
