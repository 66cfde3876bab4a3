#include <dspace/clipmap/gl/ClipmapDrawer.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/clipmap/ClipmapBlocks.h>
#include <dspace/clipmap/ClipmapFocus.h>
#include <dspace/render/Capture.h>
#include <dspace/render/CustomDrawers.h>
#include <dspace/render/GpuStore.h>
#include <dspace/render/SurfaceShaders.h>

#include <dspace/clipmap/gl/ClipmapShaders.h>
#include <dspace/clipmap/gl/ClipmapUniforms.h>
#include <dspace/clipmap/gl/GridCaptions.h>

namespace dspace {

void RegisterClipmapDrawer(CustomDrawers& drawers) {
  drawers.Register(
      typeid(ClipmapTerrain),
      [](std::shared_ptr<const CustomGeometry> geometry) -> std::unique_ptr<CustomDrawer> {
        return std::make_unique<ClipmapDrawer>(static_cast<const ClipmapTerrain&>(*geometry));
      });
}

namespace {

// Sets line or fill mode during its lifetime, also if an exception is thrown.
class PolygonMode {
public:
  explicit PolygonMode(GLenum mode) { glPolygonMode(GL_FRONT_AND_BACK, mode); }
  PolygonMode(const PolygonMode&) = delete;
  PolygonMode& operator=(const PolygonMode&) = delete;
  ~PolygonMode() { glPolygonMode(GL_FRONT_AND_BACK, GL_FILL); }
};

// The camera's place and the view volume, in the terrain's frame.
ClipmapViewVolume ViewVolumeOf(const ClipmapCamera& camera, const DrawView& view) {
  const Eigen::Matrix4d clip =
      view.projection.ClipFromView(view.width, view.height) * camera.X_VS.matrix();
  ClipmapViewVolume sight;
  sight.camera = camera.position;
  for (const int axis : {0, 1}) {
    for (const double sign : {1.0, -1.0}) {
      sight.planes.emplace_back(clip.row(3) + sign * clip.row(axis));
    }
  }
  sight.planes.emplace_back(clip.row(3) - clip.row(2)); // near; depth is reversed
  return sight;
}

FocusView FocusViewOf(const ClipmapCamera& camera, const DrawView& view) {
  const Projection& projection = view.projection;
  const Eigen::Matrix3d X_SV = camera.X_VS.linear().inverse(); // view axes: along -Z
  FocusView focus;
  focus.camera = camera.position;
  focus.forward = (X_SV * -Eigen::Vector3d::UnitZ()).normalized();
  focus.parallel = projection.kind == Projection::Kind::Orthographic;
  if (focus.parallel) {
    focus.half = 0.5 * projection.height * std::max(1.0, double(view.width) / view.height);
    return focus;
  }
  focus.half = 0.0;
  for (const auto& [x, y] : {std::pair(0.0, 0.0),
                             {0.5, 0.0},
                             {1.0, 0.0},
                             {0.0, 0.5},
                             {1.0, 0.5},
                             {0.0, 1.0},
                             {0.5, 1.0},
                             {1.0, 1.0}}) {
    // Sensor axes: X right, Y down, Z forward.
    const Eigen::Vector3d direction =
        projection.PixelRay(x * view.width - 0.5, y * view.height - 0.5, view.width, view.height)
            .direction;
    const Eigen::Vector3d inView(direction.x(), -direction.y(), -direction.z());
    focus.rim.push_back((X_SV * inView).normalized());
    const Eigen::Vector2d tangents = direction.head<2>().cwiseAbs() / direction.z();
    focus.half = std::max(focus.half, tangents.maxCoeff());
  }
  return focus;
}

} // namespace

ClipmapDrawer::ClipmapDrawer(const ClipmapTerrain& terrain)
    : Terrain_(&terrain), Indices_(terrain.Options().cells), Charts_(terrain.Charts().size()),
      Layers_(terrain) {}

ClipmapDrawer::~ClipmapDrawer() {
  for (const auto& chart : this->Charts_) {
    if (chart && chart->texture) {
      glDeleteTextures(1, &chart->texture);
    }
  }
  if (this->VertexArray_) {
    glDeleteVertexArrays(1, &this->VertexArray_);
    glDeleteBuffers(1, &this->VertexBuffer_);
    glDeleteBuffers(1, &this->IndexBuffer_);
  }
}

void ClipmapDrawer::CreateTexture(Chart& chart) {
  const int side = chart.levels.Geometry().Texels();
  glGenTextures(1, &chart.texture);
  glBindTexture(GL_TEXTURE_2D_ARRAY, chart.texture);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, side, side, chart.levels.Count(), 0, GL_RGBA,
               GL_FLOAT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
  }
}

