// Shadows: (1) a frame that draws four shadow maps, compared with a frame without shadows plus the
// depth passes of these maps; (2) pictures of a scene in which nothing moves.
#include <cmath>
#include <cstdio>

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"
#include "vtkRenderWindow.h"
#include "vtkSmartPointer.h"

#include <dspace/clipmap/ClipmapTerrain.h>
#include <dspace/clipmap/gl/ClipmapDrawing.h>
#include <dspace/import/urdf/Urdf.h>
#include <dspace/render/SceneDrawer.h>
#include <dspace/scene/Scene.h>
#include <dspace/surface/StreamedTerrain.h>

#include "Alternate.h"

using namespace dspace;
using namespace dspace::bench;

namespace {

constexpr int Width = 1280;
constexpr int Height = 720;

// The shipped rover, chased over the shipped field with the Sun 29 degrees high.
struct Drive {
  explicit Drive(vtkDspaceRenderContext* context) : Context_(context) {
    this->scene->CreateVantage("main");
    this->AddGround();
    this->AddRover();
    Light sun;
    sun.name = SunName;
    const double a = 300.0 * M_PI / 180.0;
    const double e = 29.0 * M_PI / 180.0;
    sun.direction =
        -Eigen::Vector3d(std::sin(a) * std::cos(e), std::cos(a) * std::cos(e), std::sin(e));
    this->scene->SetLight(sun);
    this->frame_ = this->scene->Frames().Create(RootFrame, "camera");
    this->camera.name = "chase";
    this->camera.projection.verticalFov_deg = 42.0;
    this->camera.projection.nearDistance = 0.05;
    this->camera.mount.frame = this->frame_;
    this->camera.mount.X_FC = LookAt("chase", {-4.5, -2.6, 2.2}, {0.8, 0.0, 0.4}, {0, 0, 1});
    this->scene->SetCamera("main", this->camera);
  }

  vtkSmartPointer<vtkDspaceViewport> View(const std::string& name, bool shadows) const {
    auto view = vtkSmartPointer<vtkDspaceViewport>::New();
    view->Initialize(this->Context_, this->scene, name, "main", Width, Height, 1);
    ViewLook look;
    look.shadows.shown = shadows;
    view->SetLook(look);
    view->GetCapture({}); // waits for the ground
    return view;
  }

  void DriveTo(double x) {
    Pose pose;
    pose.position = {x, 0.0, this->surface->Sample({x, 0.0, 0.0}).position_S.z()};
    this->scene->Frames().SetLocalPose(this->frame_, pose);
    pose.position.z() -= this->lowest_;
    this->scene->Frames().SetLocalPose(this->rover_, pose);
  }

  std::shared_ptr<Scene> scene = std::make_shared<Scene>("scene");
  std::shared_ptr<StreamedTerrain> surface;
  Camera camera;
  std::size_t parts = 0;

private:
  void AddGround() {
    StreamedTerrainOptions opening;
    opening.originHeight = 0.0;
    this->surface = StreamedTerrain::Open(DSPACE_DATA_FOLDER "/field/field.tif", opening);
    ClipmapOptions drawing;
    drawing.cells = opening.cells;
    drawing.heights = this->surface->HeightRange();
    auto material = std::make_shared<Material>();
    material->color = {0.55, 0.53, 0.50};
    material->roughness = 1.0;
    drawing.material = material;
    GraphicsObject ground;
    ground.name = "ground";
    ground.frame = RootFrame;
    ground.custom = std::make_shared<ClipmapTerrain>(this->surface->Pyramid(),
                                                     this->surface->Placement(), drawing);
    this->scene->AddObject(std::move(ground));
  }

  // All joints at zero.
  void AddRover() {
    this->rover_ = this->scene->Frames().Create(RootFrame, "rover");
    const Urdf urdf = ReadUrdf(DSPACE_DATA_FOLDER "/rover/rover.urdf");
    std::vector<FrameId> frames(urdf.links.size(), this->rover_);
    std::vector<Pose> X_RL(urdf.links.size());
    for (std::size_t i = 0; i < urdf.links.size(); ++i) {
      const UrdfLink& link = urdf.links[i];
      if (link.parentJoint >= 0) {
        const UrdfJoint& joint = urdf.joints[std::size_t(link.parentJoint)];
        const auto parent = std::size_t(joint.parentLink);
        const Pose X_PL = joint.ChildInParent(0.0);
        frames[i] = this->scene->Frames().Create(frames[parent], link.name, X_PL);
        X_RL[i] = X_RL[parent] * X_PL;
      }
      for (const UrdfVisual& visual : link.visuals) {
        if (visual.shape != UrdfVisual::Shape::Mesh) {
          continue;
        }
        const auto model = std::make_shared<const Model>(ReadModel(visual.meshPath));
        GraphicsObject object;
        object.name = link.name + " " + visual.name;
        object.frame = frames[i];
        object.X_FO.matrix() = visual.X_LV.Matrix();
        object.X_FO.scale(visual.size);
        object.levels = {DetailLevel{PartsOf(model)}};
        this->parts += object.levels.front().parts.size();
        for (const Part& part : object.levels.front().parts) {
          const Eigen::Affine3d X_RP = Eigen::Affine3d(X_RL[i].Matrix()) * object.X_FO * part.X_OP;
          const auto& p = part.mesh->positions;
          for (std::size_t k = 0; k + 2 < p.size(); k += 3) {
            this->lowest_ =
                std::min(this->lowest_, (X_RP * Eigen::Vector3d(p[k], p[k + 1], p[k + 2])).z());
          }
        }
        this->scene->AddObject(std::move(object));
      }
    }
  }

