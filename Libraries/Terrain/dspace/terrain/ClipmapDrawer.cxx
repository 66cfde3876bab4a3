#include <dspace/terrain/ClipmapDrawer.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <typeindex>

#include "vtk_glew.h"

#include "ClipmapColor_frag.h"
#include "Clipmap_vert.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/render/Capture.h>
#include <dspace/render/GpuStore.h>
#include <dspace/render/SurfaceShaders.h>

namespace dspace {

void RegisterClipmapDrawer() {
  RegisterCustomDrawer(
      typeid(ClipmapTerrain),
      [](std::shared_ptr<const CustomGeometry> geometry) -> std::unique_ptr<CustomDrawer> {
        return std::make_unique<ClipmapDrawer>(
            std::static_pointer_cast<const ClipmapTerrain>(std::move(geometry)));
      });
}

struct ClipmapDrawer::Placed {
  Eigen::Affine3d X_VS;   // view axes from the terrain's frame
  Eigen::Vector3d camera; // in the terrain's frame
  Eigen::Vector3d posts;  // of the camera: column, row, height
  double cellSize;        // [m] of a level-0 cell below it
  float mirrored;         // 1 where triangles turn counter-clockwise seen from above
};

namespace {

std::array<float, 3> Floats(const Eigen::Vector3d& v) {
  return {float(v.x()), float(v.y()), float(v.z())};
}

void SetVector(vtkShaderProgram* program, const char* name, const Eigen::Vector3d& v) {
  program->SetUniform3f(name, Floats(v).data());
}

void SetVector(vtkShaderProgram* program, const char* name, const Eigen::Vector2d& v) {
  const float values[2] = {float(v.x()), float(v.y())};
  program->SetUniform2f(name, values);
}

void SetMatrix(vtkShaderProgram* program, const char* name, const Eigen::Matrix2d& m) {
  const float columns[4] = {float(m(0, 0)), float(m(1, 0)), float(m(0, 1)), float(m(1, 1))};
  glUniformMatrix2fv(program->FindUniform(name), 1, GL_FALSE, columns);
}

void SetLine(vtkShaderProgram* program, const char* name, const ClipmapStyle::Lines& lines) {
  const float color[4] = {LinearFromSrgb(lines.color[0]), LinearFromSrgb(lines.color[1]),
                          LinearFromSrgb(lines.color[2]), float(lines.opacity)};
  program->SetUniform4f(name, color);
}

void SetStyle(vtkShaderProgram* program, const ClipmapStyle& style, const CustomDrawing& drawing) {
  const double pixels = 0.5 * drawing.samples; // of a line's half, in samples
  if (style.ramp) {
    const auto [low, high] = style.ramp->range;
    const float ramp[4] = {float(low), float(1.0 / (high - low)), float(style.ramp->opacity),
                           style.ramp->by == ClipmapStyle::Ramp::By::Height ? 0.0f : 1.0f};
    program->SetUniform4f("ramp", ramp);
    BindTextureUnit(drawing.window, TerrainUnit + 1, GL_TEXTURE_2D,
                    drawing.store.TextureOf(style.ramp->image, false));
    program->SetUniformi("rampTexture", TerrainUnit + 1);
  }
  if (style.levels) {
    program->SetUniformf("levelOpacity", float(*style.levels));
  }
  if (style.contours) {
    SetVector(program, "contours",
              Eigen::Vector2d(1.0 / style.contours->interval, pixels * style.contours->width));
    SetLine(program, "contourColor", *style.contours);
  }
  if (style.grid) {
    program->SetUniformf("gridWidth", float(pixels * style.grid->width));
    SetLine(program, "gridColor", *style.grid);
  }
}

// GLSL 330 has no call for an integer vector in VTK's program class.
void SetTexel(vtkShaderProgram* program, const char* name, int x, int y) {
  const int values[2] = {x, y};
  program->SetUniform2i(name, values);
}

} // namespace

ClipmapDrawer::ClipmapDrawer(std::shared_ptr<const ClipmapTerrain> terrain)
    : Terrain_(std::move(terrain)), Levels_(Terrain_->Pyramid(), Terrain_->Options().cells),
      Indices_(Terrain_->Options().cells) {}

ClipmapDrawer::~ClipmapDrawer() {
  if (this->Texture_) {
    glDeleteTextures(1, &this->Texture_);
    glDeleteVertexArrays(1, &this->VertexArray_);
    glDeleteBuffers(1, &this->VertexBuffer_);
    glDeleteBuffers(1, &this->IndexBuffer_);
  }
}

ClipmapDrawer::Placed ClipmapDrawer::Place(const CustomDrawing& drawing) const {
  Placed placed;
  const PostPlacement& placement = this->Terrain_->Placement();
  placed.X_VS = drawing.object.X_VO;
  placed.camera = placed.X_VS.inverse(Eigen::Affine) * Eigen::Vector3d::Zero();
  placed.posts = placement.ToPosts(placed.camera);
  const Eigen::Vector2d within = placed.posts.head<2>().cwiseMax(0.0).cwiseMin(Eigen::Vector2d(
      double(this->Levels_.Lattice().columns), double(this->Levels_.Lattice().rows)));
  placed.cellSize = placement.CellSize(within);
  const bool downwards = placement.GetKind() == PostPlacement::Kind::Plane
                             ? placement.PostToScene().linear().determinant() < 0.0
                             : placement.Step().x() * placement.Step().y() < 0.0;
  placed.mirrored =
      (downwards ? 1.0f : -1.0f) * (placed.X_VS.linear().determinant() < 0.0 ? -1.0f : 1.0f);
  return placed;
}

void ClipmapDrawer::Create() {
  const int side = this->Levels_.Geometry().Texels();
  const int posts = this->Levels_.Geometry().Cells() + 1;
  glGenTextures(1, &this->Texture_);
  glBindTexture(GL_TEXTURE_2D_ARRAY, this->Texture_);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RGBA32F, side, side, this->Levels_.Count(), 0, GL_RGBA,
               GL_FLOAT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
  }
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
  const Placed placed = this->Place(drawing);
  if (!this->Texture_) {
    this->Create();
  }
  BindTextureUnit(drawing.window, TerrainUnit, GL_TEXTURE_2D_ARRAY, this->Texture_);
  ClipmapLevels::View view;
  view.place = placed.posts.head<2>();
  view.height = placed.posts.z();
  view.cellSize = placed.cellSize;
  if (drawing.view.complete) {
    view.wait = this->Terrain_->Options().deadline;
  }
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  this->State_ = this->Levels_.Update(
      view, [&drawing](int level, const ClipmapUpdate& u, const ClipmapTexel* texels) {
        glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, u.x, u.y, level, u.width, u.height, 1, GL_RGBA,
                        GL_FLOAT, texels);
        drawing.statistics.textureBytesUploaded +=
            std::uint64_t(u.width) * u.height * sizeof(ClipmapTexel);
      });
  return this->State_.complete;
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
  const bool wireframe = over.wireframe.value_or(false);
  glPolygonMode(GL_FRONT_AND_BACK, wireframe ? GL_LINE : GL_FILL);
  this->Draw(drawing, features);
  glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
}