void ClipmapDrawer::Create() {
  const int posts = this->Terrain_->Options().cells + 1;
  std::vector<float> cells;
  for (int r = 0; r < posts; ++r) {
    for (int c = 0; c < posts; ++c) {
      cells.insert(cells.end(), {float(c), float(r)});
    }
  }
  glGenVertexArrays(1, &this->VertexArray_);
  glBindVertexArray(this->VertexArray_);
  glGenBuffers(1, &this->VertexBuffer_);
  glBindBuffer(GL_ARRAY_BUFFER, this->VertexBuffer_);
  glBufferData(GL_ARRAY_BUFFER, GLsizeiptr(cells.size() * sizeof(float)), cells.data(),
               GL_STATIC_DRAW);
  glEnableVertexAttribArray(0);
  glVertexAttribPointer(0, 2, GL_FLOAT, GL_FALSE, 0, nullptr);
  glGenBuffers(1, &this->IndexBuffer_);
  glBindBuffer(GL_ELEMENT_ARRAY_BUFFER, this->IndexBuffer_);
  const std::vector<std::uint16_t>& indices = this->Indices_.Indices();
  glBufferData(GL_ELEMENT_ARRAY_BUFFER, GLsizeiptr(indices.size() * sizeof(std::uint16_t)),
               indices.data(), GL_STATIC_DRAW);
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
}

bool ClipmapDrawer::Prepare(const CustomDrawing& drawing) {
  if (!this->VertexArray_) {
    this->Create();
  }
  this->LoadTextures(drawing);
  const Eigen::Vector3d camera =
      drawing.object.X_VO.inverse(Eigen::Affine) * Eigen::Vector3d::Zero();
  const std::size_t index = this->Terrain_->ChartAt(camera);
  std::unique_ptr<Chart>& chart = this->Charts_[index];
  if (!chart) {
    chart = std::make_unique<Chart>(this->Terrain_->Charts()[index], this->Terrain_->Options());
    BindTextureUnit(drawing.window, TerrainUnit, GL_TEXTURE_2D_ARRAY, 0);
    CreateTexture(*chart);
  }
  this->Update(*chart, drawing);
  if (chart->Drawable() || !this->Active_ || !this->Active_->Drawable()) {
    this->Active_ = chart.get();
  } else { // the chart that the camera comes from is shown until some of the other is there
    this->Update(*this->Active_, drawing);
  }
  const bool layers = this->PrepareLayers(drawing);
  return this->Active_ == chart.get() && chart->state.complete && layers;
}

bool ClipmapDrawer::PrepareLayers(const CustomDrawing& drawing) {
  const Chart& chart = *this->Active_;
  if (!chart.Drawable() || drawing.labels) {
    return true;
  }
  const ClipmapCamera camera(drawing.object.X_VO, chart.placement);
  const auto index =
      std::find_if(this->Charts_.begin(), this->Charts_.end(),
                   [this](const auto& other) { return other.get() == this->Active_; });
  return this->Layers_.Prepare(drawing, std::size_t(index - this->Charts_.begin()), chart.levels,
                               chart.state, ViewVolumeOf(camera, drawing.view), chart.heights);
}

// Before any is bound for drawing: an upload ends with its unit unbound.
void ClipmapDrawer::LoadTextures(const CustomDrawing& drawing) const {
  const Material& material = *this->Terrain_->Options().material;
  if (const auto texture = drawing.object.object->material.texture.value_or(material.texture)) {
    drawing.store.TextureOf(texture, material.repeatTexture);
  }
  const ClipmapStyle& style = this->Terrain_->Style();
  for (const ClipmapStyle::Detail& detail : style.details) {
    drawing.store.TextureOf(detail.image, true);
  }
  if (style.ramp && style.ramp->image) {
    drawing.store.TextureOf(style.ramp->image, false);
  }
}

