#include <dspace/render/SceneDrawer.h>

#include <algorithm>
#include <cstring>
#include <limits>

#include "vtk_glew.h"

#include "Background_frag.h"
#include "Copy_frag.h"
#include "Downsample_frag.h"
#include "PropLight_frag.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLFramebufferObject.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/Error.h>
#include <dspace/render/CodedShaders.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {
namespace {

// Writes through sRGB encoding while it lives; VTK's own drawing expects none.
class EncodeSrgb {
public:
  EncodeSrgb() { glEnable(GL_FRAMEBUFFER_SRGB); }
  EncodeSrgb(const EncodeSrgb&) = delete;
  EncodeSrgb& operator=(const EncodeSrgb&) = delete;
  ~EncodeSrgb() { glDisable(GL_FRAMEBUFFER_SRGB); }
};

// Reversed depth while it lives.
class ReversedDepth {
public:
  explicit ReversedDepth(vtkOpenGLState* state) : State_(state) {
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglDepthFunc(GL_GEQUAL);
  }
  ReversedDepth(const ReversedDepth&) = delete;
  ReversedDepth& operator=(const ReversedDepth&) = delete;
  ~ReversedDepth() {
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    this->State_->vtkglDepthFunc(GL_LEQUAL);
    this->State_->vtkglDepthMask(GL_TRUE);
  }

private:
  vtkOpenGLState* State_;
};

// What finds its shadows a pixel at a time, after all of it was drawn. Lines and points have no
// plane, and code of an object may move it.
bool IsMasked(const DrawBatch& batch) {
  return batch.lit && !batch.translucent && !batch.shader && !batch.billboard && !batch.wireframe &&
         batch.mesh->primitive == Mesh::Primitive::Triangles;
}

} // namespace

SceneDrawer::SceneDrawer(vtkDspaceHubWindow* window, GpuStore& store, const CustomDrawers& drawers,
                         RenderStatistics& statistics)
    : Window_(window), Store_(store), Drawers_(drawers), Statistics_(statistics), Shaders_(window),
      Shadows_(window, store), EmptyVertices_(window) {}

SceneDrawer::~SceneDrawer() {
  this->Release();
}

void SceneDrawer::Release() {
  for (auto& layer : this->Layers_) {
    layer.reset();
  }
  this->Sum_.reset();
  this->Coarse_.reset();
  this->Planes_.reset();
  this->LitMask_.reset();
  this->EmptyVertices_.Release();
  this->Shadows_.Release();
  if (this->Window_->GetContext()) {
    this->Window_->MakeCurrent();
    this->Customs_.clear();
    if (this->InstanceBuffer_) {
      glDeleteBuffers(1, &this->InstanceBuffer_);
    }
    if (this->Query_) {
      glDeleteQueries(1, &this->Query_);
    }
  }
  this->InstanceBuffer_ = this->Query_ = 0;
  this->Uploaded_.clear();
  this->InstanceCapacity_ = 0;
  this->Shaders_.Release();
}

void SceneDrawer::Upload(const DrawList& list) {
  const std::vector<DrawInstance>& instances = list.Instances();
  const std::size_t bytes = instances.size() * sizeof(DrawInstance);
  if (!this->InstanceBuffer_) {
    glGenBuffers(1, &this->InstanceBuffer_);
  }
  const bool same =
      this->InstanceCapacity_ > 0 && this->Uploaded_.size() == instances.size() &&
      (bytes == 0 || std::memcmp(this->Uploaded_.data(), instances.data(), bytes) == 0);
  if (!same) {
    glBindBuffer(GL_ARRAY_BUFFER, this->InstanceBuffer_);
    // A new store each time lets the driver keep drawing from the old one.
    this->InstanceCapacity_ = std::max(bytes, sizeof(DrawInstance));
    glBufferData(GL_ARRAY_BUFFER, static_cast<GLsizeiptr>(this->InstanceCapacity_), nullptr,
                 GL_STREAM_DRAW);
    glBufferSubData(GL_ARRAY_BUFFER, 0, static_cast<GLsizeiptr>(bytes), instances.data());
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    this->Uploaded_ = instances;
    this->Statistics_.instanceBytesUploaded += bytes;
  }
}

