// A plug-in that draws solar sails: a sheet that ripples in the vertex shader (sail.vert.glsl),
// with seams that the fragment shader draws (sail.frag.glsl). `own_object.py` loads it;
// Documentation/OwnObjects.md explains it.
#include <array>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceSession.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/Error.h>
#include <dspace/commands/viewports/DrawerPlugIn.h>
#include <dspace/render/Capture.h>
#include <dspace/render/CustomDrawer.h>
#include <dspace/render/SurfaceShaders.h>

#include "SailShaders.h" // sail.vert.glsl and sail.frag.glsl, made by CMakeLists.txt

namespace {

constexpr int Cells = 96; // a side of the grid that the vertex shader moves

// What a scene sees. Its look does not change: a new object is made for another one.
class Sail : public dspace::CustomGeometry {
public:
  Sail(double edge, double ripple, double phase) : Edge(edge), Ripple(ripple), Phase(phase) {}
  dspace::BoundingSphere Bounds() const override {
    return {Eigen::Vector3d::Zero(), std::hypot(std::sqrt(0.5) * this->Edge, this->Ripple)};
  }
  std::uint64_t Revision() const override { return 1; }

  const double Edge;
  const double Ripple;
  const double Phase;
};

// Draws one sail in one picture. The context is current in every function.
class SailDrawer : public dspace::CustomDrawer {
public:
  explicit SailDrawer(const Sail& sail) : Sail_(&sail) {}
  ~SailDrawer() override {
    if (this->VertexArray_) {
      glDeleteVertexArrays(1, &this->VertexArray_);
      glDeleteBuffers(2, this->Buffers_);
    }
  }

  bool Prepare(const dspace::CustomDrawing&) override {
    if (!this->VertexArray_) {
      this->Upload();
    }
    return true; // all data are there
  }

  void DrawColor(const dspace::CustomDrawing& drawing) override {
    using Shaders = dspace::SurfaceShaders;
    this->Draw(drawing, Shaders::LightFeatures(drawing.list, drawing.view) | Shaders::Mixed,
               SailFragment);
  }

  void DrawLabels(const dspace::CustomDrawing& drawing) override {
    this->Draw(drawing, dspace::SurfaceShaders::Label, nullptr);
  }

private:
  void Upload() {
    std::vector<float> corners;
    std::vector<unsigned int> indices;
    for (int row = 0; row <= Cells; ++row) {
      for (int column = 0; column <= Cells; ++column) {
        corners.insert(corners.end(), {float(column) / Cells, float(row) / Cells});
        if (row < Cells && column < Cells) {
          const auto first = unsigned(row * (Cells + 1) + column);
          const unsigned up = first + Cells + 1;
          indices.insert(indices.end(), {first, first + 1, up, up, first + 1, up + 1});
        }
      }
    }
    this->Count_ = GLsizei(indices.size());
    glGenVertexArrays(1, &this->VertexArray_);
    glBindVertexArray(this->VertexArray_);
    glGenBuffers(2, this->Buffers_);
    glBindBuffer(GL_ARRAY_BUFFER, this->Buffers_[0]);
    glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(corners.size() * sizeof(float)), corners.data(),
                 GL_STATIC_DRAW);
    glEnableVertexAttribArray(0);
    glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
    glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, this->Buffers_[1]);
    glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices.size() * sizeof(unsigned int)),
                 indices.data(), GL_STATIC_DRAW);
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
  }

  void Draw(const dspace::CustomDrawing& drawing, dspace::SurfaceShaders::Features features,
            const char* fragment) {
    dspace::ShaderPages pages;
    pages.vertex = SailVertex;
    pages.fragment = fragment;
    vtkShaderProgram* program = drawing.shaders.Surface(features, pages);
    drawing.shaders.SetView(program, drawing.list, drawing.view, drawing.samples);
    // From the object to the view in double precision; only then floats.
    const Eigen::Affine3d& X_VO = drawing.object.X_VO;
    Eigen::Matrix4f place = X_VO.matrix().cast<float>(); // column by column, as OpenGL reads it
    Eigen::Matrix3f normal =
        (X_VO.linear().inverse().transpose() / X_VO.linear().inverse().norm()).cast<float>();
    program->SetUniformMatrix4x4("MCVCMatrix", place.data());
    program->SetUniformMatrix3x3("normalMatrix", normal.data());
    const float sail[3] = {float(this->Sail_->Edge), float(this->Sail_->Ripple),
                           float(this->Sail_->Phase)};
    program->SetUniform3f("sail", sail);
    const dspace::GraphicsObject& object = *drawing.object.object;
    if (features & dspace::SurfaceShaders::Label) {
      program->SetUniformi("objectLabel", int(object.id));
    } else {
      float color[4] = {0, 0, 0, 1};
      for (int i = 0; i < 3; ++i) { // the material of the object, if it has one
        const auto given = object.material.color.value_or(std::array<double, 3>{0.9, 0.8, 0.5});
        color[i] = dspace::LinearFromSrgb(given[std::size_t(i)]);
      }
      program->SetUniform4f("sailColor", color);
    }
    glBindVertexArray(this->VertexArray_);
    glDrawElements(GL_TRIANGLES, this->Count_, GL_UNSIGNED_INT, nullptr);
    glBindVertexArray(0);
    ++drawing.statistics.drawCalls;
  }

  const Sail* Sail_;
  GLuint VertexArray_ = 0;
  GLuint Buffers_[2] = {0, 0};
  GLsizei Count_ = 0;
};

// The parameters are three doubles: edge [m], height of the ripples [m], phase [rad].
std::shared_ptr<const dspace::CustomGeometry>
MakeSail(const dspace::session::DrawnRequest& request) {
  using dspace::Error;
  double values[3];
  if (request.parameters.size() != sizeof values) {
    throw Error(Error::Kind::InvalidArgument, request.object,
                "its parameters have " + std::to_string(request.parameters.size()) +
                    " bytes; accepted: three doubles (edge [m], ripple [m], phase [rad])");
  }
  std::memcpy(values, request.parameters.data(), sizeof values);
  if (!(values[0] > 0 && std::isfinite(values[0])) ||
      !(values[1] >= 0 && values[1] <= 0.1 * values[0]) || !std::isfinite(values[2])) {
    throw Error(Error::Kind::InvalidArgument, request.object,
                "its edge is " + std::to_string(values[0]) + " m, its ripple " +
                    std::to_string(values[1]) + " m, its phase " + std::to_string(values[2]) +
                    " rad; accepted: an edge > 0, a ripple up to a tenth of it, a finite phase");
  }
  return std::make_shared<Sail>(values[0], values[1], values[2]);
}

} // namespace

// dspace.Session.load_plugin() and vtkDspaceSession::LoadPlugIn() call it.
extern "C" void DspacePlugIn(vtkDspaceSession* session) {
  session->AddDrawer({"solar_sail", MakeSail, typeid(Sail),
                      [](const std::shared_ptr<const dspace::CustomGeometry>& geometry)
                          -> std::unique_ptr<dspace::CustomDrawer> {
                        return std::make_unique<SailDrawer>(static_cast<const Sail&>(*geometry));
                      }});
}
