#include <dspace/render/ShadowMaps.h>

#include <algorithm>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLState.h"

#include <dspace/Error.h>
#include <dspace/render/Capture.h>
#include <dspace/render/GpuStore.h>
#include <dspace/render/SurfaceShaders.h>

namespace dspace {

namespace {

// What takes shadows from map k: what lies beyond the map before it, and of blockers whose penumbra
// that one does not resolve, all.
class MapReceivers {
public:
  MapReceivers(const CascadeFit& fit, int k, const std::vector<const LightPlace*>& receivers)
      : Axes_(fit.sun.axes), Beyond_(fit, fit.cascades[std::size_t(k)]),
        All_(fit, fit.cascades[std::size_t(k)]) {
    const double end = fit.cascades[std::size_t(k)].end;
    double before = k > 0 ? fit.cascades[std::size_t(k) - 1].end : -1e300;
    if (!(end > before)) { // no map of a parallel view reaches further than the first
      before = 1e300;
    }
    this->Beginning_ = fit.Beginning(std::size_t(k));
    for (const LightPlace* place : receivers) {
      if (place->Anywhere()) {
        this->All_.AddEverywhere();
        if (before < 1e300) {
          this->Beyond_.AddEverywhere();
        }
      } else if (!this->All_.InParts(*place)) {
        this->AddWithin(place->GetDepths(), end, before, place->Whole());
      } else {
        for (const LightPlace::Part& part : place->Parts()) {
          this->AddWithin(part.depths, end, before, part.box);
        }
      }
    }
  }
  bool Take(const LightHull& caster) const { return this->Take(LightPlace(this->Axes_, caster)); }
  bool Take(const LightPlace& caster) const {
    return this->Beyond_.TakeShadows(caster, 0.0) ||
           this->All_.TakeShadows(caster, this->Beginning_);
  }
  std::array<int, 4> Texels() const { return this->All_.Texels(); }

private:
  template<class Extent>
  void AddWithin(const LightPlace::Depths& depths, double end, double before,
                 const Extent& extent) {
    if (depths.nearest <= end) {
      this->All_.Add(extent);
      if (depths.farthest > before) {
        this->Beyond_.Add(extent);
      }
    }
  }

  Eigen::Matrix3d Axes_;
  CasterTiles Beyond_;
  CasterTiles All_;
  double Beginning_ = 0.0; // [m]
};

std::vector<LightPlace> PlacesOf(const CascadeFit& fit, const std::vector<LightHull>& hulls) {
  std::vector<LightPlace> places;
  places.reserve(hulls.size());
  for (const LightHull& hull : hulls) {
    places.emplace_back(fit.sun.axes, hull);
  }
  return places;
}

void Append(const std::vector<LightPlace>& places, std::vector<const LightPlace*>& list) {
  for (const LightPlace& place : places) {
    list.push_back(&place);
  }
}

void AddHulls(const std::vector<LightHull>& hulls, DrawKey& key) {
  for (const LightHull& hull : hulls) {
    key.Add(hull.points.size());
    for (const Eigen::Vector3d& point : hull.points) {
      key.AddMatrix(point);
    }
    key.Add(hull.radius);
    for (const auto& plane : {hull.floor, hull.ceiling}) {
      key.AddMatrix(plane.value_or(Eigen::Vector4d::Zero()));
    }
    key.Add(hull.parts);
    key.AddMatrix(hull.X_VM);
  }
}

} // namespace

void ShadowMaps::Release() {
  if (this->Texture_ && this->Window_->GetContext()) {
    this->Window_->MakeCurrent();
    glDeleteTextures(1, &this->Texture_);
    glDeleteTextures(1, &this->Tiles_);
    glDeleteFramebuffers(GLsizei(this->Framebuffers_.size()), this->Framebuffers_.data());
  }
  this->Texture_ = this->Tiles_ = 0;
  this->TileLayers_ = 0;
  this->Framebuffers_.clear();
  this->Size_ = 0;
  this->Keys_.clear();
}

void ShadowMaps::Resize(const std::string& viewport, int size, int count) {
  if (size == this->Size_ && count == int(this->Framebuffers_.size())) {
    return;
  }
  this->Release();
  while (glGetError() != GL_NO_ERROR) {
  }
  glGenTextures(1, &this->Texture_);
  BindTextureUnit(this->Window_, ShadowUnit, GL_TEXTURE_2D_ARRAY, this->Texture_);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_DEPTH_COMPONENT32F, size, size, count, 0,
               GL_DEPTH_COMPONENT, GL_FLOAT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
  }
  this->Framebuffers_.assign(std::size_t(count), 0);
  glGenFramebuffers(count, this->Framebuffers_.data());
  bool complete = glGetError() == GL_NO_ERROR;
  for (int k = 0; k < count && complete; ++k) {
    glBindFramebuffer(GL_FRAMEBUFFER, this->Framebuffers_[std::size_t(k)]);
    glFramebufferTextureLayer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, this->Texture_, 0, k);
    glDrawBuffer(GL_NONE);
    glReadBuffer(GL_NONE);
    complete = glCheckFramebufferStatus(GL_FRAMEBUFFER) == GL_FRAMEBUFFER_COMPLETE;
  }
  this->Size_ = size;
  if (!complete) {
    this->Release();
    throw Error(Error::Kind::Resource, "viewport '" + viewport + "'",
                "OpenGL has no memory for " + std::to_string(count) + " shadow maps of " +
                    std::to_string(size) + " texels a side; accepted: smaller or fewer ones");
  }
}