vtkShaderProgram* SceneDrawer::ProgramOf(const DrawBatch& batch, const DrawList& list,
                                         SurfaceShaders::Features features) {
  try {
    return this->Shaders_.Surface(features, {}, batch.shader);
  } catch (const Error& error) {
    if (!batch.shader) {
      throw;
    }
    throw Error(Error::Kind::Internal,
                "object " + std::to_string(list.Instances()[batch.first].label),
                std::string("its shader code does not compile with its present meshes and "
                            "material: ") +
                    error.what());
  }
}

void SceneDrawer::DrawBatches(const DrawList& list, const DrawView& view, bool translucent,
                              SurfaceShaders::Features features, int samples) {
  vtkOpenGLState* state = this->Window_->GetState();
  std::map<vtkShaderProgram*, bool> prepared;
  const bool labels = (features & SurfaceShaders::Label) != 0;
  const bool angles = (features & SurfaceShaders::Angles) != 0;
  const bool planes = (features & SurfaceShaders::Planes) != 0;
  const SurfaceShaders::Features mapped = SurfaceShaders::LightFeatures(list, view);
  const SurfaceShaders::Features masked = this->Masked_ ? SurfaceShaders::Masked(mapped) : mapped;
  for (const DrawBatch& batch : list.Batches()) {
    if (!labels && !angles && batch.translucent != translucent) {
      continue;
    }
    if (planes && !IsMasked(batch)) {
      continue;
    }
    const GpuMesh& mesh = this->Store_.MeshOf(batch.mesh);
    const SurfaceShaders::Features lighting = IsMasked(batch) ? masked : mapped;
    SurfaceShaders::Features wanted = features;
    wanted |= batch.billboard ? SurfaceShaders::Billboard : 0u;
    wanted |= batch.texture && !planes ? SurfaceShaders::Texture : 0u;
    wanted |= planes ? SurfaceShaders::Lit : 0u;
    if (!labels && !planes) {
      wanted |= angles       ? SurfaceShaders::AngleFeatures(list, view, batch.lit)
                : !batch.lit ? 0u
                             : lighting;
      wanted |= batch.lit && batch.specular && !angles ? SurfaceShaders::Specular : 0u;
      wanted |= angles ? 0u : SurfaceShaders::ReflectanceFeature(batch.reflectance);
      wanted |= !batch.lit && this->Light_ ? SurfaceShaders::DisplayColor : 0u;
      wanted |= batch.emissive && !angles ? SurfaceShaders::Emissive : 0u;
      wanted |= !batch.normalTexture                 ? 0u
                : batch.normalTexture->channels == 4 ? SurfaceShaders::ObjectNormals
                                                     : SurfaceShaders::NormalMap;
      wanted |= mesh.hasColors ? SurfaceShaders::VertexColor : 0u;
    }
    if (batch.shader) {
      wanted |= SurfaceShaders::CodeFeatures(*batch.mesh, batch.texture != nullptr);
      wanted &= ~SurfaceShaders::Features(SurfaceShaders::Emissive); // always there
    }
    vtkShaderProgram* program = this->ProgramOf(batch, list, wanted);
    if (!prepared[program]) {
      this->Shaders_.SetView(program, list, view, samples, this->FirstLayer_);
      prepared[program] = true;
    }
    if (batch.shader) {
      SetCodeUniforms(program, *batch.shader);
    }
    if (!planes && SurfaceShaders::ReflectanceFeature(batch.reflectance) != 0) {
      SurfaceShaders::SetReflectance(program, batch.reflectance);
    }
    if (batch.texture && !planes) {
      const unsigned int texture = this->Store_.TextureOf(batch.texture, batch.repeatTexture);
      BindTextureUnit(this->Window_, ColorUnit, GL_TEXTURE_2D, texture);
    }
    if (wanted & (SurfaceShaders::NormalMap | SurfaceShaders::ObjectNormals)) {
      const unsigned int normals = this->Store_.TextureOf(batch.normalTexture, batch.repeatTexture,
                                                          GpuStore::Values::Numbers);
      BindTextureUnit(this->Window_, NormalUnit, GL_TEXTURE_2D, normals);
      if (wanted & SurfaceShaders::NormalMap) {
        program->SetUniformf("normalScale", static_cast<float>(batch.normalScale));
      }
    }
    if (mesh.mode == GL_LINES || batch.wireframe) {
      state->vtkglLineWidth(batch.lineWidth * static_cast<float>(samples));
    }
    if (mesh.mode == GL_POINTS) {
      state->vtkglPointSize(batch.pointSize * static_cast<float>(samples));
    }
    if (batch.wireframe) {
      glPolygonMode(GL_FRONT_AND_BACK, GL_LINE);
    }
    if (batch.solid) { // half of its triangles need no filling
      state->vtkglEnable(GL_CULL_FACE);
      state->vtkglCullFace(batch.mirrored ? GL_FRONT : GL_BACK);
    } else {
      state->vtkglDisable(GL_CULL_FACE);
    }
    glBindVertexArray(mesh.vertexArray);
    glBindVertexBuffer(InstanceBinding, this->InstanceBuffer_,
                       static_cast<GLintptr>(batch.first * sizeof(DrawInstance)),
                       sizeof(DrawInstance));
    glDrawElementsInstanced(mesh.mode, mesh.indexCount, GL_UNSIGNED_INT, nullptr,
                            static_cast<GLsizei>(batch.count));
    ++this->Statistics_.drawCalls;
    if (batch.wireframe) {
      glPolygonMode(GL_FRONT_AND_BACK, GL_FILL);
    }
  }
  state->vtkglDisable(GL_CULL_FACE);
  state->vtkglCullFace(GL_BACK);
  glBindVertexArray(0);
}

