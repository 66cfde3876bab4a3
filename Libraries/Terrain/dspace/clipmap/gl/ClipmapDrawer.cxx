#include <dspace/clipmap/gl/ClipmapDrawer.h>

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/clipmap/ClipmapFocus.h>
#include <dspace/render/Capture.h>
#include <dspace/render/CustomDrawers.h>
#include <dspace/render/GpuStore.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/scene/Stretch.h>

#include <dspace/clipmap/gl/ClipmapDrawing.h>
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

constexpr int HorizonUnit = NormalUnit; // terrain has no normal texture of that kind

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
  const Eigen::Matrix4d clip = view.ClipFromView() * camera.X_VS.matrix();
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

// A block's bounds in view axes.
LightHull HullOf(const ClipmapCamera& camera, const ClipmapBlocks::Bounds& bounds) {
  LightHull hull;
  hull.points.reserve(bounds.points.size());
  for (const Eigen::Vector3d& point : bounds.points) {
    hull.points.push_back(camera.X_VS * point);
  }
  hull.radius = bounds.radius * LargestStretch(camera.X_VS);
  if (bounds.heights) { // the points come in pairs, low and high
    const Eigen::Vector3d up = camera.X_VS.linear().col(2).normalized();
    for (const int i : {0, 1}) {
      Eigen::Vector4d& plane = (i == 0 ? hull.floor : hull.ceiling).emplace();
      plane << up, -up.dot(hull.points[std::size_t(i)]);
    }
  }
  return hull;
}

// Moves the blocks that `chosen` takes, level by level, to the result.
template<class Chosen>
std::vector<std::vector<ClipmapBlocks::Block>>
Take(std::vector<std::vector<ClipmapBlocks::Block>>& from, const Chosen& chosen) {
  std::vector<std::vector<ClipmapBlocks::Block>> taken;
  for (auto& level : from) {
    const auto others = std::stable_partition(level.begin(), level.end(), chosen);
    taken.emplace_back(std::make_move_iterator(level.begin()), std::make_move_iterator(others));
    level.erase(level.begin(), others);
  }
  return taken;
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
      Layers_(terrain, LayerContent::Colors), Normals_(terrain, LayerContent::Normals) {}

ClipmapDrawer::~ClipmapDrawer() {
  for (const auto& chart : this->Charts_) {
    if (chart && chart->texture) {
      glDeleteTextures(1, &chart->texture);
    }
    if (chart && chart->horizonTexture) {
      glDeleteTextures(1, &chart->horizonTexture);
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
  const DrawFilter& filter = drawing.list.Filter();
  this->Style_ =
      this->Terrain_->StyleIn(drawing.view.viewport).ShownBy([&](const Membership& member) {
        return filter.Shows(member);
      });
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
  const bool horizon = this->PrepareHorizon(drawing);
  return this->Active_ == chart.get() && chart->state.complete && layers && horizon;
}

bool ClipmapDrawer::PrepareLayers(const CustomDrawing& drawing) {
  const Chart& chart = *this->Active_;
  if (!chart.Drawable() || drawing.labels) {
    return true;
  }
  const ClipmapCamera camera(drawing.object.X_VO, chart.placement);
  const ClipmapViewVolume sight = ViewVolumeOf(camera, drawing.view);
  const auto prepare = [&](LayerDrawing& layers) {
    return layers.Prepare(drawing, !this->Style_.Empty() || this->ShowsTracks(),
                          this->ActiveIndex(), chart.levels, chart.state, sight, chart.heights);
  };
  const bool colors = prepare(this->Layers_);
  return (!this->IsLit(drawing) || prepare(this->Normals_)) && colors;
}

std::size_t ClipmapDrawer::ActiveIndex() const {
  const auto found =
      std::find_if(this->Charts_.begin(), this->Charts_.end(),
                   [this](const auto& other) { return other.get() == this->Active_; });
  return std::size_t(found - this->Charts_.begin());
}

bool ClipmapDrawer::HasFarShadows(const CustomDrawing& drawing) const {
  return drawing.view.look.shadows.shown && drawing.list.Sun() && !drawing.view.clip &&
         !drawing.labels && this->IsLit(drawing);
}

bool ClipmapDrawer::ShadowsItself(const CustomDrawing& drawing) {
  return drawing.view.look.shadows.shown && drawing.list.Sun() && this->IsLit(drawing) &&
         this->Active_ && this->Active_->horizon;
}

bool ClipmapDrawer::PrepareHorizon(const CustomDrawing& drawing) {
  Chart& chart = *this->Active_;
  if (!chart.Drawable() || !this->HasFarShadows(drawing)) {
    return true;
  }
  const int side = chart.levels.Geometry().Texels();
  if (!chart.horizon) {
    chart.horizon = std::make_unique<ClipmapHorizon>(this->Terrain_->Horizons(this->ActiveIndex()));
    glGenTextures(1, &chart.horizonTexture);
    BindTextureUnit(drawing.window, HorizonUnit, GL_TEXTURE_2D_ARRAY, chart.horizonTexture);
    glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_RG32F, side, side, chart.levels.Count(), 0, GL_RG,
                 GL_FLOAT, nullptr);
    for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
      glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
    }
  }
  BindTextureUnit(drawing.window, HorizonUnit, GL_TEXTURE_2D_ARRAY, chart.horizonTexture);
  glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
  const Eigen::Vector3d toSun_V = drawing.list.Sun()->axes.row(2);
  const Eigen::Vector3d toSun_S = (drawing.object.X_VO.linear().inverse() * toSun_V).normalized();
  std::optional<double> wait;
  if (drawing.view.complete) {
    wait = this->Terrain_->Options().deadline;
  }
  return chart.horizon->Update(chart.levels, chart.state, toSun_S, wait,
                               [&](int level, const std::vector<HorizonTexel>& texels) {
                                 glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, level, side, side, 1,
                                                 GL_RG, GL_FLOAT, texels.data());
                                 drawing.statistics.textureBytesUploaded +=
                                     texels.size() * sizeof(HorizonTexel);
                               });
}

