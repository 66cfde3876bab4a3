#include <dspace/render/trajectories/TrajectoryDrawer.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <utility>

#include "vtk_glew.h"

#include "TrajectoryLabel_frag.h"
#include "TrajectoryLine_vert.h"
#include "TrajectoryPlain_frag.h"
#include "TrajectoryTimed_frag.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/render/Capture.h>
#include <dspace/render/CustomDrawers.h>
#include <dspace/render/RenderTarget.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/scene/LinearLight.h>

namespace dspace {
namespace {

constexpr double Farther = 1e7; // [m] than what shadows are sharp for: lines take none
constexpr float Forever = 3e38f;
constexpr std::size_t MostFreeMarks = 1000;

struct Vertex {
  float high[3];
  float low[3];
  float time[2];
  std::uint8_t color[4];
};

// A double as two floats. Volatile: GCC 12 at -O3 takes double(float(x)) for x where it vectorizes.
std::array<float, 2> Split(double value) {
  const volatile float high = float(value);
  return {high, float(value - double(high))};
}

void PutVertex(double time, const Eigen::Vector3d& p, const TrajectoryLine::Color& color,
               std::vector<Vertex>& to) {
  Vertex vertex;
  for (int k = 0; k < 3; ++k) {
    const auto parts = Split(p[k]);
    vertex.high[k] = parts[0];
    vertex.low[k] = parts[1];
  }
  const auto parts = Split(time);
  vertex.time[0] = parts[0];
  vertex.time[1] = parts[1];
  std::copy(color.begin(), color.end(), vertex.color);
  to.push_back(vertex);
}

constexpr TrajectoryLine::Color White = {255, 255, 255, 255};

float Length(double seconds) {
  return float(std::min(seconds, double(Forever)));
}

bool InWindow(const TrajectoryLine& line, double time) {
  const double elapsed = time - line.Time();
  return elapsed >= -line.Look().before && elapsed <= line.Look().after;
}

} // namespace

void RegisterTrajectoryDrawer(CustomDrawers& drawers) {
  drawers.Register(typeid(TrajectoryLine),
                   [](const std::shared_ptr<const CustomGeometry>& geometry) {
                     return std::make_unique<TrajectoryDrawer>(
                         std::static_pointer_cast<const TrajectoryLine>(geometry));
                   });
}

TrajectoryDrawer::~TrajectoryDrawer() {
  for (Buffer* buffer : {&this->Whole_, &this->Detail_, &this->Ticks_}) {
    if (buffer->array) {
      glDeleteBuffers(1, &buffer->vertices);
      glDeleteVertexArrays(1, &buffer->array);
    }
  }
}

void TrajectoryDrawer::Upload(Buffer& buffer, const std::vector<TrajectoryLine::Strip>& strips,
                              bool dynamic) {
  std::vector<Vertex> vertices;
  for (const auto& strip : strips) {
    for (std::size_t i = 0; i < strip.points.size(); ++i) {
      PutVertex(strip.times[i], strip.points[i], strip.colors.empty() ? White : strip.colors[i],
                vertices);
    }
  }
  const bool made = buffer.array == 0;
  if (made) {
    glGenVertexArrays(1, &buffer.array);
    glGenBuffers(1, &buffer.vertices);
  }
  glBindVertexArray(buffer.array);
  glBindBuffer(GL_ARRAY_BUFFER, buffer.vertices);
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices.size() * sizeof(Vertex)), vertices.data(),
               dynamic ? GL_DYNAMIC_DRAW : GL_STATIC_DRAW);
  if (made) {
    const auto at = [](std::size_t offset) { return reinterpret_cast<const void*>(offset); };
    for (GLuint i = 0; i < 4; ++i) {
      glEnableVertexAttribArray(i);
    }
    glVertexAttribPointer(0, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), at(offsetof(Vertex, high)));
    glVertexAttribPointer(1, 3, GL_FLOAT, GL_FALSE, sizeof(Vertex), at(offsetof(Vertex, low)));
    glVertexAttribPointer(2, 2, GL_FLOAT, GL_FALSE, sizeof(Vertex), at(offsetof(Vertex, time)));
    glVertexAttribPointer(3, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(Vertex),
                          at(offsetof(Vertex, color)));
  }
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

