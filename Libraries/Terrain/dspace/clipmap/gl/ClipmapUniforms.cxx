#include <dspace/clipmap/gl/ClipmapUniforms.h>

#include <algorithm>
#include <cmath>

#include "vtk_glew.h"

#include "vtkShaderProgram.h"

#include <dspace/render/GpuStore.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/scene/bodies/CelestialBody.h>

namespace dspace {
namespace {

constexpr double Degrees = 180.0 / M_PI;

void Set(vtkShaderProgram* program, const char* name, const Eigen::Vector3d& v) {
  const float values[3] = {float(v.x()), float(v.y()), float(v.z())};
  program->SetUniform3f(name, values);
}

void Set(vtkShaderProgram* program, const char* name, const Eigen::Vector2d& v) {
  const float values[2] = {float(v.x()), float(v.y())};
  program->SetUniform2f(name, values);
}

void Set(vtkShaderProgram* program, const char* name, const Eigen::Matrix2d& m) {
  const float columns[4] = {float(m(0, 0)), float(m(1, 0)), float(m(0, 1)), float(m(1, 1))};
  glUniformMatrix2fv(program->FindUniform(name), 1, GL_FALSE, columns);
}

void SetTexel(vtkShaderProgram* program, const char* name, int x, int y) {
  const int values[2] = {x, y};
  program->SetUniform2i(name, values);
}

void SetLineColor(vtkShaderProgram* program, const char* name, const ClipmapStyle::Lines& lines) {
  const float color[4] = {LinearFromSrgb(lines.color[0]), LinearFromSrgb(lines.color[1]),
                          LinearFromSrgb(lines.color[2]), float(lines.opacity)};
  program->SetUniform4f(name, color);
}

} // namespace

double CellSizeNear(const PostPlacement& placement, const PostLattice& lattice,
                    const Eigen::Vector2d& post) {
  return placement.CellSize(
      post.cwiseMax(0.0).cwiseMin(Eigen::Vector2d(double(lattice.columns), double(lattice.rows))));
}

ClipmapCamera::ClipmapCamera(const Eigen::Affine3d& viewFromTerrain, const PostPlacement& placement)
    : X_VS(viewFromTerrain),
      position(viewFromTerrain.inverse(Eigen::Affine) * Eigen::Vector3d::Zero()),
      posts(placement.ToPosts(this->position)) {
  double turn = -1.0; // of columns to rows, seen from above
  if (placement.GetKind() == PostPlacement::Kind::Plane) {
    turn = placement.PostToScene().linear().determinant();
  } else if (placement.GetKind() == PostPlacement::Kind::Sphere) {
    turn = placement.Step().x() * placement.Step().y();
  }
  this->mirrored = (turn < 0.0) == (viewFromTerrain.linear().determinant() > 0.0) ? 1.0f : -1.0f;
}

std::string ClipmapUniforms::Defines(const PostPlacement& placement, const ClipmapStyle* style) {
  std::string defines;
  if (placement.GetKind() == PostPlacement::Kind::Pole) {
    defines += "#define DSPACE_POLE\n";
  }
  if (placement.OnBody() && !placement.Body().Spherical()) {
    defines += "#define DSPACE_ELLIPSOID\n";
  }
  if (style) {
    if (!style->details.empty() && placement.GetKind() == PostPlacement::Kind::Plane) {
      defines += "#define DSPACE_DETAILS " + std::to_string(style->details.size()) + "\n";
    }
    if (style->ramp) {
      const char* const by[] = {"", "", "#define DSPACE_FACING\n#define DSPACE_BY_ASPECT\n",
                                "#define DSPACE_FACING\n#define DSPACE_BY_NORMAL\n"};
      defines += std::string("#define DSPACE_RAMP\n") + by[int(style->ramp->by)];
      defines += style->ramp->shaded ? "" : "#define DSPACE_UNSHADED\n";
    }
    defines += style->levels ? "#define DSPACE_LEVELS\n" : "";
    defines += style->contours ? "#define DSPACE_CONTOURS\n" : "";
    defines += style->grid ? "#define DSPACE_GRID\n" : "";
  }
  return defines;
}

Reflectance ReflectanceOf(const DrawCustom& drawn, const Material& material) {
  const auto& own = drawn.object->material.reflectance;
  if (own || !drawn.body) {
    return own.value_or(material.reflectance);
  }
  return drawn.body->material.reflectance.value_or(material.reflectance);
}

double BrightnessOf(const DrawCustom& drawn) {
  return drawn.body ? static_cast<const CelestialBody&>(*drawn.body->custom).Shape().brightness
                    : 1.0;
}

void ClipmapUniforms::SetLook(const DrawCustom& drawn, SurfaceShaders::Features features) const {
  const Material& material = *this->Terrain_.Options().material;
  const MaterialOverride& over = drawn.object->material;
  const std::array<double, 3> color = over.color.value_or(material.color);
  const float linear[4] = {LinearFromSrgb(color[0]), LinearFromSrgb(color[1]),
                           LinearFromSrgb(color[2]), 1.0f};
  this->Program_->SetUniform4f("objectColor", linear);
  const float surface[3] = {float(over.metallic.value_or(material.metallic)),
                            float(over.roughness.value_or(material.roughness)),
                            this->Camera_.mirrored};
  this->Program_->SetUniform3f("objectSurface", surface);
  if (this->Program_->IsUniformUsed("groundBrightness")) {
    this->Program_->SetUniformf("groundBrightness", float(BrightnessOf(drawn)));
  }
  const Reflectance reflectance = ReflectanceOf(drawn, material);
  if (features & SurfaceShaders::ReflectanceFeature(reflectance)) {
    SurfaceShaders::SetReflectance(this->Program_, reflectance);
  }
}

void ClipmapUniforms::SetDetails(const CustomDrawing& drawing) const {
  const std::vector<ClipmapStyle::Detail>& details = this->Style_.details;
  float look[4] = {0, 0, 0, 0};
  for (std::size_t k = 0; k < details.size(); ++k) {
    const ClipmapStyle::Detail& detail = details[k];
    const std::string number = std::to_string(k);
    // Units of peeling, which has not begun.
    const int unit = k == 0 ? OpaqueDepthUnit : PeeledDepthUnit;
    BindTextureUnit(drawing.window, unit, GL_TEXTURE_2D,
                    drawing.store.TextureOf(detail.image, true));
    this->Program_->SetUniformi(("detailTexture" + number).c_str(), unit);
    Set(this->Program_, ("detailMean" + number).c_str(), detail.mean);
    const float range[4] = {float(detail.slopes[0]), float(detail.slopes[1]),
                            float(detail.heights[0]), float(detail.heights[1])};
    this->Program_->SetUniform4f(("detailRange" + number).c_str(), range);
    look[k] = float(detail.opacity);
    look[2 + k] = float(0.02 * (detail.heights[1] - detail.heights[0]));
  }
  this->Program_->SetUniform4f("detailLook", look);
}

void ClipmapUniforms::SetStyle(const CustomDrawing& drawing) const {
  const ClipmapStyle& style = this->Style_;
  vtkShaderProgram* program = this->Program_;
  if (program->IsUniformUsed("detailLook")) {
    this->SetDetails(drawing);
  }
  const double pixels = 0.5 * drawing.samples; // of a line's half, in samples
  if (style.ramp) {
    const auto [low, high] = style.ramp->range;
    const float ramp[4] = {float(low), float(1.0 / (high - low)), float(style.ramp->opacity),
                           style.ramp->by == ClipmapStyle::Ramp::By::Height ? 0.0f : 1.0f};
    program->SetUniform4f("ramp", ramp);
    if (style.ramp->image) {
      BindTextureUnit(drawing.window, TerrainUnit + 1, GL_TEXTURE_2D,
                      drawing.store.TextureOf(style.ramp->image, false));
      program->SetUniformi("rampTexture", TerrainUnit + 1);
    }
  }
  if (program->IsUniformUsed("trackColor")) {
    const ClipmapStyle::Tracks& tracks = style.tracks;
    const float color[4] = {LinearFromSrgb(tracks.color[0]), LinearFromSrgb(tracks.color[1]),
                            LinearFromSrgb(tracks.color[2]), float(tracks.opacity)};
    program->SetUniform4f("trackColor", color);
  }
  if (style.levels) {
    program->SetUniformf("levelOpacity", float(*style.levels));
  }
  if (style.contours) {
    Set(program, "contours",
        Eigen::Vector2d(1.0 / style.contours->interval, pixels * style.contours->width));
    SetLineColor(program, "contourColor", *style.contours);
  }
  if (style.grid) {
    program->SetUniformf("gridWidth", float(pixels * style.grid->width));
    SetLineColor(program, "gridColor", *style.grid);
    if (program->IsUniformUsed("gridInterval")) {
      program->SetUniformf("gridInterval", float(style.grid->interval));
    }
  }
}

void ClipmapUniforms::SetPlacement() const {
  vtkShaderProgram* program = this->Program_;
  const PostPlacement& placement = this->Placement_;
  const Eigen::Vector3d& posts = this->Camera_.posts;
  const auto high = static_cast<float>(posts.z());
  program->SetUniformf("heightHigh", high);
  program->SetUniformf("heightLow", static_cast<float>(posts.z() - double(high)));
  program->SetUniformi("texelMask", this->Levels_.Geometry().Texels() - 1);
  const Eigen::Matrix3d& L = this->Camera_.X_VS.linear();
  if (placement.GetKind() == PostPlacement::Kind::Plane) {
    const Eigen::Matrix3d N = L.inverse().transpose(); // carries normals
    const Eigen::Matrix2d dual = placement.PostToScene().linear().inverse().transpose();
    Set(program, "upVC", Eigen::Vector3d(L.col(2)));
    if (program->IsUniformUsed("normalsVC")) {
      const Eigen::Matrix3f normals = N.cast<float>(); // column-major, as OpenGL reads it
      glUniformMatrix3fv(program->FindUniform("normalsVC"), 1, GL_FALSE, normals.data());
    }
    Set(program, "upNormalVC", Eigen::Vector3d(N.col(2)));
    Set(program, "slopeColumnVC", Eigen::Vector3d(N.leftCols<2>() * dual.col(0)));
    Set(program, "slopeRowVC", Eigen::Vector3d(N.leftCols<2>() * dual.col(1)));
    Set(program, "slopePlane", dual); // where it is used
    return;
  }
  const Eigen::Vector2d angles = placement.Angles(posts.head<2>());
  const double sl = std::sin(angles.x()), cl = std::cos(angles.x());
  const double sp = std::sin(angles.y()), cp = std::cos(angles.y());
  const BodyEllipsoid& body = placement.Body();
  if (body.Spherical()) {
    program->SetUniformf("radius", float(placement.Radius()));
  } else {
    Set(program, "ellipsoid", Eigen::Vector3d(body.Equatorial(), body.Squash(), sp));
    Set(program, "axisVC", Eigen::Vector3d(L.col(2)));
  }
  Set(program, "upVC", Eigen::Vector3d(L * Eigen::Vector3d(cp * cl, cp * sl, sp)));
  if (placement.GetKind() == PostPlacement::Kind::Sphere) {
    Set(program, "eastVC", Eigen::Vector3d(L * Eigen::Vector3d(-sl, cl, 0.0)));
    Set(program, "northVC", Eigen::Vector3d(L * Eigen::Vector3d(-sp * cl, -sp * sl, cp)));
    Set(program, "stepBase", placement.Step());
    Set(program, "cameraLatitude", Eigen::Vector2d(sp, cp));
    program->SetUniformf("cameraLatitudeAngle", float(angles.y()));
    return;
  }
  Set(program, "poleXVC", Eigen::Vector3d(L * placement.FromChart(Eigen::Vector3d::UnitX())));
  Set(program, "poleYVC", Eigen::Vector3d(L * placement.FromChart(Eigen::Vector3d::UnitY())));
  Set(program, "poleZVC", Eigen::Vector3d(L * placement.FromChart(Eigen::Vector3d::UnitZ())));
  Set(program, "cameraPlane", placement.OnPlaneOfPole(posts.head<2>()));
  program->SetUniformf("planeBase", float(placement.PlaneStep()));
  if (program->IsUniformUsed("poleSign")) {
    program->SetUniformf("poleSign", placement.South() ? -1.0f : 1.0f);
  }
  if (program->IsUniformUsed("poleTurn")) {
    Set(program, "poleTurn",
        Eigen::Vector2d(std::cos(placement.East()), std::sin(placement.East())));
  }
  if (program->IsUniformUsed("degreesTexture")) {
    // The texture's place of a longitude and latitude, through the degree grid's posts.
    const PostPlacement& grid = this->Terrain_.Placement(); // a Sphere
    Eigen::Affine2d posts_A = Eigen::Affine2d::Identity();
    posts_A.linear() = grid.Step().cwiseInverse().asDiagonal();
    posts_A.translation() = -grid.First().cwiseQuotient(grid.Step());
    const Eigen::Affine2d map =
        this->Terrain_.Options().postToTexture * posts_A * Eigen::Scaling(1.0 / Degrees);
    Set(program, "degreesTexture", Eigen::Matrix2d(map.linear()));
    Set(program, "degreesOrigin", Eigen::Vector2d(map.translation()));
  }
}

// Which posts of the window the lattice has.
void ClipmapUniforms::SetExtent(int level, const Eigen::Vector2d& first) const {
  const PostLattice& lattice = this->Levels_.Lattice();
  const double step = std::ldexp(1.0, level);
  const Eigen::Vector2d camera = this->State_.place / step - first;
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
  Eigen::Vector2d endPost = lastPost;
  if (lattice.periodic) {
    endPost.x() = 1e9;
  }
  Set(this->Program_, "endPost", Eigen::Vector2d(endPost.cwiseMin(1e9).cwiseMax(-1e9)));
  const auto cells = double(this->Levels_.Geometry().Cells());
  const auto within = [cells](const Eigen::Vector2d& post) {
    return Eigen::Vector2d(post.cwiseMax(0.0).cwiseMin(cells));
  };
  Set(this->Program_, "firstPost", within(firstPost));
  Set(this->Program_, "lastPost", within(lastPost));
  Set(this->Program_, "lastPlace", within(lastPlace));
  Set(this->Program_, "cameraPost", camera);
}

// Where the posts lie in the texture, and between the grid's lines.
void ClipmapUniforms::SetMaps(int level, const Eigen::Vector2d& first) const {
  const double step = std::ldexp(1.0, level);
  if (this->Program_->IsUniformUsed("postGrid")) {
    Eigen::Affine2d lines = this->Terrain_.Options().postToMap;
    if (this->Placement_.GetKind() == PostPlacement::Kind::Sphere) {
      lines.linear() = Eigen::Vector2d(this->Placement_.Step() * Degrees).asDiagonal();
      lines.translation() = this->Placement_.First() * Degrees;
    }
    lines = Eigen::Scaling(1.0 / this->Style_.grid->interval) * lines;
    // Counted from a line near the camera: a float holds well what is near it.
    // Whole turns are taken off: lines need not divide them.
    Eigen::Vector2d turns = Eigen::Vector2d::Zero();
    const PostLattice& lattice = this->Levels_.Lattice();
    if (lattice.periodic) {
      turns.x() =
          std::floor(this->State_.place.x() / double(lattice.columns)) * double(lattice.columns);
    }
    const Eigen::Vector2d near = (lines * (this->State_.place - turns)).array().floor();
    Set(this->Program_, "originGrid",
        Eigen::Vector2d(lines * Eigen::Vector2d(first * step - turns) - near));
    Set(this->Program_, "postGrid", Eigen::Matrix2d(lines.linear() * step));
  }
  if (this->Program_->IsUniformUsed("originDetail")) {
    const std::vector<ClipmapStyle::Detail>& details = this->Style_.details;
    float origin[4] = {0, 0, 0, 0};
    for (std::size_t k = 0; k < details.size(); ++k) {
      const Eigen::Affine2d tiles =
          Eigen::Scaling(1.0 / details[k].size) * this->Placement_.PostToScene();
      const Eigen::Vector2d near = (tiles * this->State_.place).array().floor();
      const Eigen::Vector2d at = tiles * Eigen::Vector2d(first * step) - near;
      origin[2 * k] = float(at.x());
      origin[2 * k + 1] = float(at.y());
      const std::string name = "postDetail" + std::to_string(k);
      Set(this->Program_, name.c_str(), Eigen::Matrix2d(tiles.linear() * step));
    }
    this->Program_->SetUniform4f("originDetail", origin);
  }
  if (this->Program_->IsUniformUsed("postTexture")) {
    const Eigen::Affine2d& map = this->Terrain_.Options().postToTexture;
    // Whole turns are nothing to a texture that repeats, but much to a float.
    Eigen::Vector2d origin = map * Eigen::Vector2d(first * step);
    if (this->Levels_.Lattice().periodic) {
      origin.x() -= std::floor(origin.x());
    }
    Set(this->Program_, "originTexture", origin);
    Set(this->Program_, "postTexture", Eigen::Matrix2d(map.linear() * step));
  }
}

void ClipmapUniforms::SetLevel(int level) const {
  vtkShaderProgram* program = this->Program_;
  const ClipmapGeometry& geometry = this->Levels_.Geometry();
  const PostLattice& lattice = this->Levels_.Lattice();
  const PostPlacement& placement = this->Placement_;
  const ClipmapWindow& window = this->Levels_.Window(level);
  const double step = std::ldexp(1.0, level);
  const Eigen::Vector2d first(double(window.column), double(window.row)); // posts of the level
  const Eigen::Vector2d camera = this->Camera_.posts.head<2>();
  SetTexel(program, "windowTexel", geometry.Texel(window.column), geometry.Texel(window.row));
  SetTexel(program, "coarseTexel", geometry.Texel(window.column / 2),
           geometry.Texel(window.row / 2));
  program->SetUniformi("level", level);
  this->SetExtent(level, first);
  const bool coarsest = level == this->Levels_.Count() - 1;
  Set(program, "blend",
      Eigen::Vector3d(coarsest ? 1e30 : geometry.BlendFrom(),
                      1.0 / (geometry.BlendTo() - geometry.BlendFrom()),
                      ClipmapLevels::InPosts(this->State_.distance, this->State_.cellSize, level)));
  switch (placement.GetKind()) {
  case PostPlacement::Kind::Sphere: {
    const Eigen::Vector2d angles =
        (first * step - this->State_.place).cwiseProduct(placement.Step());
    // The camera may stand outside the lattice, or turns away; levels may be about another place.
    Eigen::Vector2d posts = this->State_.place - camera;
    if (lattice.periodic) {
      posts.x() = std::remainder(posts.x(), double(lattice.columns));
    }
    const Eigen::Vector2d apart = posts.cwiseProduct(placement.Step());
    Set(program, "originAngles", Eigen::Vector2d(angles + apart));
    Set(program, "stepAngles", Eigen::Vector2d(placement.Step() * step));
    break;
  }
  case PostPlacement::Kind::Pole: {
    const double plane = placement.PlaneStep();
    const Eigen::Vector2d offset = plane * (first * step - camera);
    Set(program, "originPlane", Eigen::Vector2d(offset.x(), -offset.y()));
    Set(program, "stepPlane", Eigen::Vector2d(plane * step, -plane * step));
    break;
  }
  case PostPlacement::Kind::Plane: {
    const Eigen::Matrix2d& linear = placement.PostToScene().linear();
    const Eigen::Vector2d offset = linear * (first * step - camera);
    const Eigen::Matrix3d& L = this->Camera_.X_VS.linear();
    Set(program, "originVC", Eigen::Vector3d(L.leftCols<2>() * offset));
    Set(program, "columnVC", Eigen::Vector3d(L.leftCols<2>() * (linear.col(0) * step)));
    Set(program, "rowVC", Eigen::Vector3d(L.leftCols<2>() * (linear.col(1) * step)));
    break;
  }
  }
  this->SetMaps(level, first);
}

} // namespace dspace
