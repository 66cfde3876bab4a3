#include <dspace/render/VtkMirror.h>

#include "vtkCamera.h"
#include "vtkLight.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkRenderer.h"

namespace dspace {

void MirrorCamera(const Scene& scene, const DrawView& view, vtkRenderer* renderer) {
  const Pose X_RC = scene.Frames().WorldPose(view.camera.frame) * view.camera.X_FC;
  const Eigen::Vector3d eye = X_RC.position;
  const Eigen::Vector3d at = eye + X_RC.rotation * Eigen::Vector3d::UnitZ();
  const Eigen::Vector3d up = X_RC.rotation * -Eigen::Vector3d::UnitY();
  vtkCamera* camera = renderer->GetActiveCamera();
  camera->SetPosition(eye.x(), eye.y(), eye.z());
  camera->SetFocalPoint(at.x(), at.y(), at.z());
  camera->SetViewUp(up.x(), up.y(), up.z());
  camera->SetParallelProjection(view.projection.kind == Projection::Kind::Orthographic);
  const Eigen::Matrix4d clip = view.projection.ClipFromView(view.width, view.height);
  vtkNew<vtkMatrix4x4> matrix;
  for (int r = 0; r < 4; ++r) {
    for (int c = 0; c < 4; ++c) {
      matrix->SetElement(r, c, clip(r, c));
    }
  }
  camera->SetExplicitProjectionTransformMatrix(matrix);
  camera->UseExplicitProjectionTransformMatrixOn();
}

void MirrorLights(const Scene& scene, vtkRenderer* renderer) {
  renderer->RemoveAllLights();
  const FrameTree& frames = scene.Frames();
  for (const Light& light : scene.Fragments().Lights()) {
    if (!light.enabled || light.kind == Light::Kind::Ambient) {
      continue;
    }
    vtkNew<vtkLight> placed;
    if (light.kind == Light::Kind::Head) {
      placed->SetLightTypeToHeadlight();
    } else {
      const Pose& X_RF = frames.WorldPose(light.frame);
      const bool directional = light.kind == Light::Kind::Directional;
      const Eigen::Vector3d d = (X_RF.rotation * light.direction).normalized();
      const Eigen::Vector3d p = directional ? Eigen::Vector3d(-d) : X_RF.Apply(light.position);
      placed->SetPosition(p.x(), p.y(), p.z());
      placed->SetFocalPoint(p.x() + d.x(), p.y() + d.y(), p.z() + d.z());
      placed->SetPositional(!directional);
      placed->SetConeAngle(light.kind == Light::Kind::Spot ? light.cone_deg : 180.0);
    }
    placed->SetColor(light.color[0], light.color[1], light.color[2]);
    placed->SetIntensity(light.intensity);
    renderer->AddLight(placed);
  }
}

} // namespace dspace