void ShadowMaps::ResizeTiles(int count) {
  if (this->TileLayers_ == count) {
    return;
  }
  if (!this->Tiles_) {
    glGenTextures(1, &this->Tiles_);
  }
  BindTextureUnit(this->Window_, ShadowUnit + 1, GL_TEXTURE_2D_ARRAY, this->Tiles_);
  glTexImage3D(GL_TEXTURE_2D_ARRAY, 0, GL_R32F, CasterTiles::Side, CasterTiles::Side, count, 0,
               GL_RED, GL_FLOAT, nullptr);
  for (const GLenum filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER}) {
    glTexParameteri(GL_TEXTURE_2D_ARRAY, filter, GL_NEAREST);
  }
  this->TileLayers_ = count;
}

LightHull ShadowMaps::HullOf(const DrawBatch& batch, const DrawInstance& instance) const {
  LightHull hull;
  if (batch.shader) { // it may move vertices
    return hull;
  }
  const GpuMesh& mesh = this->Store_.MeshOf(batch.mesh);
  const Eigen::AlignedBox3f& bounds = mesh.bounds;
  const Eigen::Map<const Eigen::Matrix<float, 3, 4, Eigen::RowMajor>> X_VM(
      instance.viewFromMesh.data());
  hull.points.reserve(8);
  for (int i = 0; i < 8; ++i) {
    const Eigen::Vector3f corner = bounds.corner(Eigen::AlignedBox3f::CornerType(i));
    hull.points.emplace_back((X_VM * corner.homogeneous()).cast<double>());
  }
  hull.parts = &mesh.parts;
  hull.X_VM = X_VM.cast<double>();
  return hull;
}

std::vector<LightHull> ShadowMaps::HullsOf(const DrawList& list, const DrawView& view, int ground,
                                           Painter& painter) const {
  std::vector<LightHull> hulls;
  for (const DrawBatch& batch : list.Batches()) {
    for (std::uint32_t i = batch.first; i < batch.first + batch.count && ground == NoGround; ++i) {
      hulls.push_back(this->HullOf(batch, list.Instances()[i]));
    }
  }
  for (const DrawCustom& object : list.Customs()) {
    if (!object.covered && painter.GroundOf(object) == ground) {
      const std::vector<LightHull> more = painter.Hulls(object, list, view);
      hulls.insert(hulls.end(), more.begin(), more.end());
    }
  }
  return hulls;
}

void ShadowMaps::UploadTiles(const CasterTiles& tiles, int layer) const {
  BindTextureUnit(this->Window_, ShadowUnit + 1, GL_TEXTURE_2D_ARRAY, this->Tiles_);
  glTexSubImage3D(GL_TEXTURE_2D_ARRAY, 0, 0, 0, layer, CasterTiles::Side, CasterTiles::Side, 1,
                  GL_RED, GL_FLOAT, tiles.Tops().data());
}