bool ClipmapDrawer::IsLit(const CustomDrawing& drawing) const {
  const Material& material = *this->Terrain_->Options().material;
  return drawing.object.object->material.lit.value_or(material.lit);
}

bool ClipmapDrawer::ShowsTracks() const {
  const Chart& chart = *this->Active_;
  bool tracks = false;
  for (int level = chart.state.finest; level < chart.levels.Count(); ++level) {
    tracks |= chart.levels.HasTracks(level);
  }
  return tracks && !this->Style_.tracks.hidden;
}

// Before any is bound for drawing: an upload ends with its unit unbound.
void ClipmapDrawer::LoadTextures(const CustomDrawing& drawing) const {
  const Material& material = *this->Terrain_->Options().material;
  if (const auto texture = drawing.object.object->material.texture.value_or(material.texture)) {
    drawing.store.TextureOf(texture, material.repeatTexture);
  }
  const ClipmapStyle& style = this->Style_;
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
  chart.levels.SetNoise(this->Style_.noise, chart.placement);
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
        chart.ranges.Changed(level);
        ++chart.uploads;
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

// The camera's height above the ground below it.
double ClipmapDrawer::NearestDepth(const CustomDrawing& drawing) {
  const Chart& chart = *this->Active_;
  const ClipmapCamera camera(drawing.object.X_VO, chart.placement);
  const double ground = chart.levels.HeightNear(camera.posts.head<2>(), chart.state.finest)
                            .value_or(chart.state.groundHeight);
  const double scale = camera.X_VS.linear().col(2).norm();
  return 0.5 * std::abs(camera.posts.z() - ground) * scale;
}

bool ClipmapDrawer::MixesDisplayColors(const CustomDrawing& drawing) {
  const std::optional<ClipmapStyle::Ramp>& ramp = this->Style_.ramp;
  return ramp && !ramp->shaded && ramp->opacity > 0.0 && ramp->opacity < 1.0 &&
         this->IsLit(drawing);
}

void ClipmapDrawer::DrawColor(const CustomDrawing& drawing) {
  const GraphicsObject& object = *drawing.object.object;
  const Material& material = *this->Terrain_->Options().material;
  const MaterialOverride& over = object.material;
  SurfaceShaders::Features features = 0;
  if (this->IsLit(drawing)) {
    features |= SurfaceShaders::LightFeatures(drawing.list, drawing.view);
    const Reflectance reflectance = ReflectanceOf(drawing.object, material);
    features |= SurfaceShaders::ReflectanceFeature(reflectance);
    if (reflectance.model == Reflectance::Model::MetallicRoughness &&
        (over.metallic.value_or(material.metallic) > 0.0 ||
         over.roughness.value_or(material.roughness) < 1.0)) {
      features |= SurfaceShaders::Specular;
    }
  } else if (drawing.light) {
    features |= SurfaceShaders::DisplayColor;
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

bool ClipmapDrawer::AddTo(DrawKey& key, const CustomDrawing&) {
  const Chart& chart = *this->Active_;
  key.Add(this->ActiveIndex());
  key.Add(chart.uploads);
  key.Add(chart.state.finest);
  key.AddMatrix(chart.state.place);
  key.Add(chart.state.groundHeight);
  key.Add(chart.state.distance);
  key.Add(chart.state.cellSize);
  for (int level = chart.state.finest; level < chart.levels.Count(); ++level) {
    key.Add(chart.levels.Window(level).column);
    key.Add(chart.levels.Window(level).row);
  }
  return true;
}

bool ClipmapDrawer::DrawAngles(const CustomDrawing& drawing) {
  this->Draw(drawing,
             SurfaceShaders::AngleFeatures(drawing.list, drawing.view, this->IsLit(drawing)));
  return true;
}

std::vector<Caption> ClipmapDrawer::Captions(const CustomDrawing& drawing,
                                             const RenderTarget& target) {
  const Chart& chart = *this->Active_;
  if (!this->Style_.grid || !this->Style_.gridLabels || !chart.Drawable()) {
    return {};
  }
  return GridCaptions(drawing, target, *this->Terrain_, this->Style_, chart.placement, chart.levels,
                      chart.state);
}

ClipmapDrawer::Blocks ClipmapDrawer::BlocksIn(const ClipmapCamera& camera,
                                              const DrawView& view) const {
  Chart& chart = *this->Active_;
  const ClipmapBlocks blocks(chart.levels, chart.placement, chart.heights, chart.ranges);
  const ClipmapViewVolume sight = ViewVolumeOf(camera, view);
  const int finest = this->FinestIn(view);
  Blocks seen;
  for (int level = finest; level < chart.levels.Count(); ++level) {
    seen.push_back(blocks.Seen(this->Indices_, sight, level, finest));
  }
  return seen;
}

int ClipmapDrawer::FinestIn(const DrawView& view) const {
  const Chart& chart = *this->Active_;
  const double posts = view.texel / chart.state.cellSize; // of level 0, a texel
  if (!view.clip || posts < 1.0) {
    return chart.state.finest;
  }
  return std::clamp(int(std::floor(std::log2(posts))), chart.state.finest,
                    std::max(chart.state.finest, chart.levels.Count() - 1));
}

std::vector<LightHull> ClipmapDrawer::Hulls(const CustomDrawing& drawing) {
  const ClipmapCamera camera(drawing.object.X_VO, this->Active_->placement);
  std::vector<LightHull> hulls;
  for (const auto& level : this->BlocksIn(camera, drawing.view)) {
    for (const ClipmapBlocks::Block& block : level) {
      hulls.push_back(HullOf(camera, block.bounds));
    }
  }
  return hulls;
}

void ClipmapDrawer::Draw(const CustomDrawing& drawing, SurfaceShaders::Features features) {
  const ClipmapCamera camera(drawing.object.X_VO, this->Active_->placement);
  Blocks blocks = this->BlocksIn(camera, drawing.view);
  const DrawView& view = drawing.view;
  const bool maps = (features & SurfaceShaders::Lit) != 0 && view.shadows && view.shadowTiles;
  if (!maps || view.look.shadows.cascadeColors || view.look.shadows.litColors) {
    if (view.takes) {
      Take(blocks, [&](const ClipmapBlocks::Block& block) {
        return !view.takes(HullOf(camera, block.bounds));
      });
    }
    this->DrawBlocks(drawing, features, camera, blocks);
    return;
  }
  // Most ground is near no caster: its program reads no maps.
  const int own = this->OwnGround(drawing);
  const Blocks shaded = Take(blocks, [&](const ClipmapBlocks::Block& block) {
    const LightPlace hull(view.shadows->sun.axes, HullOf(camera, block.bounds));
    bool may = MayBeShaded(*view.shadows, *view.shadowTiles, hull);
    for (int i = 0; i < int(view.shadowGrounds->size()) && !may; ++i) {
      may =
          i != own && MayBeShaded(*view.shadows, (*view.shadowGrounds)[std::size_t(i)].tiles, hull);
    }
    return may;
  });
  this->DrawBlocks(drawing, features, camera, shaded);
  this->DrawBlocks(drawing, SurfaceShaders::WithoutMaps(features), camera, blocks);
}

int ClipmapDrawer::OwnGround(const CustomDrawing& drawing) {
  constexpr int None = -1;
  if (!drawing.view.shadowGrounds) {
    return None;
  }
  const std::vector<ShadowGround>& grounds = *drawing.view.shadowGrounds;
  const auto own = std::find_if(grounds.begin(), grounds.end(), [&](const ShadowGround& ground) {
    const auto& ids = ground.objects;
    return std::find(ids.begin(), ids.end(), drawing.object.object->id) != ids.end();
  });
  return own == grounds.end() ? None : int(own - grounds.begin());
}

void ClipmapDrawer::DrawBlocks(const CustomDrawing& drawing, SurfaceShaders::Features features,
                               const ClipmapCamera& camera, const Blocks& blocks) {
  const Chart& chart = *this->Active_;
  const bool labels = (features & SurfaceShaders::Label) != 0;
  const ClipmapStyle& style = this->Style_;
  // Longitude jumps within a triangle at a pole: there the place in a texture over a degree grid is
  // found a pixel.
  const bool poleTexture = chart.placement.GetKind() == PostPlacement::Kind::Pole &&
                           this->Terrain_->Placement().GetKind() == PostPlacement::Kind::Sphere &&
                           (features & SurfaceShaders::Texture) != 0;
  const bool colors = !labels && (features & SurfaceShaders::Angles) == 0;
  const bool tracks = colors && this->ShowsTracks(); // what mixes colours costs time elsewhere
  const bool layers = colors && this->Layers_.Shown();
  const bool normals = (features & SurfaceShaders::Lit) != 0 && this->Normals_.Shown();
  const bool scaled = colors && BrightnessOf(drawing.object) != 1.0;
  const bool mixed = colors && (poleTexture || tracks || layers || scaled || !style.Empty());
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
  if (scaled) {
    pages.defines += "#define DSPACE_BRIGHTNESS\n";
  }
  if (layers) {
    pages.defines += this->Layers_.Defines();
  }
  if (normals) {
    pages.defines += this->Normals_.Defines();
  }
  if (mixed) {
    features |= SurfaceShaders::Mixed;
  }
  const bool horizon =
      (features & SurfaceShaders::Lit) != 0 && this->HasFarShadows(drawing) && chart.horizon;
  const int ownGround = this->OwnGround(drawing);
  if (horizon) {
    pages.defines += "#define DSPACE_HORIZON\n";
    if (ownGround >= 0 && drawing.view.shadowGrounds->size() == 1) {
      features = SurfaceShaders::WithoutGrounds(features);
    }
  }
  if (mixed || normals || horizon) {
    pages.fragment = ClipmapFragmentFunctions();
  }
  if (poleTexture) {
    features &= ~SurfaceShaders::Features(SurfaceShaders::Texture);
    pages.defines += "#define DSPACE_POLE_TEXTURE\n";
  }
  vtkShaderProgram* program = drawing.shaders.Surface(features, pages);
  drawing.shaders.SetView(program, drawing.list, drawing.view, drawing.samples);
  BindTextureUnit(drawing.window, TerrainUnit, GL_TEXTURE_2D_ARRAY, chart.texture);
  program->SetUniformi("posts", TerrainUnit);
  if (horizon) {
    BindTextureUnit(drawing.window, HorizonUnit, GL_TEXTURE_2D_ARRAY, chart.horizonTexture);
    program->SetUniformi("horizons", HorizonUnit);
    program->SetUniformf("horizonRadius", float(drawing.list.Sun()->radius));
    if (program->IsUniformUsed("nearPosts")) {
      const bool plane = chart.placement.GetKind() == PostPlacement::Kind::Plane;
      program->SetUniformf(
          "nearPosts",
          float(this->Terrain_->Horizons(this->ActiveIndex())->Sweep().Options().near));
      program->SetUniformf("bend", plane ? 0.0f : float(0.5 / chart.placement.Radius()));
    }
  }
  if (program->IsUniformUsed("lightExposure")) {
    const DrawView& view = drawing.view;
    const bool filmic = view.exposure && view.look.tone == ToneCurve::Filmic;
    const float exposure[2] = {float(view.exposure.value_or(0.0)), filmic ? 1.0f : 0.0f};
    program->SetUniform2f("lightExposure", exposure);
  }
  if (program->IsUniformUsed("ownGround")) {
    program->SetUniformi("ownGround", ownGround);
  }
  const ClipmapUniforms uniforms(program, *this->Terrain_, style, chart.placement, chart.levels,
                                 chart.state, camera);
  if (labels) {
    program->SetUniformi("objectLabel", int(drawing.object.object->id));
  } else {
    uniforms.SetLook(drawing.object, features);
  }
  if (mixed) {
    uniforms.SetStyle(drawing);
  }
  uniforms.SetPlacement();
  if (layers) {
    this->Layers_.SetLook(program, drawing.samples);
  }
  if (normals) {
    this->Normals_.SetLook(program, drawing.samples);
  }

  vtkOpenGLState* state = drawing.window->GetState();
  // The Sun sees under sides at night, and where ground ends.
  const bool shadowMap = drawing.view.clip.has_value();
  if (!shadowMap &&
      camera.posts.z() > chart.levels.HeightNear(camera.posts.head<2>(), chart.state.finest)
                             .value_or(chart.state.groundHeight)) {
    // From above no under side is seen but by rounding, at ridges.
    state->vtkglEnable(GL_CULL_FACE);
    state->vtkglCullFace(camera.mirrored > 0.0f ? GL_BACK : GL_FRONT);
  }
  std::vector<GLsizei> counts;
  std::vector<const void*> firsts;
  glBindVertexArray(this->VertexArray_);
  const int finest = this->FinestIn(drawing.view);
  for (int level = finest; level < chart.levels.Count(); ++level) {
    counts.clear();
    firsts.clear();
    for (const ClipmapIndices::Run& run :
         ClipmapBlocks::Runs(blocks[std::size_t(level - finest)])) {
      counts.push_back(GLsizei(run.count));
      firsts.push_back(reinterpret_cast<const void*>(run.first * sizeof(std::uint16_t)));
      drawing.statistics.trianglesDrawn += run.count / 3;
    }
    if (counts.empty()) {
      continue;
    }
    uniforms.SetLevel(level);
    const ClipmapWindow& window = chart.levels.Window(level);
    const Eigen::Vector2d first(double(window.column), double(window.row));
    if (layers) {
      this->Layers_.SetLevel(program, first, std::ldexp(1.0, level));
    }
    if (normals) {
      this->Normals_.SetLevel(program, first, std::ldexp(1.0, level));
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