void SceneDrawer::Clear(const Background& background) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  state->vtkglClearDepth(0.0);
  // Without sRGB encoding a clear colour is the display value itself.
  state->vtkglClearColor(static_cast<float>(background.bottom[0]),
                         static_cast<float>(background.bottom[1]),
                         static_cast<float>(background.bottom[2]), 1.0f);
  state->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
}

void SceneDrawer::ClearLight(const Background& background) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
  state->vtkglClearDepth(0.0);
  const std::array<float, 3> color = LinearColor(background.bottom);
  state->vtkglClearColor(color[0], color[1], color[2], 0.0f); // not exposed
  state->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
}

CustomDrawing SceneDrawer::Drawing(const DrawCustom& object, const DrawList& list,
                                   const DrawView& view, int samples) {
  CustomDrawing drawing{object,        list,           view,         samples,
                        this->Window_, this->Shaders_, this->Store_, this->Statistics_};
  drawing.light = this->Light_;
  return drawing;
}

bool SceneDrawer::Prepare(const DrawList& list, const DrawView& view, int samples, bool labels) {
  for (auto it = this->Customs_.begin(); it != this->Customs_.end();) {
    it = it->second.geometry.expired() ? this->Customs_.erase(it) : std::next(it);
  }
  this->Prepared_.clear();
  bool complete = true;
  for (const auto* customs : {&list.Customs(), &list.Backdrops()}) {
    for (const DrawCustom& object : *customs) {
      complete &= this->PrepareOne(object, list, view, samples, labels);
    }
  }
  return complete;
}

bool SceneDrawer::PrepareOne(const DrawCustom& object, const DrawList& list, const DrawView& view,
                             int samples, bool labels) {
  Custom& custom = this->Customs_[object.object->custom.get()];
  if (!custom.drawer) {
    custom = {object.object->custom, this->Drawers_.Make(object.object->custom)};
  }
  this->Prepared_.insert(object.object->id);
  CustomDrawing drawing = this->Drawing(object, list, view, samples);
  drawing.labels = labels;
  return custom.drawer->Prepare(drawing);
}

