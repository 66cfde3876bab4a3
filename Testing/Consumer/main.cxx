// A model on a frame, seen by a camera with no display: prints the triangles of the model that was
// imported, and what lies under the middle of the picture.
#include <iostream>
#include <memory>

#include <dspace/import/files/ModelReader.h>
#include <vtkDspaceRenderContext.h>
#include <vtkDspaceViewport.h>
#include <vtkNew.h>

int main(int, char** arguments) {
  const auto model = std::make_shared<const dspace::Model>(dspace::ReadModel(arguments[1]));
  const auto scene = std::make_shared<dspace::Scene>("scene");
  dspace::GraphicsObject object;
  object.name = "model";
  object.frame = scene->Frames().Create(dspace::RootFrame, "vehicle");
  object.levels = {dspace::DetailLevel{dspace::PartsOf(model)}};
  scene->AddObject(object);
  dspace::Camera camera;
  camera.name = "camera";
  const Eigen::Vector3d middle = model->Bounds().center();
  const Eigen::Vector3d eye = middle + Eigen::Vector3d(3, -4, 2);
  camera.mount.X_FC = dspace::LookAt("camera", eye, middle, {0, 0, 1});
  scene->CreateVantage("main");
  scene->SetCamera("main", camera);

  vtkNew<vtkDspaceRenderContext> context;
  vtkNew<vtkDspaceViewport> viewport;
  viewport->Initialize(context, scene, "view", "main", 320, 240);
  const dspace::PickResult pick = viewport->Pick(159.5, 119.5);
  const std::string what = pick.object ? scene->Object(pick.object).name : "nothing";
  std::cout << model->TriangleCount() << " triangles, picked " << what << " at "
            << pick.p_root.transpose() << " drawn by " << context->GetRendererName() << std::endl;
}