void ClipmapDrawer::Update(Chart& chart, const CustomDrawing& drawing) const {
  const ClipmapCamera camera(drawing.object.X_VO, chart.placement);
  const FocusView focus = FocusViewOf(camera, drawing.view);
  chart.levels.SetNoise(this->Terrain_->Style().noise, chart.placement);
  BindTextureUnit(drawing.window, TerrainUnit, GL_TEXTURE_2D_ARRAY, chart.texture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  // The ground that a zoomed view meets is that which is there: a picture that is kept must not
  // hang on what was drawn before, and brings that around the camera first.
  if (drawing.view.complete || !IsZoomed(focus) || !chart.Drawable()) {
    UpdateAbout(chart, focus.camera, drawing, this->Terrain_->Options().deadline);
  }
  if (IsZoomed(focus) && chart.Drawable()) {
    const Eigen::Vector3d place =
        FocusOf(focus, chart.placement, [&chart](const Eigen::Vector2d& post) {
          return chart.levels.HeightNear(post, chart.state.finest)
              .value_or(chart.state.groundHeight);
        });
    UpdateAbout(chart, place, drawing, this->Terrain_->Options().deadline);
  }
}

void ClipmapDrawer::UpdateAbout(Chart& chart, const Eigen::Vector3d& p_S,
                                const CustomDrawing& drawing, double deadline) {
  const Eigen::Vector3d posts = chart.placement.ToPosts(p_S);
  ClipmapLevels::View view;
  view.place = posts.head<2>();
  view.height = posts.z();
  view.cellSize = CellSizeNear(chart.placement, chart.levels.Lattice(), view.place);
  if (drawing.view.complete) {
    view.wait = deadline;
  }
  chart.state = chart.levels.Update(
      view, [&drawing, &chart](int level, const ClipmapUpdate& u, const ClipmapTexel* texels) {
        for (int i = 0; i < u.width * u.height; ++i) {
          if (texels[i].hole < 1.0f) {
            chart.heights[0] = std::min<double>(chart.heights[0], texels[i].height);
            chart.heights[1] = std::max<double>(chart.heights[1], texels[i].height);
          }
        }
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, u.x, u.y, level, u.width, u.height, 1, GL_RGBA,
                        GL_FLOAT, texels);
        drawing.statistics.textureBytesUploaded +=
            std::uint64_t(u.width) * u.height * sizeof(ClipmapTexel);
      });
}

void ClipmapDrawer::DrawColor(const CustomDrawing& drawing) {
  const GraphicsObject& object = *drawing.object.object;
  const Material& material = *this->Terrain_->Options().material;
  const MaterialOverride& over = object.material;
  unsigned features = 0;
  if (over.lit.value_or(material.lit)) {
    features |= SurfaceShaders::LightFeatures(drawing.list);
    if (over.metallic.value_or(material.metallic) > 0.0 ||
        over.roughness.value_or(material.roughness) < 1.0) {
      features |= SurfaceShaders::Specular;
    }
  }
  if (const auto texture = over.texture.value_or(material.texture)) {
    features |= SurfaceShaders::Texture;
    BindTextureUnit(drawing.window, ColorUnit, GL_TEXTURE_2D,
                    drawing.store.TextureOf(texture, material.repeatTexture));
  }
  const PolygonMode mode(over.wireframe.value_or(false) ? GL_LINE : GL_FILL);
  this->Draw(drawing, features);
}

void ClipmapDrawer::DrawLabels(const CustomDrawing& drawing) {
  this->Draw(drawing, SurfaceShaders::Label);
}

std::vector<Caption> ClipmapDrawer::Captions(const CustomDrawing& drawing,
                                             const RenderTarget& target) {
  const Chart& chart = *this->Active_;
  if (!this->Terrain_->Style().grid || !this->Terrain_->Style().gridLabels || !chart.Drawable()) {
    return {};
  }
  return GridCaptions(drawing, target, *this->Terrain_, chart.placement, chart.levels, chart.state);
}