bool TrajectoryDrawer::Prepare(const CustomDrawing&) {
  const auto line = this->Line_.lock();
  if (!line) {
    return true;
  }
  if (this->Uploaded_ != line->PointsRevision()) {
    this->Uploaded_ = line->PointsRevision();
    this->DetailKnown_ = false;
    this->Firsts_.clear();
    int first = 0;
    for (const auto& strip : line->Strips()) {
      this->Firsts_.push_back(first);
      first += int(strip.points.size());
    }
    this->Upload(this->Whole_, line->Strips(), false);
    if (!line->Ticks().empty()) {
      TrajectoryLine::Strip ticks;
      for (const auto& tick : line->Ticks()) {
        ticks.times.push_back(tick.time);
        ticks.points.push_back(tick.point);
      }
      this->Upload(this->Ticks_, {ticks}, false);
    }
  }
  if (!this->DetailKnown_ || this->DetailTime_ != line->Time()) {
    const auto& detail = line->GetDetail().points;
    this->DetailCount_ = int(detail.points.size());
    if (this->DetailCount_ > 0) {
      this->Upload(this->Detail_, {detail}, true);
    }
    this->DetailTime_ = line->Time();
    this->DetailKnown_ = true;
  }
  return true;
}

double TrajectoryDrawer::NearestDepth(const CustomDrawing&) {
  return Farther;
}

void TrajectoryDrawer::DrawLines(const TrajectoryLine& line) const {
  const auto& detail = line.GetDetail();
  glBindVertexArray(this->Whole_.array);
  for (std::size_t s = 0; s < line.Strips().size(); ++s) {
    const int first = this->Firsts_[s];
    const auto count = int(line.Strips()[s].points.size());
    if (this->DetailCount_ == 0 || s != detail.strip) {
      glDrawArrays(GL_LINE_STRIP, first, count);
      continue;
    }
    const auto before = int(detail.first);
    const auto after = int(detail.last);
    if (before > 0) {
      glDrawArrays(GL_LINE_STRIP, first, before + 1);
    }
    if (after < count - 1) {
      glDrawArrays(GL_LINE_STRIP, first + after, count - after);
    }
    glBindVertexArray(this->Detail_.array);
    glDrawArrays(GL_LINE_STRIP, 0, this->DetailCount_);
    glBindVertexArray(this->Whole_.array);
  }
  glBindVertexArray(0);
}