void ClipmapDrawer::DrawLabels(const CustomDrawing& drawing) {
  this->Draw(drawing, SurfaceShaders::Label);
}

// Uniforms of one level.
void ClipmapDrawer::SetLevel(vtkShaderProgram* program, const Placed& placed, int level,
                             bool sphere) const {
  const ClipmapGeometry& geometry = this->Levels_.Geometry();
  const PostLattice& lattice = this->Levels_.Lattice();
  const PostPlacement& placement = this->Terrain_->Placement();
  const ClipmapWindow& window = this->Levels_.Window(level);
  const double step = std::ldexp(1.0, level);
  const Eigen::Vector2d first(double(window.column), double(window.row)); // posts of the level
  const Eigen::Vector2d camera = this->State_.place / step - first;
  SetTexel(program, "windowTexel", geometry.Texel(window.column), geometry.Texel(window.row));
  SetTexel(program, "coarseTexel", geometry.Texel(window.column / 2),
           geometry.Texel(window.row / 2));
  program->SetUniformi("level", level);
  SetVector(program, "cameraPost", camera);

  Eigen::Vector2d firstPost = -first;
  Eigen::Vector2d lastPost =
      Eigen::Vector2d(double(lattice.ColumnsAt(level) - 1), double(lattice.RowsAt(level) - 1)) -
      first;
  Eigen::Vector2d lastPlace =
      Eigen::Vector2d(double(lattice.columns - 1), double(lattice.rows - 1)) / step - first;
  if (lattice.periodic) { // once around, half to either side of the camera
    const auto around = double(lattice.ColumnsAt(level));
    firstPost.x() = std::floor(camera.x() - 0.5 * around);
    lastPost.x() = firstPost.x() + around;
    lastPlace.x() = lastPost.x();
  }
  const auto cells = double(geometry.Cells());
  SetVector(program, "firstPost", Eigen::Vector2d(firstPost.cwiseMax(0.0).cwiseMin(cells)));
  SetVector(program, "lastPost", Eigen::Vector2d(lastPost.cwiseMax(0.0).cwiseMin(cells)));
  // Far beyond the window where it does not matter: a float must hold it.
  SetVector(program, "lastPlace", Eigen::Vector2d(lastPlace.cwiseMax(0.0).cwiseMin(cells)));

  const bool coarsest = level == this->Levels_.Count() - 1;
  const Eigen::Vector3d blend(
      coarsest ? 1e30 : geometry.BlendFrom(), 1.0 / (geometry.BlendTo() - geometry.BlendFrom()),
      ClipmapLevels::InPosts(this->State_.distance, placed.cellSize, level));
  SetVector(program, "blend", blend);

  if (sphere) {
    const Eigen::Vector2d angles =
        (first * step - this->State_.place).cwiseProduct(placement.Step());
    const Eigen::Vector2d apart = // the camera may stand outside the lattice's rows
        (this->State_.place - placed.posts.head<2>()).cwiseProduct(placement.Step());
    SetVector(
        program, "originAngles",
        Eigen::Vector2d(angles.x() + (lattice.periodic ? 0.0 : apart.x()), angles.y() + apart.y()));
    SetVector(program, "stepAngles", Eigen::Vector2d(placement.Step() * step));
  } else {
    const Eigen::Matrix2d& linear = placement.PostToScene().linear();
    const Eigen::Vector2d offset = linear * (first * step - placed.posts.head<2>());
    const Eigen::Matrix3d& L = placed.X_VS.linear();
    SetVector(program, "originVC", Eigen::Vector3d(L.leftCols<2>() * offset));
    SetVector(program, "columnVC", Eigen::Vector3d(L.leftCols<2>() * (linear.col(0) * step)));
    SetVector(program, "rowVC", Eigen::Vector3d(L.leftCols<2>() * (linear.col(1) * step)));
  }
  if (program->IsUniformUsed("postGrid")) {
    this->SetGrid(program, first * step, step);
  }
  if (program->IsUniformUsed("postTexture")) {
    const Eigen::Affine2d& map = this->Terrain_->Options().postToTexture;
    // Whole turns are nothing to a texture that repeats, but much to a float.
    Eigen::Vector2d origin = map * Eigen::Vector2d(first * step);
    if (lattice.periodic) {
      origin.x() -= std::floor(origin.x());
    }
    SetVector(program, "originTexture", origin);
    SetMatrix(program, "postTexture", map.linear() * step);
  }
}