// `texels`: of the map that need be drawn.
void ShadowMaps::DrawMap(const DrawList& casters, DrawView view, const std::array<int, 4>& texels,
                         const CascadeFit& fit, int k, int ground, Painter& painter,
                         const std::vector<LightHull>& takers, RenderStatistics& statistics) {
  const CascadeFit::Cascade& cascade = fit.cascades[std::size_t(k)];
  const bool object = ground == NoGround;
  const int size = object ? fit.size : fit.GroundSize();
  const int across = CascadeFit::GroundsAcross;
  const Eigen::Array2i corner =
      object ? Eigen::Array2i(0, 0) : Eigen::Array2i(k % across, k / across) * size;
  const Eigen::Array2i first(texels[0], texels[1]);
  const Eigen::Array2i extent = Eigen::Array2i(texels[2], texels[3]) - first;
  const Eigen::Array2i start = corner + first;
  // Only those texels, so that what is beside them is culled.
  Eigen::Matrix4d part = Eigen::Matrix4d::Identity();
  for (const int axis : {0, 1}) {
    part(axis, axis) = double(size) / extent[axis];
    part(axis, 3) = (double(size) - 2.0 * first[axis] - extent[axis]) / extent[axis];
  }
  view.clip = part * fit.ClipFromView(cascade);
  view.texel = cascade.Texel(size);
  const std::size_t place = std::size_t(ground + 1) * fit.cascades.size() + std::size_t(k);
  this->Keys_.resize(std::max(this->Keys_.size(), place + 1));
  std::optional<DrawKey>& present = this->Keys_[place];
  DrawKey key;
  key.AddBytes(texels.data(), sizeof texels);
  key.AddMatrix(*view.clip);
  key.AddMatrix(fit.sun.axes);
  for (const int number : {size, view.width, view.height, view.samples}) {
    key.Add(number);
  }
  AddHulls(takers, key);
  if (!painter.AddTo(key, casters, view, ground)) {
    present.reset();
  } else if (present && *present == key) {
    ++statistics.shadowMapsKept;
    return;
  } else {
    present = std::move(key);
  }
  ++statistics.shadowMapsDrawn;
  vtkOpenGLState* state = this->Window_->GetState();
  const std::size_t layer = object ? std::size_t(k) : fit.cascades.size() + std::size_t(ground);
  state->vtkglBindFramebuffer(GL_FRAMEBUFFER, this->Framebuffers_[layer]);
  state->vtkglViewport(start[0], start[1], extent[0], extent[1]);
  state->vtkglScissor(start[0], start[1], extent[0], extent[1]);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglClearDepth(0.0);
  state->vtkglClear(GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
  glEnable(GL_DEPTH_CLAMP);
  painter.Draw(casters, view, ground);
  glDisable(GL_DEPTH_CLAMP);
}

bool ShadowMaps::Update(const Scene& scene, const DrawList& seen, DrawView& view, CascadeFit fit,
                        Painter& painter, RenderStatistics& statistics) {
  vtkOpenGLState* state = this->Window_->GetState();
  DrawFilter filter = seen.Filter();
  filter.physicalOnly = true; // ornaments throw no shadow
  filter.castersOnly = true;
  const int count = int(fit.cascades.size());
  const std::vector<LightHull> objects = this->HullsOf(seen, view, NoGround, painter);
  auto grounds = std::make_shared<std::vector<ShadowGround>>();
  std::vector<std::vector<LightHull>> groundHulls; // layer by layer
  const std::vector<LightPlace> objectPlaces = PlacesOf(fit, objects);
  std::vector<std::vector<LightPlace>> groundPlaces;
  std::vector<const LightPlace*> receivers;
  Append(objectPlaces, receivers);
  for (const DrawCustom& object : seen.Customs()) {
    const int layer = painter.GroundOf(object);
    if (layer == NoGround) {
      continue;
    }
    grounds->resize(std::max(grounds->size(), std::size_t(layer) + 1));
    (*grounds)[std::size_t(layer)].objects.push_back(object.object->id);
  }
  for (std::size_t ground = 0; ground < grounds->size(); ++ground) {
    groundHulls.push_back(this->HullsOf(seen, view, int(ground), painter));
    groundPlaces.push_back(PlacesOf(fit, groundHulls.back()));
  }
  for (const std::vector<LightPlace>& places : groundPlaces) {
    Append(places, receivers);
  }
  if (!fit.ground) {
    grounds->clear();
  }
  std::vector<std::vector<LightHull>> others(grounds->size(), objects); // that take its shadow
  std::vector<std::vector<const LightPlace*>> otherPlaces(grounds->size());
  for (std::size_t ground = 0; ground < others.size(); ++ground) {
    Append(objectPlaces, otherPlaces[ground]);
    for (std::size_t other = 0; other < groundHulls.size(); ++other) {
      if (other != ground) {
        others[ground].insert(others[ground].end(), groundHulls[other].begin(),
                              groundHulls[other].end());
        Append(groundPlaces[other], otherPlaces[ground]);
      }
    }
  }
  this->Casters_.resize(std::size_t(count));
  bool complete = true;
  for (int k = 0; k < count; ++k) {
    DrawView map = view;
    map.clip = fit.ClipFromView(fit.cascades[std::size_t(k)]);
    this->Casters_[std::size_t(k)].Build(scene, map, filter);
    complete &= painter.PrepareCasters(this->Casters_[std::size_t(k)], view);
  }
  auto allTiles = std::make_shared<std::vector<CasterTiles>>();
  const vtkOpenGLState::ScopedglEnableDisable scissor(state, GL_SCISSOR_TEST);
  state->vtkglEnable(GL_SCISSOR_TEST);
  state->PushFramebufferBindings();
  try {
    this->Resize(view.viewport, fit.size, count + int(grounds->size()));
    this->ResizeTiles(count * (1 + int(grounds->size())));
    for (int k = 0; k < count; ++k) {
      CascadeFit::Cascade& cascade = fit.cascades[std::size_t(k)];
      DrawList& list = this->Casters_[std::size_t(k)];
      const MapReceivers taking(fit, k, receivers);
      list.Keep([&](const DrawBatch& batch, const DrawInstance& instance) {
        return taking.Take(this->HullOf(batch, instance));
      });
      cascade.high = std::max(cascade.high, list.HighestToSun());
      DrawView map = view;
      map.clip = fit.ClipFromView(cascade); // ground is found by it, too
      map.texel = cascade.Texel(fit.size);
      CasterTiles tiles(fit, cascade);
      for (const LightHull& hull : this->HullsOf(list, map, NoGround, painter)) {
        tiles.Add(hull);
      }
      this->UploadTiles(tiles, k);
      if (!tiles.Empty()) {
        this->DrawMap(list, map, tiles.Texels(), fit, k, NoGround, painter, {}, statistics);
      }
      allTiles->push_back(std::move(tiles));
      CascadeFit coarse = fit;
      coarse.size = fit.GroundSize();
      map.texel = cascade.Texel(coarse.size);
      for (int ground = 0; ground < int(grounds->size()); ++ground) {
        const MapReceivers near(coarse, k, otherPlaces[std::size_t(ground)]);
        CasterTiles casting(coarse, cascade);
        for (const LightHull& hull : this->HullsOf(list, map, ground, painter)) {
          const LightPlace place(fit.sun.axes, hull);
          if (near.Take(place)) {
            casting.Add(place);
          }
        }
        this->UploadTiles(casting, count * (1 + ground) + k);
        if (!casting.Empty()) {
          map.takes = [&near](const LightHull& hull) { return near.Take(hull); };
          this->DrawMap(list, map, near.Texels(), fit, k, ground, painter,
                        others[std::size_t(ground)], statistics);
          map.takes = {};
        }
        (*grounds)[std::size_t(ground)].tiles.push_back(std::move(casting));
      }
    }
  } catch (...) {
    this->Keys_.clear();
    glDisable(GL_DEPTH_CLAMP);
    state->PopFramebufferBindings();
    throw;
  }
  state->PopFramebufferBindings();
  view.shadows = std::move(fit);
  view.shadowTiles = std::move(allTiles);
  view.shadowGrounds = std::move(grounds);
  return complete;
}

} // namespace dspace