bool SceneDrawer::PrepareCasters(const DrawList& casters, const DrawView& view) {
  bool complete = true;
  for (const DrawCustom& object : casters.Customs()) {
    if (this->Prepared_.count(object.object->id) == 0) {
      complete &= this->PrepareOne(object, casters, view, 1, true);
    }
  }
  return complete;
}

bool SceneDrawer::DrawShadows(const Scene& scene, const DrawList& list, DrawView& view,
                              int samples) {
  this->Statistics_.shadowMapsDrawn = this->Statistics_.shadowMapsKept = 0;
  view.shadows.reset();
  view.shadowTiles.reset();
  view.shadowGrounds.reset();
  this->Grounds_.clear();
  if (!view.look.shadows.shown || !list.Sun()) {
    return true;
  }
  double nearest = list.NearestDepth();
  bool others = !list.Batches().empty(); // what takes the shadows of the ground from maps
  for (const DrawCustom& object : list.Customs()) {
    if (object.covered) {
      continue; // its ground stands for it
    }
    CustomDrawer& drawer = *this->Customs_[object.object->custom.get()].drawer;
    const CustomDrawing drawing = this->Drawing(object, list, view, samples);
    nearest = std::min(nearest, drawer.NearestDepth(drawing));
    if (drawer.ShadowsItself(drawing)) {
      const std::size_t layer = std::min(this->Grounds_.size(), ShadowGround::Most - 1);
      this->Grounds_.emplace(object.object->id, int(layer));
    } else {
      others = true;
    }
  }
  // Where the camera is within a thing's bounds, its distance from it is not known.
  constexpr double Usual = 1.0; // [m]
  nearest = nearest > 0.0 ? nearest : Usual;
  const ReversedDepth reversed(this->Window_->GetState());
  this->Window_->GetState()->vtkglDisable(GL_BLEND);
  double farthest = std::max(nearest, list.FarthestDepth());
  if (view.projection.kind == Projection::Kind::Orthographic) {
    const std::array<double, 2> seen = this->SeenDepths(list, view);
    nearest = seen[0];
    farthest = seen[1];
  }
  CascadeFit fit = FitCascades(view.projection, view.width, view.height, *list.Sun(), nearest,
                               farthest, view.look.shadows);
  fit.ground = this->Grounds_.size() > 1 || (!this->Grounds_.empty() && others);
  const bool complete =
      this->Shadows_.Update(scene, list, view, std::move(fit), *this, this->Statistics_);
  this->Window_->GetState()->vtkglEnable(GL_BLEND);
  this->Shaders_.SetShadowMaps(this->Shadows_.Texture(), this->Shadows_.Tiles());
  return complete;
}

int SceneDrawer::GroundOf(const DrawCustom& object) {
  const auto ground = this->Grounds_.find(object.object->id);
  return ground == this->Grounds_.end() ? ShadowMaps::NoGround : ground->second;
}

std::vector<LightHull> SceneDrawer::Hulls(const DrawCustom& object, const DrawList& list,
                                          const DrawView& view) {
  const auto custom = this->Customs_.find(object.object->custom.get());
  if (custom == this->Customs_.end() || !custom->second.drawer) {
    return {};
  }
  return custom->second.drawer->Hulls(this->Drawing(object, list, view, 1));
}

void SceneDrawer::Draw(const DrawList& casters, const DrawView& view, int ground) {
  if (ground == ShadowMaps::NoGround) {
    this->Upload(casters);
    this->DrawBatches(casters, view, false, SurfaceShaders::Label, 1);
  }
  for (const DrawCustom& object : casters.Customs()) {
    const auto custom = this->Customs_.find(object.object->custom.get());
    if (custom != this->Customs_.end() && custom->second.drawer &&
        this->GroundOf(object) == ground) {
      custom->second.drawer->DrawLabels(this->Drawing(object, casters, view, 1));
    }
  }
}

