#include <dspace/render/RadiancePicture.h>

#include <cmath>
#include <limits>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"
#include "vtkDspaceRenderContext.h"
#include "vtkOpenGLState.h"

#include <dspace/scene/Light.h>

namespace dspace {
namespace {

std::unique_ptr<SceneDrawer> DrawerFor(vtkDspaceRenderContext* context) {
  return std::make_unique<SceneDrawer>(context->GetHub(), context->GetStore(),
                                       context->GetDrawers(), context->CountStatistics());
}

std::unique_ptr<RenderTarget> TargetFor(vtkDspaceRenderContext* context,
                                        RenderTarget::DepthFormat depth) {
  return std::make_unique<RenderTarget>(context->GetHub(), RenderTarget::Format::Light, depth);
}

} // namespace

void RadiancePicture::Draw(vtkDspaceRenderContext* context, const Scene& scene,
                           const DrawView& sought, const DrawFilter& sees) {
  vtkDspaceHubWindow* hub = context->GetHub();
  hub->MakeCurrent();
  if (!this->Drawer_) {
    this->Drawer_ = DrawerFor(context);
    this->Samples_ = TargetFor(context, RenderTarget::DepthFormat::Float);
  }
  DrawView view = sought;
  view.look.exposure = 1.0;
  view.look.automaticExposure = false;
  view.look.tone = ToneCurve::Linear;
  view.look.fill = 0.0;
  DrawFilter filter = sees;
  filter.physicalOnly = true;
  this->Samples_->Resize(view.width, view.height);
  this->List_.Build(scene, view, filter);
  this->Drawer_->Prepare(this->List_, view, view.samples);
  this->Drawer_->DrawShadows(scene, this->List_, view, view.samples);
  vtkOpenGLState* state = hub->GetState();
  state->PushFramebufferBindings();
  this->Samples_->Bind();
  this->Drawer_->ClearLight({});
  this->Drawer_->DrawColor(this->List_, view, *this->Samples_, view.samples);
  state->PopFramebufferBindings();
  this->Pixels_.reset();
  if (view.samples > 1) {
    this->Pixels_ = TargetFor(context, RenderTarget::DepthFormat::None);
    this->Pixels_->Resize(view.width / view.samples, view.height / view.samples);
    this->Drawer_->Downsample(*this->Samples_, *this->Pixels_, view.samples);
  }
}

std::vector<float> RadiancePicture::Radiances() const {
  const std::vector<float> light = (this->Pixels_ ? this->Pixels_ : this->Samples_)->ReadLight();
  std::vector<float> radiances;
  radiances.reserve(light.size() / 4 * 3);
  for (std::size_t i = 0; i < light.size(); ++i) {
    if (i % 4 != 3) {
      radiances.push_back(static_cast<float>(double(light[i]) * SolarConstant / M_PI));
    }
  }
  return radiances;
}

void AnglePicture::Draw(vtkDspaceRenderContext* context, const Scene& scene, const DrawView& sought,
                        const DrawFilter& filter) {
  context->GetHub()->MakeCurrent();
  if (!this->Drawer_) {
    this->Drawer_ = DrawerFor(context);
    this->Target_ = TargetFor(context, RenderTarget::DepthFormat::Float);
  }
  DrawView view = sought;
  view.look.shadows.shown = true;
  this->Target_->Resize(view.width, view.height);
  this->List_.Build(scene, view, filter);
  this->Sun_ = this->List_.TowardsSun().has_value();
  this->Drawer_->Prepare(this->List_, view, 1);
  this->Drawer_->DrawShadows(scene, this->List_, view, 1);
  this->Drawer_->DrawAngles(this->List_, view, *this->Target_);
  this->Values_ = this->Target_->ReadLight();
}

void AnglePicture::DrawNormals(vtkDspaceRenderContext* context, const Scene& scene,
                               const DrawView& sought, const DrawFilter& filter) {
  DrawView view = sought;
  view.normals = true;
  this->Draw(context, scene, view, filter);
}

std::vector<float> AnglePicture::Normals() const {
  std::vector<float> normals;
  normals.reserve(this->Values_.size() / 4 * 3);
  for (std::size_t i = 0; i < this->Values_.size(); i += 4) {
    const bool known = this->Values_[i + 3] > 0.0f;
    for (std::size_t k = 0; k < 3; ++k) {
      normals.push_back(known ? this->Values_[i + k] : std::numeric_limits<float>::quiet_NaN());
    }
  }
  return normals;
}

std::vector<float> AnglePicture::Degrees(Angle angle) const {
  std::vector<float> degrees;
  degrees.reserve(this->Values_.size() / 4);
  const bool defined = this->Sun_ || angle == Angle::Emission;
  for (std::size_t i = 0; i < this->Values_.size(); i += 4) {
    const bool known = defined && this->Values_[i + 3] > 0.0f;
    degrees.push_back(known ? this->Values_[i + std::size_t(angle)]
                            : std::numeric_limits<float>::quiet_NaN());
  }
  return degrees;
}

std::vector<float> AnglePicture::LitFractions() const {
  std::vector<float> fractions;
  fractions.reserve(this->Values_.size() / 4);
  for (std::size_t i = 3; i < this->Values_.size(); i += 4) {
    const bool known = this->Sun_ && this->Values_[i] > 0.0f;
    fractions.push_back(known ? this->Values_[i] - 1.0f : std::numeric_limits<float>::quiet_NaN());
  }
  return fractions;
}

} // namespace dspace
