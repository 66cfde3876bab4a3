#include <dspace/render/stars/StarDrawer.h>

#include <algorithm>
#include <cmath>

#include "vtk_glew.h"

#include "Star_frag.h"
#include "Star_vert.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/render/Capture.h>
#include <dspace/render/CustomDrawers.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/scene/stars/StarColor.h>

namespace dspace {
namespace {

// Half of what tells display values 0 and 1 of 255 apart, in linear light.
constexpr double Invisible = 0.5 / 255.0 / 12.92;
constexpr int Margin = 64; // [samples] beyond the picture's edges, where stars still reach into it
constexpr double SunFlux = 1.0 / M_PI; // of a white surface that faces the Sun, which shows 1

struct Vertex {
  float direction[3];
  float light[4];
};

constexpr int CellsAcross = 8; // a face of a cube

// Which part of the sky a direction is in, as a part of a cube's face.
int CellOf(const Eigen::Vector3f& direction) {
  int axis = 0;
  direction.cwiseAbs().maxCoeff(&axis);
  const float scale = 0.5f * CellsAcross / std::abs(direction[axis]);
  const auto place = [&](int other) {
    return std::clamp(int(scale * direction[other] + 0.5f * CellsAcross), 0, CellsAcross - 1);
  };
  const int face = 2 * axis + (direction[axis] < 0.0f ? 1 : 0);
  return (face * CellsAcross + place((axis + 1) % 3)) * CellsAcross + place((axis + 2) % 3);
}

double FluxOf(double magnitude) {
  return std::pow(10.0, -0.4 * (magnitude - SunMagnitude));
}

} // namespace

void RegisterStarDrawer(CustomDrawers& drawers) {
  drawers.Register(typeid(StarField), [](const std::shared_ptr<const CustomGeometry>& geometry) {
    return std::make_unique<StarDrawer>(std::static_pointer_cast<const StarField>(geometry));
  });
}

StarDrawer::~StarDrawer() {
  if (this->Buffer_) {
    glDeleteBuffers(1, &this->Buffer_);
    glDeleteVertexArrays(1, &this->Array_);
  }
}

bool StarDrawer::Prepare(const CustomDrawing&) {
  const auto field = this->Field_.lock();
  if (this->Buffer_ || !field) {
    return true;
  }
  std::vector<std::vector<const Star*>> parts(6 * CellsAcross * CellsAcross);
  for (const Star& star : field->Stars()) {
    parts[std::size_t(CellOf(star.direction))].push_back(&star);
  }
  std::vector<Vertex> vertices;
  vertices.reserve(field->Stars().size());
  for (const auto& part : parts) {
    if (part.empty()) {
      continue;
    }
    Cell cell;
    cell.first = int(vertices.size());
    cell.center.setZero();
    for (const Star* star : part) {
      cell.center += star->direction.cast<double>();
    }
    cell.center.normalize();
    for (const Star* star : part) {
      const std::array<float, 3> color = StarColor(double(star->colorIndex));
      vertices.push_back({{star->direction.x(), star->direction.y(), star->direction.z()},
                          {color[0], color[1], color[2], float(FluxOf(double(star->magnitude)))}});
      cell.magnitudes.push_back(star->magnitude);
      const Eigen::Vector3d d = star->direction.cast<double>();
      cell.radius =
          std::max(cell.radius, std::atan2(d.cross(cell.center).norm(), d.dot(cell.center)));
    }
    this->Cells_.push_back(std::move(cell));
  }
  glGenVertexArrays(1, &this->Array_);
  glGenBuffers(1, &this->Buffer_);
  glBindVertexArray(this->Array_);
  glBindBuffer(GL_ARRAY_BUFFER, this->Buffer_);
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size() * sizeof(Vertex)), vertices.data(),
               GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), nullptr);
  glEnableVertexAttribArray(1);
  glVertexAttribPointer(1, 4, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                        reinterpret_cast<const void*>(offsetof(Vertex, light)));
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  return true;
}