bool SceneDrawer::AddTo(DrawKey& key, const DrawList& casters, const DrawView& view, int ground) {
  if (ground == ShadowMaps::NoGround) {
    for (const DrawBatch& batch : casters.Batches()) {
      if (batch.shader) {
        return false; // it may draw what it likes
      }
      key.AddShared(batch.mesh);
      key.AddShared(batch.texture);
      for (const bool look :
           {batch.repeatTexture, batch.wireframe, batch.billboard, batch.solid, batch.mirrored}) {
        key.Add(look);
      }
      key.Add(batch.lineWidth);
      key.Add(batch.pointSize);
      key.Add(batch.first);
      key.Add(batch.count);
    }
    key.AddBytes(casters.Instances().data(), casters.Instances().size() * sizeof(DrawInstance));
  }
  bool known = true;
  for (const DrawCustom& object : casters.Customs()) {
    const auto custom = this->Customs_.find(object.object->custom.get());
    if (custom != this->Customs_.end() && custom->second.drawer &&
        this->GroundOf(object) == ground) {
      key.Add(object.object->id);
      key.AddMatrix(object.X_VO.matrix());
      known = known && custom->second.drawer->AddTo(key, this->Drawing(object, casters, view, 1));
    }
  }
  return known;
}

std::array<double, 2> SceneDrawer::SeenDepths(const DrawList& list, const DrawView& view) {
  constexpr int Side = 256;
  const double scale = std::min(1.0, double(Side) / std::max(view.width, view.height));
  DrawView coarse = view;
  coarse.width = std::max(1, int(view.width * scale));
  coarse.height = std::max(1, int(view.height * scale));
  if (!this->Coarse_) {
    this->Coarse_ = std::make_unique<RenderTarget>(this->Window_, RenderTarget::Format::Label,
                                                   RenderTarget::DepthFormat::Float);
  }
  RenderTarget& target = *this->Coarse_;
  target.Resize(coarse.width, coarse.height);
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  target.Bind();
  state->vtkglClearDepth(0.0);
  state->vtkglClear(GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
  this->DrawDepths(list, coarse);
  const std::vector<float> values = target.ReadDepth(0, 0, coarse.width, coarse.height);
  state->PopFramebufferBindings();
  double least = std::numeric_limits<double>::infinity();
  double most = -least;
  for (const float value : values) {
    if (value > 0.0f) {
      const double depth = view.projection.DepthFromBuffer(value);
      least = std::min(least, depth);
      most = std::max(most, depth);
    }
  }
  if (least > most) {
    return {0.0, 1.0};
  }
  // What lies between the coarse pixels.
  const double room =
      0.05 * (most - least) + 2.0 * view.projection.height / std::max(1, coarse.height);
  return {least - room, most + room};
}

void SceneDrawer::DrawDepths(const DrawList& list, const DrawView& view) {
  this->Upload(list);
  this->DrawBatches(list, view, false, SurfaceShaders::Label, 1);
  for (const DrawCustom& object : list.Customs()) {
    const auto custom = this->Customs_.find(object.object->custom.get());
    if (custom != this->Customs_.end() && custom->second.drawer) {
      custom->second.drawer->DrawLabels(this->Drawing(object, list, view, 1));
    }
  }
}

void SceneDrawer::DrawBackground(const Background& background, int height) {
  if (background.bottom == background.top) {
    return; // the clear colour is it
  }
  // Exposure leaves it as it is.
  const char* alpha = this->Light_ ? "#define DSPACE_ALPHA 0.0\n" : "#define DSPACE_ALPHA 1.0\n";
  vtkShaderProgram* program = this->Shaders_.Screen(Background_frag, alpha);
  program->SetUniform3f("bottomColor", background.bottom.data());
  program->SetUniform3f("topColor", background.top.data());
  program->SetUniformf("height", static_cast<float>(height));
  this->EmptyVertices_.DrawScreen(); // at depth 0: only where nothing was drawn
}

void SceneDrawer::DrawLitMask(const DrawList& list, const DrawView& view,
                              const RenderTarget& target) {
  constexpr long long Most = 1LL << 23; // samples; more memory is not worth the time
  this->Masked_ = false;
  if (!view.shadows || view.look.shadows.cascadeColors ||
      (long long)view.width * view.height > Most ||
      std::none_of(list.Batches().begin(), list.Batches().end(), IsMasked)) {
    return;
  }
  if (!this->Planes_) {
    this->Planes_ = std::make_unique<RenderTarget>(this->Window_, RenderTarget::Format::Light,
                                                   RenderTarget::DepthFormat::Float);
    this->LitMask_ = std::make_unique<RenderTarget>(this->Window_, RenderTarget::Format::Number,
                                                    RenderTarget::DepthFormat::None);
  }
  this->Planes_->Resize(view.width, view.height);
  this->LitMask_->Resize(view.width, view.height);
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  this->Planes_->Bind();
  state->vtkglClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  state->vtkglClearDepth(0.0);
  state->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
  this->DrawBatches(list, view, false, SurfaceShaders::Planes, 1);
  this->LitMask_->Bind();
  state->vtkglDisable(GL_DEPTH_TEST);
  this->Shaders_.SunMask(list, view, this->Planes_->Color());
  this->EmptyVertices_.DrawScreen();
  state->vtkglEnable(GL_DEPTH_TEST);
  state->PopFramebufferBindings();
  state->vtkglViewport(0, 0, target.Width(), target.Height());
  state->vtkglScissor(0, 0, target.Width(), target.Height());
  this->Shaders_.SetLitMask(this->LitMask_->Color());
  this->Masked_ = true;
}

bool SceneDrawer::MixesDisplayColors(const DrawList& list, const DrawView& view, int samples) {
  return std::any_of(list.Customs().begin(), list.Customs().end(), [&](const DrawCustom& object) {
    return this->Customs_[object.object->custom.get()].drawer->MixesDisplayColors(
        this->Drawing(object, list, view, samples));
  });
}

void SceneDrawer::DrawColor(const DrawList& list, const DrawView& view, RenderTarget& target,
                            int samples, const Background* background) {
  vtkOpenGLState* state = this->Window_->GetState();
  const EncodeSrgb encode;
  const ReversedDepth reversed(state);
  this->Light_ = target.GetFormat() == RenderTarget::Format::Light;
  this->Statistics_.drawCalls = 0;
  this->Statistics_.trianglesDrawn = list.TriangleCount();
  this->Statistics_.translucentLayers = 0;
  this->Upload(list);
  state->vtkglDisable(GL_BLEND);
  this->DrawLitMask(list, view, target);
  this->DrawBatches(list, view, false, 0, samples);
  this->Masked_ = false;
  for (const DrawCustom& object : list.Customs()) {
    this->Customs_[object.object->custom.get()].drawer->DrawColor(
        this->Drawing(object, list, view, samples));
  }
  if (background) {
    this->DrawBackground(*background, target.Height());
  }
  for (const DrawCustom& object : list.Backdrops()) {
    this->Customs_[object.object->custom.get()].drawer->DrawColor(
        this->Drawing(object, list, view, samples));
  }
  this->DrawTranslucentCustoms(list, view, target, samples);
  const auto& batches = list.Batches();
  if (!batches.empty() && batches.back().translucent) { // they stand last
    this->PeelTranslucent(list, view, target, samples);
  }
  state->vtkglEnable(GL_BLEND);
}

void SceneDrawer::DrawTranslucentCustoms(const DrawList& list, const DrawView& view,
                                         RenderTarget& target, int samples) {
  std::vector<std::pair<double, const DrawCustom*>> customs; // distance along the view's axis
  for (const DrawCustom& object : list.Customs()) {
    const Eigen::Vector3d center = object.X_VO * object.object->custom->Bounds().center;
    customs.emplace_back(-center.z(), &object);
  }
  std::stable_sort(customs.begin(), customs.end(),
                   [](const auto& a, const auto& b) { return a.first > b.first; });
  for (const auto& [distance, object] : customs) {
    this->Customs_[object->object->custom.get()].drawer->DrawTranslucent(
        this->Drawing(*object, list, view, samples), target);
  }
}

void SceneDrawer::PeelTranslucent(const DrawList& list, const DrawView& view, RenderTarget& target,
                                  int samples) {
  vtkOpenGLState* state = this->Window_->GetState();
  const auto format = this->Light_ ? RenderTarget::Format::Light : RenderTarget::Format::Linear;
  if (!this->Sum_ || this->Sum_->GetFormat() != format) {
    for (auto& layer : this->Layers_) {
      layer =
          std::make_unique<RenderTarget>(this->Window_, format, RenderTarget::DepthFormat::Float);
    }
    this->Sum_ =
        std::make_unique<RenderTarget>(this->Window_, format, RenderTarget::DepthFormat::None);
  }
  if (!this->Query_) {
    glGenQueries(1, &this->Query_);
  }
  for (auto& layer : this->Layers_) {
    layer->Resize(target.Width(), target.Height());
  }
  this->Sum_->Resize(target.Width(), target.Height());

  state->PushFramebufferBindings();
  this->Sum_->Bind();
  state->vtkglClearColor(0.0f, 0.0f, 0.0f, 0.0f);
  state->vtkglClear(GL_COLOR_BUFFER_BIT);
  BindTextureUnit(this->Window_, OpaqueDepthUnit, GL_TEXTURE_2D, target.Depth());
  int layers = 0;
  for (; layers < MaximumLayers; ++layers) {
    RenderTarget& layer = *this->Layers_[layers % 2];
    BindTextureUnit(this->Window_, PeeledDepthUnit, GL_TEXTURE_2D,
                    this->Layers_[(layers + 1) % 2]->Depth());
    this->FirstLayer_ = layers == 0;
    layer.Bind();
    state->vtkglDepthMask(GL_TRUE);
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglDisable(GL_BLEND);
    state->vtkglClearDepth(0.0);
    state->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    glBeginQuery(GL_ANY_SAMPLES_PASSED, this->Query_);
    this->DrawBatches(list, view, true, SurfaceShaders::Peel, samples);
    glEndQuery(GL_ANY_SAMPLES_PASSED);
    GLuint any = 0;
    glGetQueryObjectuiv(this->Query_, GL_QUERY_RESULT, &any);
    if (!any) {
      break;
    }
    // What lies behind shows through what the layers before it let pass.
    this->Sum_->Bind();
    state->vtkglDisable(GL_DEPTH_TEST);
    state->vtkglEnable(GL_BLEND);
    state->vtkglBlendFuncSeparate(GL_ONE_MINUS_DST_ALPHA, GL_ONE, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    BindTextureUnit(this->Window_, ColorUnit, GL_TEXTURE_2D, layer.Color());
    this->Shaders_.Screen(Copy_frag)->SetUniformi("source", ColorUnit);
    this->EmptyVertices_.DrawScreen();
  }
  this->Statistics_.translucentLayers = layers;
  state->vtkglClearDepth(1.0);
  state->PopFramebufferBindings();
  state->vtkglViewport(0, 0, target.Width(), target.Height());
  state->vtkglScissor(0, 0, target.Width(), target.Height());
  if (layers > 0) {
    state->vtkglDisable(GL_DEPTH_TEST);
    state->vtkglEnable(GL_BLEND);
    state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
    BindTextureUnit(this->Window_, ColorUnit, GL_TEXTURE_2D, this->Sum_->Color());
    this->Shaders_.Screen(Copy_frag)->SetUniformi("source", ColorUnit);
    this->EmptyVertices_.DrawScreen();
    state->vtkglEnable(GL_DEPTH_TEST);
  }
  state->vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE,
                                GL_ONE_MINUS_SRC_ALPHA);
}

void SceneDrawer::DrawLabels(const DrawList& list, const DrawView& view, RenderTarget& target) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  target.Bind();
  {
    const ReversedDepth reversed(state);
    state->vtkglDisable(GL_BLEND);
    const GLuint nothing[4] = {0, 0, 0, 0};
    glClearBufferuiv(GL_COLOR, 0, nothing);
    state->vtkglClearDepth(0.0);
    state->vtkglClear(GL_DEPTH_BUFFER_BIT);
    state->vtkglClearDepth(1.0);
    this->DrawDepths(list, view);
    state->vtkglEnable(GL_BLEND);
  }
  state->PopFramebufferBindings();
}

