#include <dspace/commands/viewports/LensPictures.h>

#include <algorithm>

#include <dspace/commands/viewports/SourceCamera.h>

#include "vtkDspaceRenderContext.h"
#include "vtkDspaceViewport.h"

namespace dspace::session {
namespace {

constexpr int BlockSide = 512; // source pixels: a block is drawn within half a second
constexpr std::size_t KeptBytes = 192u << 20;    // of source blocks
constexpr std::size_t KeptMapBytes = 256u << 20; // of maps

CaptureRequest ToRequest(const LensPictures::Request& from, bool depth) {
  CaptureRequest request;
  request.color = false;
  request.depth = depth;
  request.label = from.wishes.label;
  request.radiance = from.wishes.radiance;
  request.litFraction = from.wishes.litFraction;
  request.incidence = from.wishes.incidence;
  request.emission = from.wishes.emission;
  request.phase = from.wishes.phase;
  request.normal = from.wishes.normal;
  request.physicalOnly = !from.ornaments;
  request.hiddenFragments = from.hiddenFragments;
  return request;
}

std::shared_ptr<LensPlanes> ToPlanes(dspace::Capture&& from) {
  auto to = std::make_shared<LensPlanes>();
  to->width = from.width;
  to->height = from.height;
  to->radiance = std::move(from.radiance);
  to->depth = std::move(from.depth);
  to->label = std::move(from.label);
  to->litFraction = std::move(from.litFraction);
  to->incidence = std::move(from.incidence);
  to->emission = std::move(from.emission);
  to->phase = std::move(from.phase);
  to->normal = std::move(from.normal);
  return to;
}

} // namespace

LensPictures::LensPictures() = default;
LensPictures::~LensPictures() = default;

void LensPictures::ClearBlocks() {
  this->Blocks_.clear();
  this->Order_.clear();
  this->Bytes_ = 0;
  this->Request_.clear();
}

void LensPictures::Clear() {
  this->ClearBlocks();
  this->Viewport_ = nullptr;
  this->Views_.reset();
  this->Maps_.clear();
  this->MapBytes_ = 0;
  this->Lens_.clear();
}

std::shared_ptr<const LensMap> LensPictures::MapOf(const Request& request) {
  std::shared_ptr<const LensMap>& map =
      this->Maps_[{request.x, request.y, request.width, request.height}];
  if (!map) {
    const auto made = std::make_shared<LensMap>(*this->Views_, *request.lens.model.lens, request.x,
                                                request.y, request.width, request.height);
    if (this->MapBytes_ + made->Bytes() > KeptMapBytes) { // no room: begins anew with the next tile
      this->Maps_.clear();
      this->MapBytes_ = 0;
      return made;
    }
    this->MapBytes_ += made->Bytes();
    map = made;
  }
  return map;
}

std::shared_ptr<const LensPlanes> LensPictures::Get(vtkDspaceRenderContext* context,
                                                    const std::shared_ptr<Scene>& scene,
                                                    const Request& request, const Key& block,
                                                    bool depth, Result& result) {
  const auto found = this->Blocks_.find(block);
  if (found != this->Blocks_.end()) {
    return found->second;
  }
  const SourceViews::View view = this->Views_->ViewOf(block);
  if (!this->Viewport_) {
    this->Viewport_ = vtkSmartPointer<vtkDspaceViewport>::New();
    this->Viewport_->Initialize(context, scene, "camera simulation", "main", view.width,
                                view.height, request.samples);
    ViewLook look = this->Viewport_->GetLook();
    look.shadows.shown = true;
    this->Viewport_->SetLook(look);
  }
  this->Viewport_->Resize(view.width, view.height);
  CameraPose camera = request.lens.camera;
  const SourceCamera source = SourceCameraOf(*this->Views_, block.face, view);
  camera.X_FC = camera.X_FC * source.X_CF;
  this->Viewport_->SetFixedView(camera, source.projection);
  std::shared_ptr<const LensPlanes> planes =
      ToPlanes(this->Viewport_->GetCapture(ToRequest(request, depth)));
  ++result.sourceViews;
  result.sourcePixels += std::uint64_t(view.width) * std::uint64_t(view.height);
  this->Blocks_[block] = planes;
  this->Order_.push_back(block);
  this->Bytes_ += planes->Bytes();
  while (this->Bytes_ > KeptBytes && this->Order_.size() > 1) {
    const auto oldest = this->Blocks_.find(this->Order_.front());
    this->Bytes_ -= oldest->second->Bytes();
    this->Blocks_.erase(oldest);
    this->Order_.pop_front();
  }
  return planes;
}

LensPictures::Result LensPictures::Draw(vtkDspaceRenderContext* context,
                                        const std::shared_ptr<Scene>& scene,
                                        const Request& request) {
  const bool sameScene = this->Scene_.lock() == scene;
  if (!sameScene || !this->Viewport_ || this->Viewport_->GetSamples() != request.samples) {
    this->ClearBlocks();
    this->Viewport_ = nullptr;
  }
  if (this->Lens_ != request.lensKey) {
    this->ClearBlocks();
    this->Maps_.clear();
    this->MapBytes_ = 0;
    this->Lens_.clear();
    this->Views_ = std::make_unique<SourceViews>(request.lens.model, BlockSide);
    this->Lens_ = request.lensKey;
  }
  if (this->Request_ != request.key || this->Revision_ != scene->Revision()) {
    this->ClearBlocks();
    this->Scene_ = scene;
    this->Request_ = request.key;
    this->Revision_ = scene->Revision();
  }
  Result result;
  const std::shared_ptr<const LensMap> map = this->MapOf(request);
  LensTile tile(*this->Views_, map, request.wishes);
  for (const auto& [block, pixels] : map->Blocks()) {
    tile.Take(block, *this->Get(context, scene, request, block, tile.NeedsDepth(), result));
  }
  result.planes = tile.TakePlanes();
  result.withoutRay = map->WithoutRay();
  result.halfAngle_deg = this->Views_->HalfAngle_deg();
  result.pupilShift = this->Views_->PupilShift();
  result.pupilPixels = tile.PupilPixels();
  result.pupilBeyond = tile.Beyond();
  return result;
}

} // namespace dspace::session