void TrajectoryDrawer::SetUniforms(const CustomDrawing& drawing, const TrajectoryLine& line,
                                   vtkShaderProgram* program, const char* fragment,
                                   bool translucent) {
  const TrajectoryLook& look = line.Look();
  const bool timed = fragment != TrajectoryPlain_frag;
  const bool labels = fragment == TrajectoryLabel_frag;
  // Words of four bytes: no padding between them. Many lines have all of them in common.
  struct Values {
    float eyeHigh[3], eyeLow[3], viewFromObject[9], clipFromView[16];
    float now[2], window[2];
    float color[4], alpha, fading[2], ahead;
    std::uint32_t label, dithered;
  } values{};
  const Eigen::Affine3d& X_VO = drawing.object.X_VO;
  const Eigen::Vector3d eye = X_VO.linear().inverse() * -X_VO.translation();
  for (int k = 0; k < 3; ++k) {
    const auto parts = Split(eye[k]);
    values.eyeHigh[k] = parts[0];
    values.eyeLow[k] = parts[1];
  }
  Eigen::Map<Eigen::Matrix3f>(values.viewFromObject) = X_VO.linear().cast<float>();
  Eigen::Map<Eigen::Matrix4f>(values.clipFromView) = drawing.view.ClipFromView().cast<float>();
  if (timed) {
    const auto now = Split(line.Time());
    std::copy(now.begin(), now.end(), values.now);
    values.window[0] = Length(look.before);
    values.window[1] = Length(look.after);
  }
  if (labels) {
    const bool parts = drawing.list.Filter().partsOf != 0; // labels are those of its parts
    values.label = parts ? 0 : drawing.object.object->id;
  } else {
    for (int k = 0; k < 3; ++k) {
      values.color[k] = float(look.color[std::size_t(k)]); // sRGB: made linear where it is set
    }
    values.color[3] = float(look.opacity);
    values.alpha = drawing.light ? 0.0f : 1.0f;
    if (timed) {
      const auto lengths = line.FadeLengths();
      // A side without length fades at once: nothing of it is in the window but its end.
      for (int k = 0; k < 2; ++k) {
        values.fading[k] = look.fade ? std::max(Length(lengths[std::size_t(k)]), 1e-30f) : 0.0f;
      }
      values.ahead = float(look.ahead);
      values.dithered = translucent ? 0 : 1;
    }
  }
  if (drawing.shaders.HasUniforms(program, &values, sizeof(values))) {
    return;
  }
  program->SetUniform3f("eyeHigh", values.eyeHigh);
  program->SetUniform3f("eyeLow", values.eyeLow);
  program->SetUniformMatrix3x3("viewFromObject", values.viewFromObject);
  program->SetUniformMatrix4x4("clipFromView", values.clipFromView);
  if (timed) {
    program->SetUniform2f("now", values.now);
    program->SetUniform2f("window", values.window);
  }
  if (labels) {
    program->SetUniformi("label", int(values.label));
    return;
  }
  const std::array<float, 3> color = LinearColor(look.color);
  const float light[4] = {color[0], color[1], color[2], values.color[3]};
  program->SetUniform4f("look", light);
  program->SetUniformf("alpha", values.alpha);
  if (timed) {
    program->SetUniform2f("fading", values.fading);
    program->SetUniformf("ahead", values.ahead);
    program->SetUniformi("dithered", int(values.dithered));
  }
}

void TrajectoryDrawer::Draw(const CustomDrawing& drawing, const char* fragment, bool translucent) {
  const auto line = this->Line_.lock();
  if (!line || !this->Whole_.array) {
    return;
  }
  const TrajectoryLook& look = line->Look();
  vtkShaderProgram* program = drawing.shaders.Program(TrajectoryLine_vert, fragment);
  this->SetUniforms(drawing, *line, program, fragment, translucent);
  vtkOpenGLState* state = drawing.window->GetState();
  if (translucent) {
    state->vtkglEnable(GL_BLEND);
    state->vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    state->vtkglDepthMask(GL_FALSE);
  }
  state->vtkglLineWidth(float(drawing.object.object->lineWidth) * float(drawing.samples));
  this->DrawLines(*line);
  ++drawing.statistics.drawCalls;
  if (this->Ticks_.array && look.tickSize > 0.0) {
    program->SetUniformf("pointSize", float(look.tickSize * drawing.samples));
    glEnable(GL_PROGRAM_POINT_SIZE);
    glBindVertexArray(this->Ticks_.array);
    glDrawArrays(GL_POINTS, 0, GLsizei(line->Ticks().size()));
    glBindVertexArray(0);
    glDisable(GL_PROGRAM_POINT_SIZE);
    ++drawing.statistics.drawCalls;
  }
  if (translucent) {
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglDisable(GL_BLEND);
  }
}

void TrajectoryDrawer::DrawColor(const CustomDrawing& drawing) {
  const auto line = this->Line_.lock();
  if (!line) {
    return;
  }
  const bool translucent = line->IsTranslucent();
  if (translucent && !drawing.light) {
    return; // DrawTranslucent
  }
  this->Draw(drawing,
             translucent || line->FollowsTime() ? TrajectoryTimed_frag : TrajectoryPlain_frag,
             false);
}

void TrajectoryDrawer::DrawTranslucent(const CustomDrawing& drawing, const RenderTarget&) {
  const auto line = this->Line_.lock();
  if (line && !drawing.light && line->IsTranslucent()) {
    this->Draw(drawing, TrajectoryTimed_frag, true);
  }
}