void SceneDrawer::DrawAngles(const DrawList& list, const DrawView& view, RenderTarget& target) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  target.Bind();
  {
    const ReversedDepth reversed(state);
    this->Light_ = false;
    state->vtkglDisable(GL_BLEND);
    state->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    state->vtkglClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    state->vtkglClearDepth(0.0);
    state->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    state->vtkglClearDepth(1.0);
    this->Upload(list);
    this->DrawBatches(list, view, false, SurfaceShaders::Angles, 1);
    std::vector<const DrawCustom*> unknown;
    for (const DrawCustom& object : list.Customs()) {
      if (!this->Customs_[object.object->custom.get()].drawer->DrawAngles(
              this->Drawing(object, list, view, 1))) {
        unknown.push_back(&object);
      }
    }
    if (!unknown.empty()) {
      this->HideAngles(unknown, list, view, target);
    }
    state->vtkglEnable(GL_BLEND);
  }
  state->PopFramebufferBindings();
}

void SceneDrawer::HideAngles(const std::vector<const DrawCustom*>& customs, const DrawList& list,
                             const DrawView& view, RenderTarget& target) {
  RenderTarget labels(this->Window_, RenderTarget::Format::Label, RenderTarget::DepthFormat::Float);
  labels.Resize(target.Width(), target.Height());
  labels.Bind();
  vtkOpenGLState* state = this->Window_->GetState();
  const GLuint nothing[4] = {0, 0, 0, 0};
  glClearBufferuiv(GL_COLOR, 0, nothing);
  state->vtkglClearDepth(0.0);
  state->vtkglClear(GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
  for (const DrawCustom* object : customs) {
    this->Customs_[object->object->custom.get()].drawer->DrawLabels(
        this->Drawing(*object, list, view, 1));
  }
  target.Bind();
  BindTextureUnit(this->Window_, OpaqueDepthUnit, GL_TEXTURE_2D, labels.Depth());
  this->Shaders_.Screen(PropLight_frag, "#define DSPACE_UNKNOWN\n")
      ->SetUniformi("depths", OpaqueDepthUnit);
  this->EmptyVertices_.DrawScreen();
}

void SceneDrawer::Downsample(const RenderTarget& source, RenderTarget& target, int samples) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  target.Bind();
  {
    const EncodeSrgb encode;
    state->vtkglDisable(GL_DEPTH_TEST);
    state->vtkglDisable(GL_BLEND);
    BindTextureUnit(this->Window_, ColorUnit, GL_TEXTURE_2D, source.Color());
    // A number in the source lets a software renderer unroll the loops.
    const std::string defines = "#define DSPACE_SAMPLES " + std::to_string(samples) + "\n";
    this->Shaders_.Screen(Downsample_frag, defines)->SetUniformi("source", ColorUnit);
    this->EmptyVertices_.DrawScreen();
    state->vtkglEnable(GL_DEPTH_TEST);
    state->vtkglEnable(GL_BLEND);
  }
  state->PopFramebufferBindings();
}

} // namespace dspace