// Grid lines, counted from one near the camera: a float holds what is near it well.
void ClipmapDrawer::SetGrid(vtkShaderProgram* program, const Eigen::Vector2d& firstPost,
                            double step) const {
  const PostPlacement& placement = this->Terrain_->Placement();
  Eigen::Affine2d lines = this->Terrain_->Options().postToMap;
  if (placement.GetKind() == PostPlacement::Kind::Sphere) {
    lines.linear() = Eigen::Vector2d(placement.Step() * (180.0 / M_PI)).asDiagonal();
    lines.translation() = placement.First() * (180.0 / M_PI);
  }
  const double interval =
      this->Terrain_->Style().grid ? this->Terrain_->Style().grid->interval : 1.0;
  lines = Eigen::Scaling(1.0 / interval) * lines;
  const Eigen::Vector2d camera = (lines * this->State_.place).array().floor();
  SetVector(program, "originGrid", Eigen::Vector2d(lines * firstPost - camera));
  SetMatrix(program, "postGrid", lines.linear() * step);
}

// Planes of the view volume in the terrain's frame; a block outside any of them is left out.
namespace {

std::vector<Eigen::Vector4d> PlanesIn(const Eigen::Affine3d& X_VS, const DrawView& view) {
  const Eigen::Matrix4d clip =
      view.projection.ClipFromView(view.width, view.height) * X_VS.matrix();
  std::vector<Eigen::Vector4d> planes;
  for (const int axis : {0, 1}) {
    for (const double sign : {1.0, -1.0}) {
      planes.emplace_back(clip.row(3) + sign * clip.row(axis));
    }
  }
  planes.emplace_back(clip.row(3) - clip.row(2)); // near; depth is reversed
  return planes;
}

} // namespace

