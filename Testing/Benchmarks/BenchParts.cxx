// Many moving parts against as many plain vtkActors; four viewports against one.
#include <cstdio>
#include <random>

#include "vtkActor.h"
#include "vtkCellArray.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkFloatArray.h"
#include "vtkMatrix4x4.h"
#include "vtkNew.h"
#include "vtkPointData.h"
#include "vtkPolyData.h"
#include "vtkPolyDataMapper.h"
#include "vtkProperty.h"
#include "vtkRenderWindow.h"
#include "vtkRenderer.h"
#include "vtkSmartPointer.h"

#include <dspace/scene/Primitives.h>

#include "Alternate.h"

using namespace dspace;

namespace {

constexpr int Meshes = 100;
constexpr int Width = 1280;
constexpr int Height = 720;

// A hundred meshes that differ: spheres, boxes and cylinders of some sizes, about 100 triangles.
std::vector<std::shared_ptr<const Mesh>> MakeMeshes() {
  std::vector<std::shared_ptr<const Mesh>> meshes;
  for (int i = 0; i < Meshes; ++i) {
    const double size = 0.2 + 0.002 * i;
    meshes.push_back(std::make_shared<const Mesh>(i % 3 == 0   ? MakeSphere(size, 10)
                                                  : i % 3 == 1 ? MakeBox({size, 2 * size, size})
                                                               : MakeCylinder(size, 2 * size, 16)));
  }
  return meshes;
}

vtkSmartPointer<vtkPolyData> ToPolyData(const Mesh& mesh) {
  auto data = vtkSmartPointer<vtkPolyData>::New();
  vtkNew<vtkPoints> points;
  vtkNew<vtkFloatArray> normals;
  normals->SetNumberOfComponents(3);
  for (std::size_t i = 0; i < mesh.positions.size(); i += 3) {
    points->InsertNextPoint(&mesh.positions[i]);
    normals->InsertNextTuple(&mesh.normals[i]);
  }
  vtkNew<vtkCellArray> triangles;
  for (std::size_t i = 0; i < mesh.indices.size(); i += 3) {
    const vtkIdType ids[3] = {mesh.indices[i], mesh.indices[i + 1], mesh.indices[i + 2]};
    triangles->InsertNextCell(3, ids);
  }
  data->SetPoints(points);
  data->GetPointData()->SetNormals(normals);
  data->SetPolys(triangles);
  return data;
}

// Where part `i` is at step `t`: all are in sight, all move and turn.
Pose PoseAt(int i, int count, int t) {
  const int side = static_cast<int>(std::ceil(std::sqrt(count)));
  Pose pose;
  pose.position = {40.0, 1.2 * (i % side - side / 2) + 0.3 * std::sin(0.1 * t + i),
                   0.7 * (i / side - side / 2) + 0.3 * std::cos(0.13 * t + i)};
  pose.rotation = Eigen::AngleAxisd(0.02 * t + i, Eigen::Vector3d(1, i % 7 - 3.0, 2).normalized());
  return pose;
}

void AddCamera(Scene& scene) {
  scene.CreateVantage("main");
  Camera camera;
  camera.name = "camera";
  camera.projection.farDistance = 1000.0;
  camera.mount.X_FC = LookAt("camera", {0, 0, 0}, {1, 0, 0}, {0, 0, 1});
  scene.SetCamera("main", camera);
  Light sun;
  sun.name = "sun";
  sun.direction = {1, 0.5, -0.5};
  scene.SetLight(sun);
}

void BenchParts(vtkDspaceRenderContext* context, int count, int pairs) {
  const auto meshes = MakeMeshes();
  auto ours = std::make_shared<Scene>("ours");
  AddCamera(*ours);
  std::vector<FrameId> frames;
  std::vector<double> poses(static_cast<std::size_t>(count) * PoseSize);
  for (int i = 0; i < count; ++i) {
    frames.push_back(ours->Frames().Create(RootFrame, "part " + std::to_string(i)));
    auto material = std::make_shared<Material>();
    material->color = {0.3 + 0.006 * (i % 100), 0.5, 0.9 - 0.006 * (i % 100)};
    material->roughness = 1.0; // Lambertian, as a vtkActor is by default
    GraphicsObject object;
    object.name = "part " + std::to_string(i);
    object.frame = frames.back();
    object.levels = {{{{meshes[i % Meshes], material, Eigen::Affine3d::Identity()}}, 0.0}};
    ours->AddObject(object);
  }
  auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
  viewport->Initialize(context, ours, "ours", "main", Width, Height);
  viewport->SetSamples(1);

  auto plain = std::make_shared<Scene>("plain");
  AddCamera(*plain);
  auto plainViewport = vtkSmartPointer<vtkDspaceViewport>::New();
  plainViewport->Initialize(context, plain, "plain", "main", Width, Height);
  plainViewport->SetSamples(1);
  std::vector<vtkSmartPointer<vtkPolyData>> data;
  for (const auto& mesh : meshes) {
    data.push_back(ToPolyData(*mesh));
  }
  std::vector<vtkSmartPointer<vtkActor>> actors;
  std::vector<vtkSmartPointer<vtkMatrix4x4>> matrices;
  for (int i = 0; i < count; ++i) {
    vtkNew<vtkPolyDataMapper> mapper;
    mapper->SetInputData(data[i % Meshes]);
    mapper->SetStatic(1);
    auto actor = vtkSmartPointer<vtkActor>::New();
    actor->SetMapper(mapper);
    actor->GetProperty()->SetColor(0.3 + 0.006 * (i % 100), 0.5, 0.9 - 0.006 * (i % 100));
    auto matrix = vtkSmartPointer<vtkMatrix4x4>::New();
    actor->SetUserMatrix(matrix);
    actors.push_back(actor);
    matrices.push_back(matrix);
    plainViewport->GetRenderer()->AddActor(actor);
  }

  int step = 0;
  RenderStatistics drawn;
  const auto drawOurs = [&] {
    for (int i = 0; i < count; ++i) {
      const Pose p = PoseAt(i, count, step);
      const double row[PoseSize] = {p.position.x(), p.position.y(), p.position.z(), p.rotation.w(),
                                    p.rotation.x(), p.rotation.y(), p.rotation.z(), p.scale};
      std::copy(row, row + PoseSize, poses.begin() + PoseSize * i);
    }
    ours->Frames().SetLocalPoses(frames.data(), poses.data(), frames.size());
    viewport->ForceRender();
    context->GetRenderWindow()->WaitForCompletion();
    drawn = context->GetStatistics();
    ++step;
  };
  const auto drawPlain = [&] {
    for (int i = 0; i < count; ++i) {
      const Eigen::Matrix4d m = PoseAt(i, count, step).Matrix();
      for (int r = 0; r < 4; ++r) {
        for (int c = 0; c < 4; ++c) {
          matrices[i]->SetElement(r, c, m(r, c));
        }
      }
    }
    plainViewport->ForceRender();
    context->GetRenderWindow()->WaitForCompletion();
    ++step;
  };
  const bench::Turns turns = bench::Alternate(pairs, drawOurs, drawPlain);
  char behind[160];
  std::snprintf(behind, sizeof behind, "%llu triangles, %llu draw calls, goal <= 0.25",
                static_cast<unsigned long long>(drawn.trianglesDrawn),
                static_cast<unsigned long long>(drawn.drawCalls));
  bench::Print(("parts " + std::to_string(count)).c_str(), turns, 1, behind);

  // Without pixels, to tell drawing's own cost from llvmpipe's filling.
  viewport->Resize(16, 9);
  plainViewport->Resize(16, 9);
  const bench::Turns bare = bench::Alternate(pairs, drawOurs, drawPlain);
  bench::Print(("parts " + std::to_string(count) + ", 16 x 9 pixels").c_str(), bare, 1, behind);
}

void BenchViewports(vtkDspaceRenderContext* context, int pairs) {
  const auto meshes = MakeMeshes();
  auto scene = std::make_shared<Scene>("views");
  AddCamera(*scene);
  for (int i = 0; i < 400; ++i) {
    const FrameId frame = scene->Frames().Create(RootFrame, std::to_string(i), PoseAt(i, 400, 0));
    GraphicsObject object;
    object.name = std::to_string(i);
    object.frame = frame;
    object.levels = {
        {{{meshes[i % Meshes], std::make_shared<Material>(), Eigen::Affine3d::Identity()}}, 0.0}};
    scene->AddObject(object);
  }
  const auto make = [&](int width, int height) {
    auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
    viewport->Initialize(context, scene, "v", "main", width, height);
    viewport->SetSamples(1);
    return viewport;
  };
  auto one = make(Width, Height);
  one->ForceRender();
  const RenderStatistics alone = context->GetStatistics();
  std::vector<vtkSmartPointer<vtkDspaceViewport>> four;
  for (int i = 0; i < 4; ++i) {
    four.push_back(make(Width / 2, Height / 2));
    four.back()->ForceRender();
  }
  const RenderStatistics together = context->GetStatistics();
  const bench::Turns turns = bench::Alternate(
      pairs,
      [&] {
        for (auto& viewport : four) {
          viewport->ForceRender();
        }
        context->GetRenderWindow()->WaitForCompletion();
      },
      [&] {
        one->ForceRender();
        context->GetRenderWindow()->WaitForCompletion();
      });
  const RenderStatistics after = context->GetStatistics();
  char behind[200];
  std::snprintf(behind, sizeof behind,
                "mesh memory %llu B with one, %llu B with four more; uploaded by a frame: %llu B",
                static_cast<unsigned long long>(alone.meshBytes),
                static_cast<unsigned long long>(together.meshBytes),
                static_cast<unsigned long long>(
                    after.meshBytesUploaded - together.meshBytesUploaded +
                    after.instanceBytesUploaded - together.instanceBytesUploaded));
  bench::Print("four viewports against one of the same pixels", turns, 1, behind);
}

} // namespace

int main() {
  vtkNew<vtkDspaceRenderContext> context;
  context->Initialize();
  std::printf("renderer: %s\n", context->GetRendererName().c_str());
  BenchParts(context, 1000, 21);
  BenchParts(context, 5000, 11);
  BenchViewports(context, 21);
  return 0;
}
