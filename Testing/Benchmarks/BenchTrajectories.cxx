// A thousand trajectories of a thousand points against as many bare line strips of floats, each
// drawn with one call after one uniform, in the same picture.
#include <cmath>
#include <cstdio>

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"
#include "vtkNew.h"
#include "vtkOpenGLState.h"
#include "vtkRenderWindow.h"
#include "vtkShaderProgram.h"
#include "vtkSmartPointer.h"
#include "vtk_glew.h"

#include "BareLine_frag.h"
#include "BareLine_vert.h"

#include <dspace/render/CustomDrawers.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/render/trajectories/TrajectoryDrawer.h>

#include "Alternate.h"

using namespace dspace;

namespace {

constexpr int Lines = 1000;
constexpr int Points = 1000;

TrajectoryLine::Strip OrbitOf(int i) {
  const Eigen::Quaterniond plane(Eigen::AngleAxisd(0.37 * i, Eigen::Vector3d::UnitZ()) *
                                 Eigen::AngleAxisd(0.011 * i, Eigen::Vector3d::UnitX()));
  TrajectoryLine::Strip strip;
  for (int k = 0; k < Points; ++k) {
    const double angle = 2.0 * M_PI * k / (Points - 1.0);
    strip.times.push_back(5.0 * k);
    strip.points.push_back(
        plane * ((7e6 + 2e4 * i) * Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.0)));
  }
  return strip;
}

class BareLines : public CustomGeometry {
public:
  BoundingSphere Bounds() const override { return {Eigen::Vector3d::Zero(), 3e7}; }
  std::uint64_t Revision() const override { return 1; }
};

class BareDrawer : public CustomDrawer {
public:
  bool Prepare(const CustomDrawing&) override {
    if (!this->Arrays_.empty()) {
      return true;
    }
    this->Arrays_.resize(Lines);
    std::vector<GLuint> buffers(Lines);
    glGenVertexArrays(Lines, this->Arrays_.data());
    glGenBuffers(Lines, buffers.data());
    for (int i = 0; i < Lines; ++i) {
      std::vector<float> numbers;
      for (const Eigen::Vector3d& p : OrbitOf(i).points) {
        numbers.insert(numbers.end(), {float(p.x()), float(p.y()), float(p.z())});
      }
      glBindVertexArray(this->Arrays_[std::size_t(i)]);
      glBindBuffer(GL_ARRAY_BUFFER, buffers[std::size_t(i)]);
      glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(4 * numbers.size()), numbers.data(), GL_STATIC_DRAW);
      glEnableVertexAttribArray(0);
      glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, 12, nullptr);
    }
    glBindVertexArray(0);
    return true;
  }
  void DrawColor(const CustomDrawing& drawing) override {
    vtkShaderProgram* program = drawing.shaders.Program(BareLine_vert, BareLine_frag);
    const Eigen::Matrix4f clip =
        (drawing.view.ClipFromView() * drawing.object.X_VO.matrix()).cast<float>();
    const float white[4] = {1, 1, 1, 1};
    program->SetUniform4f("color", white);
    drawing.window->GetState()->vtkglLineWidth(1.0f);
    const GLint matrix = glGetUniformLocation(GLuint(program->GetHandle()), "clipFromObject");
    for (const GLuint array : this->Arrays_) {
      glUniformMatrix4fv(matrix, 1, GL_FALSE, clip.data());
      glBindVertexArray(array);
      glDrawArrays(GL_LINE_STRIP, 0, Points);
    }
    glBindVertexArray(0);
  }
  void DrawLabels(const CustomDrawing&) override {}

private:
  std::vector<GLuint> Arrays_;
};

std::shared_ptr<Scene> SceneWithCamera(const std::string& name) {
  auto scene = std::make_shared<Scene>(name);
  scene->CreateVantage("main");
  Camera camera;
  camera.name = "camera";
  camera.mount.X_FC = LookAt("camera", {-8e7, 0, 2e7}, {0, 0, 0}, {0, 0, 1});
  scene->SetCamera("main", camera);
  return scene;
}

ObjectId Add(Scene& scene, const std::string& name,
             std::shared_ptr<const CustomGeometry> geometry) {
  GraphicsObject object;
  object.name = name;
  object.nature = Nature::Ornamental;
  object.fragment = "ornamental";
  object.custom = std::move(geometry);
  return scene.AddObject(object);
}

} // namespace

int main(int argc, char** argv) {
  const int pairs = argc > 1 ? std::atoi(argv[1]) : 15;
  vtkNew<vtkDspaceRenderContext> context;
  RegisterTrajectoryDrawer(context->GetDrawers());
  context->GetDrawers().Register(
      typeid(BareLines),
      [](const std::shared_ptr<const CustomGeometry>&) { return std::make_unique<BareDrawer>(); });
  const auto ours = SceneWithCamera("ours");
  std::vector<std::shared_ptr<TrajectoryLine>> lines;
  for (int i = 0; i < Lines; ++i) {
    lines.push_back(
        std::make_shared<TrajectoryLine>("line", std::vector<TrajectoryLine::Strip>{OrbitOf(i)}));
    Add(*ours, "line " + std::to_string(i), lines.back());
  }
  const auto bare = SceneWithCamera("bare");
  Add(*bare, "lines", std::make_shared<BareLines>());
  const auto view = [&](const std::shared_ptr<Scene>& scene) {
    auto viewport = vtkSmartPointer<vtkDspaceViewport>::New();
    viewport->Initialize(context, scene, scene->Name(), "main", 1280, 720);
    viewport->SetSamples(1);
    return viewport;
  };
  const auto first = view(ours);
  const auto second = view(bare);
  const auto draw = [&](vtkDspaceViewport* viewport) {
    viewport->ForceRender();
    context->GetRenderWindow()->WaitForCompletion();
  };
  const auto run = [&](const char* name, const char* behind) {
    const bench::Turns turns = bench::Alternate(
        pairs, [&] { draw(first); }, [&] { draw(second); });
    bench::Print(name, turns, 1, behind);
  };
  run("trajectories", "1,000 lines of 1,000 points, 1280 x 720, goal <= 1.2");
  TrajectoryLook look;
  look.before = 3000.0;
  look.fade = true;
  double time = 0.0;
  for (const auto& line : lines) {
    line->SetLook("line", look);
  }
  const bench::Turns moving = bench::Alternate(
      pairs,
      [&] {
        time += 10.0;
        for (const auto& line : lines) {
          line->SetTime(time);
        }
        draw(first);
      },
      [&] { draw(second); });
  bench::Print("trajectories, fading windows that move", moving, 1,
               "the same lines; the bare ones are whole and opaque");
  return 0;
}