void ClipmapDrawer::Draw(const CustomDrawing& drawing, unsigned features) {
  const Chart& chart = *this->Active_;
  const ClipmapCamera camera(drawing.object.X_VO, chart.placement);
  const bool labels = (features & SurfaceShaders::Label) != 0;
  const ClipmapStyle& style = this->Terrain_->Style();
  const bool pole = chart.placement.GetKind() == PostPlacement::Kind::Pole;
  // Longitude jumps within a triangle at a pole: there the texture's place is found a pixel.
  const bool poleTexture = pole && (features & SurfaceShaders::Texture) != 0;
  bool tracks = false; // what mixes colours costs time elsewhere
  for (int level = chart.state.finest; level < chart.levels.Count(); ++level) {
    tracks |= !labels && chart.levels.HasTracks(level);
  }
  const bool layers = !labels && this->Layers_.Shown();
  const bool mixed = !labels && (poleTexture || tracks || layers || !style.Empty());
  ShaderPages pages;
  pages.vertex = ClipmapVertexShader(chart.placement.GetKind());
  pages.defines = ClipmapUniforms::Defines(chart.placement, mixed ? &style : nullptr);
  for (int level = chart.state.finest; level < chart.levels.Count(); ++level) {
    if (chart.levels.HasHoles(level)) { // what discards pixels costs time elsewhere
      pages.defines += "#define DSPACE_HOLES\n";
      break;
    }
  }
  if (tracks) {
    pages.defines += "#define DSPACE_TRACKS\n";
  }
  if (layers) {
    pages.defines += "#define DSPACE_LAYERS\n";
  }
  if (mixed) {
    features |= SurfaceShaders::Mixed;
    pages.fragment = ClipmapFragmentFunctions();
  }
  if (poleTexture) {
    features &= ~unsigned(SurfaceShaders::Texture);
    pages.defines += "#define DSPACE_POLE_TEXTURE\n";
  }
  vtkShaderProgram* program = drawing.shaders.Surface(features, pages);
  drawing.shaders.SetView(program, drawing.list, drawing.view, drawing.samples);
  BindTextureUnit(drawing.window, TerrainUnit, GL_TEXTURE_2D_ARRAY, chart.texture);
  program->SetUniformi("posts", TerrainUnit);
  const ClipmapUniforms uniforms(program, *this->Terrain_, chart.placement, chart.levels,
                                 chart.state, camera);
  if (labels) {
    program->SetUniformi("objectLabel", int(drawing.object.object->id));
  } else {
    uniforms.SetLook(*drawing.object.object);
  }
  if (mixed) {
    uniforms.SetStyle(drawing);
  }
  uniforms.SetPlacement();
  if (layers) {
    this->Layers_.SetLook(program, drawing.samples);
  }

  vtkOpenGLState* state = drawing.window->GetState();
  if (camera.posts.z() > chart.levels.HeightNear(camera.posts.head<2>(), chart.state.finest)
                             .value_or(chart.state.groundHeight)) {
    // From above no under side is seen but by rounding, at ridges.
    state->vtkglEnable(GL_CULL_FACE);
    state->vtkglCullFace(camera.mirrored > 0.0f ? GL_BACK : GL_FRONT);
  }
  const ClipmapBlocks blocks(chart.levels, chart.placement, chart.heights);
  const ClipmapViewVolume sight = ViewVolumeOf(camera, drawing.view);
  std::vector<GLsizei> counts;
  std::vector<const void*> firsts;
  glBindVertexArray(this->VertexArray_);
  for (int level = chart.state.finest; level < chart.levels.Count(); ++level) {
    counts.clear();
    firsts.clear();
    for (const ClipmapIndices::Run& run :
         blocks.Seen(this->Indices_, sight, level, chart.state.finest)) {
      counts.push_back(GLsizei(run.count));
      firsts.push_back(reinterpret_cast<const void*>(run.first * sizeof(std::uint16_t)));
      drawing.statistics.trianglesDrawn += run.count / 3;
    }
    if (counts.empty()) {
      continue;
    }
    uniforms.SetLevel(level);
    if (layers) {
      const ClipmapWindow& window = chart.levels.Window(level);
      const Eigen::Vector2d first(double(window.column), double(window.row));
      this->Layers_.SetLevel(program, first, std::ldexp(1.0, level));
    }
    glMultiDrawElements(GL_TRIANGLES, counts.data(), GL_UNSIGNED_SHORT, firsts.data(),
                        GLsizei(counts.size()));
    ++drawing.statistics.drawCalls;
  }
  glBindVertexArray(0);
  state->vtkglDisable(GL_CULL_FACE);
  state->vtkglCullFace(GL_BACK);
}

} // namespace dspace