// Of a block's cells, in level-0 posts of the lattice.
Eigen::AlignedBox2d ClipmapDrawer::BlockPosts(int level, int column, int row) const {
  const ClipmapWindow& window = this->Levels_.Window(level);
  const int cells = this->Levels_.Geometry().Cells();
  const double step = std::ldexp(1.0, level);
  const auto post = [&](std::int64_t first, int block) {
    return double(first + std::min(block * ClipmapIndices::BlockCells, cells)) * step;
  };
  Eigen::AlignedBox2d box(
      Eigen::Vector2d(post(window.column, column), post(window.row, row)),
      Eigen::Vector2d(post(window.column, column + 1), post(window.row, row + 1)));
  const double last = double(this->Levels_.Lattice().rows - 1);
  box.min().y() = std::clamp(box.min().y(), 0.0, last);
  box.max().y() = std::clamp(box.max().y(), 0.0, last);
  return box;
}

// The hull of its corners at the least and the greatest height.
bool ClipmapDrawer::OutsideOnPlane(const std::vector<Eigen::Vector4d>& planes,
                                   const Eigen::AlignedBox2d& block) const {
  Eigen::Matrix<double, 4, 8> corners;
  for (int i = 0; i < 4; ++i) {
    for (const int j : {0, 1}) {
      corners.col(2 * i + j) = this->Terrain_->Placement()
                                   .ToScene(block.corner(Eigen::AlignedBox2d::CornerType(i)),
                                            this->Terrain_->Options().heights[j])
                                   .homogeneous();
    }
  }
  return std::any_of(planes.begin(), planes.end(), [&corners](const Eigen::Vector4d& plane) {
    return (plane.transpose() * corners).maxCoeff() < 0.0;
  });
}

// A ball about the block, or the horizon before it.
bool ClipmapDrawer::HiddenOnBody(const Placed& placed, const std::vector<Eigen::Vector4d>& planes,
                                 const Eigen::AlignedBox2d& block) const {
  const PostPlacement& placement = this->Terrain_->Placement();
  const std::array<double, 2>& heights = this->Terrain_->Options().heights;
  const double middle = 0.5 * (heights[0] + heights[1]);
  const Eigen::Vector3d center = placement.ToScene(block.center(), middle);
  // No two places of it are further apart along the body than its two sides together.
  const double angle = 0.5 * block.sizes().cwiseProduct(placement.Step().cwiseAbs()).sum();
  const double radius = (placement.Radius() + heights[1]) * angle + 0.5 * (heights[1] - heights[0]);
  for (const Eigen::Vector4d& plane : planes) {
    if (plane.head<3>().dot(center) + plane[3] < -radius * plane.head<3>().norm()) {
      return true;
    }
  }
  const double least = placement.Radius() + heights[0];
  const double seen = std::acos(least / std::max(placed.camera.norm(), least)) +
                      std::acos(least / std::max(placement.Radius() + heights[1], least));
  const double apart =
      std::acos(std::clamp(center.normalized().dot(placed.camera.normalized()), -1.0, 1.0));
  return apart - angle > seen;
}

