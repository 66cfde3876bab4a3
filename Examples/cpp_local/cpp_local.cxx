// A program that draws in its own process, without a server and without Python: a rover's body
// drives over terrain.
//   cpp_local field.tif chassis.gltf OUT.png
// Documentation/CppLocal.md explains it step by step.
#include <cmath>
#include <exception>
#include <iostream>
#include <memory>
#include <string>

#include <dspace/Error.h>
#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/clipmap/gl/ClipmapDrawing.h>
#include <dspace/import/files/ModelReader.h>
#include <dspace/render/ImageWriter.h>
#include <dspace/scene/Primitives.h>
#include <dspace/scene/Scene.h>
#include <dspace/surface/StreamedTerrain.h>
#include <vtkDspaceRenderContext.h>
#include <vtkDspaceViewport.h>
#include <vtkNew.h>

namespace {

// The ground: one surface for queries and for drawing.
std::shared_ptr<dspace::StreamedTerrain> AddGround(dspace::Scene& scene, const std::string& path) {
  dspace::StreamedTerrainOptions opening;
  opening.originHeight = 0.0; // heights of the file are heights of the scene
  auto surface = dspace::StreamedTerrain::Open(path, opening);
  dspace::ClipmapOptions drawing;
  drawing.cells = opening.cells;
  drawing.heights = surface->HeightRange();
  auto material = std::make_shared<dspace::Material>();
  material->color = {0.55, 0.53, 0.50};
  drawing.material = material;
  dspace::GraphicsObject ground;
  ground.name = "ground";
  ground.frame = dspace::RootFrame;
  ground.custom =
      std::make_shared<dspace::ClipmapTerrain>(surface->Pyramid(), surface->Placement(), drawing);
  scene.AddObject(std::move(ground));
  return surface;
}

// A body that a model file describes, and a sensor that turns on it: two moving frames.
struct Rover {
  dspace::FrameId body = 0;
  dspace::FrameId sensor = 0;
};

Rover AddRover(dspace::Scene& scene, const std::string& path) {
  Rover rover;
  rover.body = scene.Frames().Create(dspace::RootFrame, "rover");
  rover.sensor = scene.Frames().Create(rover.body, "sensor");
  dspace::GraphicsObject body;
  body.name = "body";
  body.frame = rover.body;
  const auto model = std::make_shared<const dspace::Model>(dspace::ReadModel(path));
  body.levels = {dspace::DetailLevel{dspace::PartsOf(model)}};
  scene.AddObject(std::move(body));
  dspace::GraphicsObject dish;
  dish.name = "sensor";
  dish.frame = rover.sensor;
  auto blue = std::make_shared<dspace::Material>();
  blue->color = {0.15, 0.35, 0.85};
  dish.levels = {dspace::DetailLevel{{dspace::Part{
      std::make_shared<const dspace::Mesh>(dspace::MakeBox({0.2, 0.5, 0.3})), blue}}}};
  scene.AddObject(std::move(dish));
  return rover;
}

// Puts the body on the ground at (x, y), upright on its normal and heading along X.
void Drive(dspace::Scene& scene, const Rover& rover, const dspace::TerrainSurface& ground, double x,
           double y, double sensor_rad) {
  const dspace::SurfaceSample at = ground.Sample({x, y, 0.0});
  if (!at.valid) {
    throw dspace::Error(dspace::Error::Kind::InvalidArgument, "the drive",
                        "there is no ground at " + std::to_string(x) + ", " + std::to_string(y));
  }
  dspace::Pose pose;
  pose.position = at.position_S + 0.45 * at.normal_S; // half of its height above the ground
  pose.rotation = Eigen::Quaterniond::FromTwoVectors(Eigen::Vector3d::UnitZ(), at.normal_S);
  scene.Frames().SetLocalPose(rover.body, pose);
  dspace::Pose turned;
  turned.position = {0.3, 0.0, 0.9};
  turned.rotation = Eigen::AngleAxisd(sensor_rad, Eigen::Vector3d::UnitZ());
  scene.Frames().SetLocalPose(rover.sensor, turned);
}

void AddViews(dspace::Scene& scene, const Rover& rover) {
  dspace::Light sun;
  sun.name = "sun";
  sun.direction = Eigen::Vector3d(0.6, 0.5, -0.45).normalized();
  scene.SetLight(sun);
  scene.CreateVantage("main");
  dspace::Camera camera; // it follows the body
  camera.name = "chase";
  camera.projection.verticalFov_deg = 40.0;
  camera.mount.kind = dspace::CameraMount::Kind::Chase;
  camera.mount.frame = rover.body;
  camera.mount.offset = {-5.0, -4.0, 3.0};
  camera.mount.target = {0.5, 0.0, 0.4};
  scene.SetCamera("main", camera);
}

void Run(const std::string& field, const std::string& chassis, const std::string& out) {
  const auto scene = std::make_shared<dspace::Scene>("scene");
  const auto ground = AddGround(*scene, field);
  const Rover rover = AddRover(*scene, chassis);
  AddViews(*scene, rover);

  vtkNew<vtkDspaceRenderContext> context; // one a process; any number of viewports and scenes
  dspace::RegisterClipmapDrawer(context->GetDrawers());
  vtkNew<vtkDspaceViewport> viewport;
  viewport->Initialize(context, scene, "view", "main", 960, 540);
  viewport->SetBackground({0.0, 0.0, 0.02}, {0.0, 0.0, 0.0});
  dspace::ViewLook look;
  look.fill = 0.06; // of the Sun's light, so that shadowed sides are not black
  viewport->SetLook(look);

  int drawn = 0;
  for (int step = 0; step <= 40; ++step) {
    const double t = 0.25 * step;
    scene->SetTime(t);
    Drive(*scene, rover, *ground, -20.0 + t, 3.0 * std::sin(0.3 * t), 0.5 * t);
    drawn += viewport->Render() ? 1 : 0; // draws, since something moved
  }
  drawn += viewport->Render() ? 1 : 0; // draws nothing: all is as it was

  dspace::CaptureRequest request; // waits for the terrain that the picture needs
  request.depth = true;
  const dspace::Capture picture = viewport->GetCapture(request);
  dspace::WriteColor(out, picture.width, picture.height, picture.color);

  const dspace::PickResult middle = viewport->Pick(479.5, 269.5);
  const dspace::PickResult below = viewport->Pick(479.5, 500.0);
  if (!middle.object || !below.object) {
    throw dspace::Error(dspace::Error::Kind::Internal, "pick", "nothing was hit");
  }
  const double height = ground->Sample(below.p_root).position_S.z();
  std::cout << drawn << " pictures, picked " << scene->Object(middle.object).name << " and "
            << scene->Object(below.object).name << ", whose picked and queried heights differ by "
            << 1000.0 * std::abs(below.p_root.z() - height) << " mm" << std::endl;
}

} // namespace

int main(int count, char** arguments) {
  if (count != 4) {
    std::cerr << "usage: cpp_local HEIGHTS MODEL OUT.png" << std::endl;
    return 2;
  }
  try {
    Run(arguments[1], arguments[2], arguments[3]);
  } catch (const std::exception& error) {
    std::cerr << error.what() << std::endl;
    return 1;
  }
  return 0;
}