void TrajectoryDrawer::DrawLabels(const CustomDrawing& drawing) {
  if (!drawing.list.Filter().castersOnly && !drawing.view.clip) {
    this->Draw(drawing, TrajectoryLabel_frag, false);
  }
}

std::vector<Caption> TrajectoryDrawer::Captions(const CustomDrawing& drawing,
                                                const RenderTarget& target) {
  const auto line = this->Line_.lock();
  if (!line || !line->Look().tickLabels || line->Ticks().empty()) {
    return {};
  }
  const TrajectoryLook& look = line->Look();
  const DrawView& view = drawing.view;
  const double width = double(view.width) / view.samples;
  const double height = double(view.height) / view.samples;
  const Eigen::Matrix4d clip = view.ClipFromView();
  struct Box {
    double x, y, halfWidth, halfHeight;
  };
  std::vector<Box> taken;
  std::vector<Caption> captions;
  const auto& ticks = line->Ticks();
  // Marks stay free of the labels of others, unless they make a band.
  if (look.tickSize > 0.0 && ticks.size() <= MostFreeMarks) {
    for (const TrajectoryLine::Tick& tick : ticks) {
      const Eigen::Vector4d p = clip * (drawing.object.X_VO * tick.point).homogeneous();
      if (InWindow(*line, tick.time) && p.w() > 0.0) {
        taken.push_back({0.5 * (p.x() / p.w() + 1.0) * width - 0.5,
                         0.5 * (1.0 - p.y() / p.w()) * height - 0.5, 0.5 * look.tickSize,
                         0.5 * look.tickSize});
      }
    }
  }
  // Every 2^k-th tick first, then those between them: labels that remain are evenly spread.
  std::size_t stride = 1;
  while (stride * 2 < ticks.size()) {
    stride *= 2;
  }
  const auto place = [&](const TrajectoryLine::Tick& tick) {
    if (tick.label.empty() || !InWindow(*line, tick.time)) {
      return;
    }
    const Eigen::Vector3d p_V = drawing.object.X_VO * tick.point;
    const Eigen::Vector4d p = clip * p_V.homogeneous();
    if (!(p.w() > 0.0) || !(p.z() >= 0.0 && p.z() <= p.w())) {
      return;
    }
    const double x = 0.5 * (p.x() / p.w() + 1.0) * width;
    const double y = 0.5 * (1.0 - p.y() / p.w()) * height;
    Caption caption;
    caption.text = tick.label;
    caption.fontSize = look.fontSize;
    caption.color = {look.color[0], look.color[1], look.color[2], 1.0};
    caption.yields = true;
    const std::array<double, 2> half = HalfSize(caption);
    const double apart = 0.5 * look.tickSize + 3.0;
    // Right of its tick, or left of it at the picture's edge.
    const bool left = x + apart + 2.0 * half[0] > width;
    caption.at = {x + (left ? -1.0 : 1.0) * (apart + half[0]) - 0.5, y - 0.5};
    if (x < 0.0 || x >= width || y < half[1] || y >= height - half[1] ||
        caption.at[0] < half[0] - 0.5 || caption.at[0] > width - half[0]) {
      return;
    }
    const Box box{caption.at[0], caption.at[1], half[0], half[1]};
    for (const Box& other : taken) {
      if (std::abs(box.x - other.x) < box.halfWidth + other.halfWidth &&
          std::abs(box.y - other.y) < box.halfHeight + other.halfHeight) {
        return;
      }
    }
    const int column = std::clamp(int(x * view.samples), 0, view.width - 1);
    const int row = std::clamp(int(y * view.samples), 0, view.height - 1);
    const double depth = double(target.ReadDepth(column, row, 1, 1).front());
    if (depth > p.z() / p.w() * (1.0 + 1e-4) + 1e-12) {
      return; // something is before it
    }
    taken.push_back(box);
    captions.push_back(std::move(caption));
  };
  for (std::size_t i = 0; i < ticks.size(); i += stride) {
    place(ticks[i]);
  }
  for (; stride > 1; stride /= 2) {
    for (std::size_t i = stride / 2; i < ticks.size(); i += stride) {
      place(ticks[i]);
    }
  }
  return captions;
}

} // namespace dspace