void ClipmapDrawer::ChooseBlocks(const Placed& placed, const std::vector<Eigen::Vector4d>& planes,
                                 int level, std::vector<ClipmapIndices::Run>& runs) const {
  const ClipmapGeometry& geometry = this->Levels_.Geometry();
  const PostPlacement& placement = this->Terrain_->Placement();
  const ClipmapWindow& window = this->Levels_.Window(level);
  const double step = std::ldexp(1.0, level);
  std::optional<Eigen::Vector2i> inner;
  if (level > this->State_.finest) {
    inner = geometry.InnerCell(this->Levels_.Window(level - 1), window);
  }
  const bool sphere = placement.GetKind() == PostPlacement::Kind::Sphere;
  const double blockAngle =
      sphere ? placement.Step().cwiseAbs().maxCoeff() * step * ClipmapIndices::BlockCells : 0.0;
  runs.clear();
  for (int row = 0; row < this->Indices_.BlocksAcross(); ++row) {
    for (int column = 0; column < this->Indices_.BlocksAcross(); ++column) {
      const ClipmapIndices::Run run = this->Indices_.Block(inner, column, row);
      if (run.count == 0) {
        continue;
      }
      const Eigen::AlignedBox2d block = this->BlockPosts(level, column, row);
      const bool outside = sphere ? blockAngle < 0.5 && this->HiddenOnBody(placed, planes, block)
                                  : this->OutsideOnPlane(planes, block);
      if (outside) {
        continue;
      }
      if (!runs.empty() && runs.back().first + runs.back().count == run.first) {
        runs.back().count += run.count;
      } else {
        runs.push_back(run);
      }
    }
  }
}