  vtkDspaceRenderContext* Context_;
  FrameId rover_ = 0;
  FrameId frame_ = 0;
  double lowest_ = 0.0;
};

// The shadow maps of a view, drawn without anything else.
class MapsAlone {
public:
  MapsAlone(vtkDspaceRenderContext* context, const Drive& drive)
      : Context_(context), Drive_(drive),
        Drawer_(context->GetHub(), context->GetStore(), context->GetDrawers(), this->Statistics) {}

  void Draw() {
    this->Context_->GetHub()->MakeCurrent();
    DrawView view;
    view.camera = CameraPose{this->Drive_.camera.mount.frame, this->Drive_.camera.mount.X_FC};
    view.projection = this->Drive_.camera.projection;
    view.width = Width;
    view.height = Height;
    view.viewport = "maps";
    view.look.shadows.shown = true;
    this->List_.Build(*this->Drive_.scene, view, {});
    this->Drawer_.Prepare(this->List_, view, 1);
    this->Statistics.drawCalls = this->Statistics.trianglesDrawn = 0;
    this->Drawer_.DrawShadows(*this->Drive_.scene, this->List_, view, 1);
  }

  RenderStatistics Statistics;

private:
  vtkDspaceRenderContext* Context_;
  const Drive& Drive_;
  DrawList List_;
  SceneDrawer Drawer_;
};

void FourCascades(vtkDspaceRenderContext* context) {
  constexpr int Pairs = 41;
  Drive drive(context);
  drive.DriveTo(0.0);
  const auto plain = drive.View("plain", false);
  const auto shadowed = drive.View("shadowed", true);
  MapsAlone maps(context, drive);
  maps.Draw();
  const auto finish = [context] { context->GetRenderWindow()->WaitForCompletion(); };
  double x = 0.0;
  std::vector<double> passes;
  std::vector<double> frames;
  const auto since = [](std::chrono::steady_clock::time_point begin) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - begin).count();
  };
  const Turns turns = Alternate(
      Pairs,
      [&] {
        drive.DriveTo(x += 0.02);
        shadowed->ForceRender();
        finish();
      },
      [&] {
        drive.DriveTo(x += 0.02);
        const auto begin = std::chrono::steady_clock::now();
        plain->ForceRender();
        finish();
        frames.push_back(since(begin));
        const auto between = std::chrono::steady_clock::now();
        maps.Draw();
        finish();
        passes.push_back(since(between));
      });
  char behind[240];
  std::snprintf(
      behind, sizeof behind,
      "goal <= 1.25; the frame alone %.1f ms, the maps alone %.1f ms: %zu parts, %llu draws "
      "of %llu triangles of meshes and ground into 4 + 4 maps; camera and rover move 2 cm",
      1e3 * Median(frames), 1e3 * Median(passes), drive.parts,
      static_cast<unsigned long long>(maps.Statistics.drawCalls),
      static_cast<unsigned long long>(maps.Statistics.trianglesDrawn));
  Print("a frame that draws four shadow maps against a plain frame plus their depth passes", turns,
        1, behind);
}

// Asked for again while nothing moves, and drawn again all the same: the sweep for horizons has
// nothing to do, and nothing is uploaded.
void NothingMoves(vtkDspaceRenderContext* context) {
  constexpr int Pairs = 21;
  constexpr int Asked = 1000;
  Drive drive(context);
  drive.DriveTo(0.0);
  const auto view = drive.View("still", true);
  view->ForceRender();
  const auto finish = [context] { context->GetRenderWindow()->WaitForCompletion(); };
  finish();
  const RenderStatistics before = context->GetStatistics();
  int drawn = 0;
  const Turns turns = Alternate(
      Pairs,
      [&] {
        for (int i = 0; i < Asked; ++i) {
          drawn += view->Render() ? 1 : 0;
        }
        finish();
      },
      [&] {
        view->ForceRender();
        finish();
      });
  const RenderStatistics after = context->GetStatistics();
  char behind[240];
  std::snprintf(
      behind, sizeof behind,
      "%d of %d pictures drawn; %llu bytes of heights and horizons uploaded by %d frames drawn all "
      "the same",
      drawn, Asked * (Pairs + 1),
      static_cast<unsigned long long>(after.textureBytesUploaded - before.textureBytesUploaded),
      int(after.framesDrawn - before.framesDrawn));
  Print("a picture with shadows asked for while nothing moves against one that is drawn", turns, 1,
        behind);
  std::printf("a picture that is asked for: %.4f ms\n", 1e3 * Median(turns.subject) / Asked);
}

} // namespace

int main() {
  vtkNew<vtkDspaceRenderContext> context;
  RegisterClipmapDrawer(context->GetDrawers());
  context->Initialize();
  std::printf("renderer: %s\n", context->GetRendererName().c_str());
  FourCascades(context);
  NothingMoves(context);
  return 0;
}
