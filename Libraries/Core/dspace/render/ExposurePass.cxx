#include <dspace/render/ExposurePass.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "vtk_glew.h"

#include "Exposure_frag.h"
#include "Luminance_frag.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

namespace dspace {
namespace {

constexpr int GridSide = 256; // points that are metered; a picture with fewer has all
constexpr double Percentile = 0.99;
constexpr double Shown = 0.6; // what the percentile becomes

} // namespace

ExposurePass::ExposurePass(vtkDspaceHubWindow* window)
    : Window_(window), Shaders_(window),
      Light_(window, RenderTarget::Format::Light, RenderTarget::DepthFormat::Float),
      Luminances_(window, RenderTarget::Format::Light, RenderTarget::DepthFormat::None),
      EmptyVertices_(window) {}

ExposurePass::~ExposurePass() = default;

RenderTarget& ExposurePass::Target(int width, int height) {
  this->Light_.Resize(width, height);
  return this->Light_;
}

// The factor that automatic exposure gives the picture. The values are sorted, so that the order in
// which they were drawn does not count.
double ExposurePass::Metered() {
  vtkOpenGLState* state = this->Window_->GetState();
  const int across = std::min(this->Light_.Width(), GridSide);
  const int down = std::min(this->Light_.Height(), GridSide);
  this->Luminances_.Resize(across, down);
  state->PushFramebufferBindings();
  this->Luminances_.Bind();
  state->vtkglDisable(GL_DEPTH_TEST);
  state->vtkglDisable(GL_BLEND);
  BindTextureUnit(this->Window_, ColorUnit, GL_TEXTURE_2D, this->Light_.Color());
  const std::string defines = "#define DSPACE_GRID " + std::to_string(GridSide) + "\n";
  this->Shaders_.Screen(Luminance_frag, defines)->SetUniformi("source", ColorUnit);
  this->EmptyVertices_.DrawScreen();
  state->vtkglEnable(GL_DEPTH_TEST);
  state->PopFramebufferBindings();
  const std::vector<float> texels = this->Luminances_.ReadLight();
  std::vector<float> lit;
  for (std::size_t i = 0; i < texels.size(); i += 4) {
    if (texels[i] > 0.0f && std::isfinite(texels[i])) {
      lit.push_back(texels[i]);
    }
  }
  if (lit.empty()) {
    return 1.0;
  }
  const auto at = lit.begin() + std::ptrdiff_t(Percentile * double(lit.size() - 1));
  std::nth_element(lit.begin(), at, lit.end());
  return Shown / double(*at);
}

double ExposurePass::FactorFor(const ViewLook& look) {
  return look.exposure * (look.automaticExposure ? this->Metered() : 1.0);
}

void ExposurePass::Resolve(ToneCurve tone, double factor, RenderTarget& target) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  target.Bind();
  glEnable(GL_FRAMEBUFFER_SRGB);
  state->vtkglDisable(GL_BLEND);
  state->vtkglEnable(GL_DEPTH_TEST);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglDepthFunc(GL_ALWAYS);
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
  BindTextureUnit(this->Window_, ColorUnit, GL_TEXTURE_2D, this->Light_.Color());
  BindTextureUnit(this->Window_, OpaqueDepthUnit, GL_TEXTURE_2D, this->Light_.Depth());
  vtkShaderProgram* program = this->Shaders_.Screen(Exposure_frag);
  program->SetUniformi("source", ColorUnit);
  program->SetUniformi("depths", OpaqueDepthUnit);
  program->SetUniformf("exposure", float(std::min(factor, 1e30)));
  program->SetUniformi("filmic", tone == ToneCurve::Filmic ? 1 : 0);
  this->EmptyVertices_.DrawScreen();
  glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
  state->vtkglDepthFunc(GL_LEQUAL);
  state->vtkglEnable(GL_BLEND);
  glDisable(GL_FRAMEBUFFER_SRGB);
  state->PopFramebufferBindings();
}

} // namespace dspace