void ClipmapDrawer::Draw(const CustomDrawing& drawing, unsigned features) {
  const Placed placed = this->Place(drawing);
  const PostPlacement& placement = this->Terrain_->Placement();
  const GraphicsObject& object = *drawing.object.object;
  const bool sphere = placement.GetKind() == PostPlacement::Kind::Sphere;
  ShaderPages pages;
  pages.vertex = Clipmap_vert;
  for (int level = this->State_.finest; level < this->Levels_.Count(); ++level) {
    if (this->Levels_.HasHoles(level)) { // what discards pixels costs time elsewhere
      pages.defines = "#define DSPACE_HOLES\n";
    }
  }
  if (sphere) {
    pages.defines += "#define DSPACE_SPHERE\n";
  }
  const ClipmapStyle& style = this->Terrain_->Style();
  const bool styled = !(features & SurfaceShaders::Label) && !style.Empty();
  if (styled) {
    features |= SurfaceShaders::Mixed;
    pages.fragment = ClipmapColor_frag;
    pages.defines += style.ramp ? "#define DSPACE_RAMP\n" : "";
    pages.defines += style.levels ? "#define DSPACE_LEVELS\n" : "";
    pages.defines += style.contours ? "#define DSPACE_CONTOURS\n" : "";
    pages.defines += style.grid ? "#define DSPACE_GRID\n" : "";
  }
  vtkShaderProgram* program = drawing.shaders.Surface(features, pages);
  drawing.shaders.SetView(program, drawing.list, drawing.view, drawing.samples);
  BindTextureUnit(drawing.window, TerrainUnit, GL_TEXTURE_2D_ARRAY, this->Texture_);
  program->SetUniformi("posts", TerrainUnit);
  program->SetUniformi("texelMask", this->Levels_.Geometry().Texels() - 1);
  if (features & SurfaceShaders::Label) {
    program->SetUniformi("objectLabel", int(object.id));
  } else {
    const Material& material = *this->Terrain_->Options().material;
    const MaterialOverride& over = object.material;
    const std::array<double, 3> color = over.color.value_or(material.color);
    const float linear[4] = {LinearFromSrgb(color[0]), LinearFromSrgb(color[1]),
                             LinearFromSrgb(color[2]), 1.0f};
    program->SetUniform4f("objectColor", linear);
    const float surface[3] = {float(over.metallic.value_or(material.metallic)),
                              float(over.roughness.value_or(material.roughness)), placed.mirrored};
    program->SetUniform3f("objectSurface", surface);
  }
  if (styled) {
    SetStyle(program, style, drawing);
  }
  const double cameraHeight = placed.posts.z();
  const auto high = static_cast<float>(cameraHeight);
  program->SetUniformf("heightHigh", high);
  program->SetUniformf("heightLow", static_cast<float>(cameraHeight - double(high)));
  const Eigen::Matrix3d& L = placed.X_VS.linear();
  if (sphere) {
    const double longitude = placement.First().x() + placed.posts.x() * placement.Step().x();
    const double latitude = placement.First().y() + placed.posts.y() * placement.Step().y();
    const double sl = std::sin(longitude), cl = std::cos(longitude);
    const double sp = std::sin(latitude), cp = std::cos(latitude);
    SetVector(program, "eastVC", Eigen::Vector3d(L * Eigen::Vector3d(-sl, cl, 0.0)));
    SetVector(program, "northVC", Eigen::Vector3d(L * Eigen::Vector3d(-sp * cl, -sp * sl, cp)));
    SetVector(program, "upVC", Eigen::Vector3d(L * Eigen::Vector3d(cp * cl, cp * sl, sp)));
    SetVector(program, "stepBase", placement.Step());
    SetVector(program, "cameraLatitude", Eigen::Vector2d(sp, cp));
    program->SetUniformf("cameraLatitudeAngle", float(latitude));
    program->SetUniformf("radius", float(placement.Radius()));
  } else {
    const Eigen::Matrix3d N = L.inverse().transpose(); // carries normals
    const Eigen::Matrix2d dual = placement.PostToScene().linear().inverse().transpose();
    SetVector(program, "upVC", Eigen::Vector3d(L.col(2)));
    SetVector(program, "upNormalVC", Eigen::Vector3d(N.col(2)));
    SetVector(program, "slopeColumnVC", Eigen::Vector3d(N.leftCols<2>() * dual.col(0)));
    SetVector(program, "slopeRowVC", Eigen::Vector3d(N.leftCols<2>() * dual.col(1)));
  }
  // From above no under side is seen but by rounding, at ridges.
  vtkOpenGLState* state = drawing.window->GetState();
  const bool above = cameraHeight > this->State_.groundHeight;
  if (above) {
    state->vtkglEnable(GL_CULL_FACE);
    state->vtkglCullFace(placed.mirrored > 0.0f ? GL_BACK : GL_FRONT);
  }
  const std::vector<Eigen::Vector4d> planes = PlanesIn(placed.X_VS, drawing.view);
  std::vector<ClipmapIndices::Run> runs;
  std::vector<GLsizei> counts;
  std::vector<const void*> firsts;
  glBindVertexArray(this->VertexArray_);
  for (int level = this->State_.finest; level < this->Levels_.Count(); ++level) {
    this->ChooseBlocks(placed, planes, level, runs);
    if (runs.empty()) {
      continue;
    }
    this->SetLevel(program, placed, level, sphere);
    counts.clear();
    firsts.clear();
    for (const ClipmapIndices::Run& run : runs) {
      counts.push_back(GLsizei(run.count));
      firsts.push_back(reinterpret_cast<const void*>(run.first * sizeof(std::uint16_t)));
      drawing.statistics.trianglesDrawn += run.count / 3;
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