void StarDrawer::DrawColor(const CustomDrawing& drawing) {
  const auto field = this->Field_.lock();
  const DrawView& view = drawing.view;
  if (!this->Buffer_ || !field || view.projection.kind == Projection::Kind::Orthographic) {
    return;
  }
  const StarLook& look = field->Look();
  const double gain = drawing.list.Filter().physicalOnly ? 1.0 : look.gain;
  const double exposure = drawing.light ? 1.0 : view.look.exposure;
  const double sample = view.projection.MetresPerPixel(1.0, view.height); // [rad] at the centre
  const double brightness = gain * exposure / (SunFlux * sample * sample);
  const double spread = look.spread * drawing.samples;
  const double side = std::erf(0.5 / (spread * std::sqrt(2.0)));
  // The sample in the corner sees the least of the sky.
  const Eigen::Matrix4d clip = view.ClipFromView();
  double cosine = 1.0;
  for (const double x : {-1.0, 1.0}) {
    for (const double y : {-1.0, 1.0}) {
      const double slopeX = (x + clip(0, 2)) / clip(0, 0);
      const double slopeY = (y + clip(1, 2)) / clip(1, 1);
      cosine = std::min(cosine, 1.0 / std::sqrt(1.0 + slopeX * slopeX + slopeY * slopeY));
    }
  }
  double faintest = look.faintest;
  if (!drawing.light) {
    const double most = brightness * side * side / std::pow(cosine, 3);
    faintest =
        std::min(faintest, SunMagnitude - 2.5 * std::log10(Invisible / std::max(most, 1e-30)));
  }
  Eigen::Matrix3d axes = drawing.object.X_VO.linear();
  for (int i = 0; i < 3; ++i) { // frames may have a scale
    axes.col(i).normalize();
  }
  // The cone about the view's axis that the picture and its margins see.
  const double cone = std::acos(std::clamp(cosine, -1.0, 1.0)) + Margin * sample;
  std::vector<GLint> firsts;
  std::vector<GLsizei> counts;
  for (const Cell& cell : this->Cells_) {
    const Eigen::Vector3d center = axes * cell.center;
    const double away = std::atan2(std::hypot(center.x(), center.y()), -center.z());
    const auto end =
        std::upper_bound(cell.magnitudes.begin(), cell.magnitudes.end(), float(faintest));
    if (away <= cone + cell.radius && end != cell.magnitudes.begin()) {
      firsts.push_back(cell.first);
      counts.push_back(GLsizei(end - cell.magnitudes.begin()));
    }
  }
  if (firsts.empty() || gain == 0.0) {
    return;
  }
  vtkShaderProgram* program = drawing.shaders.Program(Star_vert, Star_frag);
  const Eigen::Matrix3f viewFromObject = axes.cast<float>();
  const Eigen::Matrix4f clipFromView = clip.cast<float>();
  program->SetUniformMatrix3x3("viewFromObject", const_cast<float*>(viewFromObject.data()));
  program->SetUniformMatrix4x4("clipFromView", const_cast<float*>(clipFromView.data()));
  const float size[2] = {float(view.width), float(view.height)};
  const float guard[2] = {float(view.width) / float(view.width + 2 * Margin),
                          float(view.height) / float(view.height + 2 * Margin)};
  program->SetUniform2f("pictureSize", size);
  program->SetUniform2f("guard", guard);
  program->SetUniformf("spread", float(spread));
  const float slopes[4] = {
      float(2.0 / (view.width * clip(0, 0))), float(2.0 / (view.height * clip(1, 1))),
      float((clip(0, 2) - 1.0) / clip(0, 0)), float((clip(1, 2) - 1.0) / clip(1, 1))};
  program->SetUniform4f("slopes", slopes);
  program->SetUniformf("peak", float(side * side));
  program->SetUniformf("brightness", float(brightness));
  program->SetUniformf("faintest", drawing.light ? 0.0f : float(Invisible));
  program->SetUniformf("largest", float(2 * Margin));
  vtkOpenGLState* state = drawing.window->GetState();
  state->vtkglViewport(-Margin, -Margin, view.width + 2 * Margin, view.height + 2 * Margin);
  state->vtkglEnable(GL_BLEND);
  state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE, GL_ONE, GL_ONE); // exposed: its alpha is above 0
  state->vtkglDepthMask(GL_FALSE);
  glEnable(GL_PROGRAM_POINT_SIZE);
  glBindVertexArray(this->Array_);
  glMultiDrawArrays(GL_POINTS, firsts.data(), counts.data(), GLsizei(firsts.size()));
  glBindVertexArray(0);
  glDisable(GL_PROGRAM_POINT_SIZE);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglDisable(GL_BLEND);
  state->vtkglViewport(0, 0, view.width, view.height);
  ++drawing.statistics.drawCalls;
}

} // namespace dspace
