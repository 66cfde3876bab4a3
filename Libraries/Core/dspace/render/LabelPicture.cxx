#include <dspace/render/LabelPicture.h>

#include <algorithm>
#include <cmath>

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"

namespace dspace {

bool LabelPicture::IsCurrent(const Scene& scene, const DrawFilter& filter) const {
  return this->Revision_ == scene.Revision() && this->Filter_.physicalOnly == filter.physicalOnly &&
         this->Filter_.pickableOnly == filter.pickableOnly &&
         this->Filter_.partsOf == filter.partsOf &&
         this->Filter_.hiddenFragments == filter.hiddenFragments;
}

void LabelPicture::Draw(vtkDspaceRenderContext* context, const Scene& scene, const DrawView& view,
                        const DrawFilter& filter) {
  this->Invalidate(); // until all of it is there
  vtkDspaceHubWindow* hub = context->GetHub();
  hub->MakeCurrent();
  if (!this->Drawer_) {
    this->Target_ = std::make_unique<RenderTarget>(hub, RenderTarget::Format::Label,
                                                   RenderTarget::DepthFormat::Float);
    this->Drawer_ = std::make_unique<SceneDrawer>(hub, context->GetStore(), context->GetDrawers(),
                                                  context->CountStatistics());
  }
  this->View_ = view;
  this->Filter_ = filter;
  this->Target_->Resize(view.width, view.height);
  const std::uint64_t revision =
      scene.Revision(); // read first: later changes are not in the picture
  this->List_.Build(scene, this->View_, filter);
  const bool complete = this->Drawer_->Prepare(this->List_, this->View_, 1, true);
  this->Drawer_->DrawLabels(this->List_, this->View_, *this->Target_);
  this->Revision_ = complete ? revision : 0;
}

std::vector<std::uint32_t> LabelPicture::Labels() const {
  return this->Target_->ReadLabel(0, 0, this->View_.width, this->View_.height);
}

std::vector<float> LabelPicture::Depths() const {
  std::vector<float> depths = this->Target_->ReadDepth(0, 0, this->View_.width, this->View_.height);
  for (float& value : depths) {
    value = static_cast<float>(this->View_.projection.DepthFromBuffer(value));
  }
  return depths;
}

std::vector<float> LabelPicture::Ranges() const {
  const DrawView& view = this->View_;
  std::vector<float> ranges = this->Target_->ReadDepth(0, 0, view.width, view.height);
  for (int y = 0, i = 0; y < view.height; ++y) {
    for (int x = 0; x < view.width; ++x, ++i) {
      const Projection::Ray ray = view.projection.PixelRay(x, y, view.width, view.height);
      const double depth = view.projection.DepthFromBuffer(ranges[std::size_t(i)]);
      ranges[std::size_t(i)] = static_cast<float>((depth - ray.origin.z()) / ray.direction.z());
    }
  }
  return ranges;
}

std::uint32_t LabelPicture::LabelAt(const std::array<int, 2>& pixel) const {
  return this->Target_->ReadLabel(pixel[0], pixel[1], 1, 1).front();
}

PickResult LabelPicture::Pick(const Scene& scene, double x, double y, int radius,
                              std::array<int, 2>& pixel) const {
  const DrawView& view = this->View_;
  const int px = static_cast<int>(std::floor(x + 0.5));
  const int py = static_cast<int>(std::floor(y + 0.5));
  const int x0 = std::max(px - radius, 0);
  const int y0 = std::max(py - radius, 0);
  const int w = std::min(px + radius, view.width - 1) - x0 + 1;
  const int h = std::min(py + radius, view.height - 1) - y0 + 1;
  const auto labels = this->Target_->ReadLabel(x0, y0, w, h);
  const auto depths = this->Target_->ReadDepth(x0, y0, w, h);
  int best = -1;
  int bestDistance = radius * radius + 1;
  for (int i = 0; i < w * h; ++i) {
    const int dx = x0 + i % w - px;
    const int dy = y0 + i / w - py;
    if (labels[i] != 0 && dx * dx + dy * dy < bestDistance) {
      best = i;
      bestDistance = dx * dx + dy * dy;
    }
  }
  PickResult result;
  if (best < 0) {
    return result;
  }
  result.object = labels[best];
  result.frame = scene.Object(result.object).frame;
  result.depth = view.projection.DepthFromBuffer(depths[best]);
  // The pixel's own centre is what was drawn: the depth belongs to that ray.
  pixel = {x0 + best % w, y0 + best / w};
  const Projection::Ray ray = view.projection.PixelRay(pixel[0], pixel[1], view.width, view.height);
  result.p_camera =
      ray.origin + ray.direction * ((result.depth - ray.origin.z()) / ray.direction.z());
  result.cameraFrame = view.camera.frame;
  const Eigen::Vector3d p_A = view.camera.X_FC.Apply(result.p_camera);
  const FrameTree& frames = scene.Frames();
  result.p_frame = frames.RelativePose(result.frame, view.camera.frame).Apply(p_A);
  result.p_root = frames.RelativePose(RootFrame, view.camera.frame).Apply(p_A);
  return result;
}

} // namespace dspace
