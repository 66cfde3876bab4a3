#include <dspace/render/props/PropCanvas.h>

#include <algorithm>
#include <cmath>
#include <vector>

#include "vtk_glew.h"

#include "Copy_frag.h"
#include "LabelDepth_frag.h"
#include "PropLight_frag.h"
#include "StandardDepth_frag.h"

#include "vtkActor.h"
#include "vtkAssemblyNode.h"
#include "vtkAssemblyPath.h"
#include "vtkCamera.h"
#include "vtkDspaceHubWindow.h"
#include "vtkLight.h"
#include "vtkLinearTransform.h"
#include "vtkMatrix4x4.h"
#include "vtkOpenGLRenderer.h"
#include "vtkOpenGLState.h"
#include "vtkProp3D.h"
#include "vtkProperty.h"
#include "vtkRendererCollection.h"
#include "vtkShaderProgram.h"
#include "vtkSmartPointer.h"

#include <dspace/render/SurfaceShaders.h>
#include <dspace/render/props/PlacedPlanes.h>
#include <dspace/scene/GraphicsObject.h>

namespace dspace {
namespace {

// Puts a prop's coordinates into those of the view while it lives.
class PlacedProp {
public:
  PlacedProp(vtkProp3D* prop, const Eigen::Affine3d& X_VO)
      : Prop_(prop), Transform_(prop->GetUserTransform()), Matrix_(prop->GetUserMatrix()),
        Planes_(prop, X_VO) {
    vtkNew<vtkMatrix4x4> placed;
    for (int row = 0; row < 4; ++row) {
      for (int column = 0; column < 4; ++column) {
        placed->SetElement(row, column, X_VO.matrix()(row, column));
      }
    }
    if (this->Matrix_) {
      vtkMatrix4x4::Multiply4x4(placed, this->Matrix_, placed);
    }
    prop->SetUserMatrix(placed);
  }
  PlacedProp(const PlacedProp&) = delete;
  PlacedProp& operator=(const PlacedProp&) = delete;
  ~PlacedProp() {
    const bool byTransform = this->Transform_ && this->Transform_->GetMatrix() == this->Matrix_;
    if (byTransform) {
      this->Prop_->SetUserTransform(this->Transform_);
    } else {
      this->Prop_->SetUserMatrix(this->Matrix_);
    }
  }

private:
  vtkProp3D* Prop_;
  vtkSmartPointer<vtkLinearTransform> Transform_;
  vtkSmartPointer<vtkMatrix4x4> Matrix_;
  PlacedPlanes Planes_;
};

// Whether it is an actor that draws edges or points in place of surfaces.
bool IsLinesOrPoints(vtkProp* prop) {
  vtkActor* actor = vtkActor::SafeDownCast(prop);
  return actor && actor->GetProperty()->GetRepresentation() != VTK_SURFACE;
}

// Hides the parts of an assembly that draw edges or points while it lives.
class HiddenLines {
public:
  explicit HiddenLines(vtkProp* prop) {
    prop->InitPathTraversal();
    while (vtkAssemblyPath* path = prop->GetNextPath()) {
      vtkProp* part = path->GetLastNode()->GetViewProp();
      if (part != prop && part->GetVisibility() && IsLinesOrPoints(part)) {
        part->VisibilityOff();
        this->Parts_.push_back(part);
      }
    }
  }
  HiddenLines(const HiddenLines&) = delete;
  HiddenLines& operator=(const HiddenLines&) = delete;
  ~HiddenLines() {
    for (vtkProp* part : this->Parts_) {
      part->VisibilityOn();
    }
  }

private:
  std::vector<vtkProp*> Parts_;
};

struct Range {
  double near;
  double far;
};

// Distances along the view's axis between which the object lies, as far as the camera sees it.
Range RangeOf(const CustomDrawing& drawing) {
  const Projection& projection = drawing.view.projection;
  const BoundingSphere sphere = drawing.object.object->custom->Bounds();
  const Eigen::Affine3d& X_VO = drawing.object.X_VO;
  const double radius =
      1.001 * sphere.radius * X_VO.linear().jacobiSvd().singularValues().maxCoeff();
  const double middle = -(X_VO * sphere.center).z();
  Range range{middle - radius, middle + radius};
  if (projection.kind != Projection::Kind::Orthographic) {
    range.far = std::max(range.far, 2.0 * projection.Near());
    range.near = std::max({range.near, projection.Near(), 1e-5 * range.far});
  }
  range.far = std::max(range.far, range.near + 1e-6 * (std::abs(range.near) + 1e-9));
  return range;
}

} // namespace

// VTK's state between ours: no sRGB encoding, the canvas' renderer in the window. The bound target
// has the size of the view.
class PropCanvas::Drawing {
public:
  Drawing(PropCanvas& canvas, const CustomDrawing& drawing, vtkOpenGLFramebufferObject* framebuffer)
      : Window_(drawing.window), Slot_(drawing.window->GetSlot()),
        Encoding_(glIsEnabled(GL_FRAMEBUFFER_SRGB) != GL_FALSE) {
    glDisable(GL_FRAMEBUFFER_SRGB);
    this->Window_->GetState()->Push();
    this->Window_->Activate({framebuffer ? framebuffer : this->Slot_.framebuffer, canvas.Renderers_,
                             drawing.view.width, drawing.view.height});
  }
  Drawing(const Drawing&) = delete;
  Drawing& operator=(const Drawing&) = delete;
  ~Drawing() {
    glBindVertexArray(0);
    glBindBuffer(GL_ARRAY_BUFFER, 0);
    glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
    this->Window_->Activate(this->Slot_);
    this->Window_->GetState()->Pop();
    if (this->Encoding_) {
      glEnable(GL_FRAMEBUFFER_SRGB);
    }
  }

private:
  vtkDspaceHubWindow* Window_;
  vtkDspaceHubWindow::Slot Slot_;
  bool Encoding_;
};

PropCanvas::PropCanvas(vtkDspaceHubWindow* window)
    : Window_(window),
      Target_(window, RenderTarget::Format::Linear, RenderTarget::DepthFormat::Float),
      Layer_(window, RenderTarget::Format::Linear, RenderTarget::DepthFormat::Window),
      EmptyVertices_(window) {
  this->Renderers_->AddItem(this->Renderer_);
  this->Renderer_->SetRenderWindow(window);
  this->Renderer_->AutomaticLightCreationOff();
  vtkCamera* camera = this->Renderer_->GetActiveCamera();
  camera->SetPosition(0.0, 0.0, 0.0);
  camera->SetFocalPoint(0.0, 0.0, -1.0);
  camera->SetViewUp(0.0, 1.0, 0.0);
  camera->UseExplicitProjectionTransformMatrixOn();
}

PropCanvas::~PropCanvas() {
  this->Renderer_->SetRenderWindow(nullptr);
}

void PropCanvas::SetView(const CustomDrawing& drawing, const Eigen::Matrix4d& clip, double near,
                         double far) {
  vtkCamera* camera = this->Renderer_->GetActiveCamera();
  camera->SetParallelProjection(drawing.view.projection.kind == Projection::Kind::Orthographic);
  camera->SetClippingRange(near, far);
  vtkNew<vtkMatrix4x4> matrix;
  for (int row = 0; row < 4; ++row) {
    for (int column = 0; column < 4; ++column) {
      matrix->SetElement(row, column, clip(row, column));
    }
  }
  camera->SetExplicitProjectionTransformMatrix(matrix);
  this->SetLights(drawing.list);
}

// VTK shades display values, the scene linear light: colours are converted, ambient light has no
// counterpart.
void PropCanvas::SetLights(const DrawList& list) {
  this->Renderer_->RemoveAllLights();
  for (const DrawLight& light : list.Lights()) {
    vtkNew<vtkLight> placed;
    if (light.kind == Light::Kind::Head) {
      placed->SetLightTypeToHeadlight();
      placed->SetPosition(0.0, 0.0, 0.0);
      placed->SetFocalPoint(0.0, 0.0, -1.0);
    } else {
      const bool directional = light.kind == Light::Kind::Directional;
      const Eigen::Vector3d d =
          Eigen::Map<const Eigen::Vector3f>(light.direction.data()).cast<double>();
      const Eigen::Vector3d p =
          directional ? Eigen::Vector3d(-d)
                      : Eigen::Map<const Eigen::Vector3f>(light.position.data()).cast<double>();
      placed->SetPosition(p.x(), p.y(), p.z());
      placed->SetFocalPoint(p.x() + d.x(), p.y() + d.y(), p.z() + d.z());
      placed->SetPositional(!directional);
      placed->SetConeAngle(light.kind == Light::Kind::Spot
                               ? std::acos(double(light.cosCone)) * 180.0 / M_PI
                               : 180.0);
      placed->SetAttenuationValues(light.attenuation[0], light.attenuation[1],
                                   light.attenuation[2]);
    }
    const float largest = *std::max_element(light.color.begin(), light.color.end());
    const auto channel = [&](int i) {
      const double c = largest > 0.0f ? double(light.color[i]) / largest : 0.0;
      return c <= 0.0031308 ? 12.92 * c : 1.055 * std::pow(c, 1.0 / 2.4) - 0.055;
    };
    placed->SetColor(channel(0), channel(1), channel(2));
    placed->SetIntensity(largest);
    this->Renderer_->AddLight(placed);
  }
  this->Renderer_->UpdateLights();
}

void PropCanvas::DrawOpaque(vtkProp3D* prop, const CustomDrawing& drawing) {
  const DrawView& view = drawing.view;
  const Range range = RangeOf(drawing);
  const Drawing state(*this, drawing, nullptr);
  const PlacedProp placed(prop, drawing.object.X_VO);
  this->SetView(drawing, view.projection.ClipFromView(view.width, view.height), range.near,
                range.far);
  prop->SetAllocatedRenderTime(10.0, this->Renderer_); // no less detail to save time
  prop->RenderOpaqueGeometry(this->Renderer_);
}

void PropCanvas::DrawShadow(vtkProp3D* prop, const CustomDrawing& drawing) {
  if (IsLinesOrPoints(prop)) {
    return;
  }
  vtkOpenGLState* state = this->Window_->GetState();
  state->Push();
  {
    const HiddenLines hidden(prop);
    const PlacedProp placed(prop, drawing.object.X_VO);
    this->SetView(drawing, *drawing.view.clip, 0.0, 1.0);
    this->Renderer_->GetActiveCamera()->SetParallelProjection(true);
    prop->SetAllocatedRenderTime(10.0, this->Renderer_);
    prop->RenderOpaqueGeometry(this->Renderer_);
  }
  glBindVertexArray(0);
  glBindBuffer(GL_ARRAY_BUFFER, 0);
  state->Pop();
  glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
}

void PropCanvas::DrawIntoTarget(vtkProp3D* prop, const CustomDrawing& drawing) {
  vtkOpenGLState* state = this->Window_->GetState();
  state->PushFramebufferBindings();
  this->Target_.Resize(drawing.view.width, drawing.view.height);
  this->Target_.Bind();
  state->vtkglClearDepth(0.0);
  state->vtkglClear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
  state->vtkglClearDepth(1.0);
  this->DrawOpaque(prop, drawing);
  state->PopFramebufferBindings();
}

void PropCanvas::DrawLabel(vtkProp3D* prop, const CustomDrawing& drawing, ObjectId label) {
  this->DrawIntoTarget(prop, drawing);
  BindTextureUnit(this->Window_, OpaqueDepthUnit, GL_TEXTURE_2D, this->Target_.Depth());
  vtkShaderProgram* program = drawing.shaders.Screen(LabelDepth_frag);
  program->SetUniformi("depths", OpaqueDepthUnit);
  program->SetUniformi("label", static_cast<int>(label));
  this->EmptyVertices_.DrawScreen();
}

void PropCanvas::DrawLinear(vtkProp3D* prop, const CustomDrawing& drawing) {
  vtkOpenGLState* state = this->Window_->GetState();
  this->DrawIntoTarget(prop, drawing);
  state->vtkglDisable(GL_BLEND);
  BindTextureUnit(this->Window_, ColorUnit, GL_TEXTURE_2D, this->Target_.Color());
  BindTextureUnit(this->Window_, OpaqueDepthUnit, GL_TEXTURE_2D, this->Target_.Depth());
  vtkShaderProgram* program = drawing.shaders.Screen(PropLight_frag);
  program->SetUniformi("source", ColorUnit);
  program->SetUniformi("depths", OpaqueDepthUnit);
  this->EmptyVertices_.DrawScreen();
}

void PropCanvas::DrawTranslucent(vtkProp3D* prop, const CustomDrawing& drawing,
                                 const RenderTarget& target) {
  const DrawView& view = drawing.view;
  const Eigen::Matrix4d reversed = view.projection.ClipFromView(view.width, view.height);
  const auto [near, far] = RangeOf(drawing);
  Eigen::Matrix4d clip = reversed;
  float depthFromView[4];
  if (view.projection.kind == Projection::Kind::Orthographic) {
    clip(2, 2) = -2.0 / (far - near);
    clip(2, 3) = -(far + near) / (far - near);
    const double row[4] = {clip(2, 2), clip(2, 3) + 1.0, 0.0, 2.0};
    std::copy(row, row + 4, depthFromView);
  } else {
    clip(2, 2) = -(far + near) / (far - near);
    clip(2, 3) = -2.0 * far * near / (far - near);
    const double row[4] = {clip(2, 2) - 1.0, clip(2, 3), -2.0, 0.0};
    std::copy(row, row + 4, depthFromView);
  }
  const float viewFromDepth[4] = {float(reversed(3, 3)), float(-reversed(2, 3)),
                                  float(-reversed(3, 2)), float(reversed(2, 2))};
  vtkOpenGLState* gl = this->Window_->GetState();
  {
    this->Layer_.Resize(view.width, view.height);
    const Drawing state(*this, drawing, this->Layer_.Framebuffer());
    this->Layer_.Bind();
    gl->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl->vtkglClearColor(0.0f, 0.0f, 0.0f, 0.0f);
    gl->vtkglClear(GL_COLOR_BUFFER_BIT);
    // What the scene hides, between planes that lie close about the prop, in VTK's own depth.
    gl->vtkglColorMask(GL_FALSE, GL_FALSE, GL_FALSE, GL_FALSE);
    gl->vtkglDepthMask(GL_TRUE);
    gl->vtkglEnable(GL_DEPTH_TEST);
    gl->vtkglDepthFunc(GL_ALWAYS);
    BindTextureUnit(this->Window_, OpaqueDepthUnit, GL_TEXTURE_2D, target.Depth());
    vtkShaderProgram* program = drawing.shaders.Screen(StandardDepth_frag);
    program->SetUniformi("depths", OpaqueDepthUnit);
    program->SetUniform4f("viewFromDepth", viewFromDepth);
    program->SetUniform4f("depthFromView", depthFromView);
    this->EmptyVertices_.DrawScreen();
    gl->vtkglColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl->vtkglDepthFunc(GL_LEQUAL);
    gl->vtkglEnable(GL_BLEND);
    gl->vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE,
                               GL_ONE_MINUS_SRC_ALPHA);
    glClipControl(GL_LOWER_LEFT, GL_NEGATIVE_ONE_TO_ONE);
    const PlacedProp placed(prop, drawing.object.X_VO);
    this->SetView(drawing, clip, near, far);
    prop->SetAllocatedRenderTime(10.0, this->Renderer_);
    if (prop->HasTranslucentPolygonalGeometry()) {
      prop->RenderTranslucentPolygonalGeometry(this->Renderer_);
    }
    prop->RenderVolumetricGeometry(this->Renderer_);
  }
  // VTK blends display values, and so does this.
  gl->Push();
  const bool encoding = glIsEnabled(GL_FRAMEBUFFER_SRGB) != GL_FALSE;
  glDisable(GL_FRAMEBUFFER_SRGB);
  gl->vtkglDisable(GL_DEPTH_TEST);
  gl->vtkglEnable(GL_BLEND);
  gl->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ZERO, GL_ONE);
  BindTextureUnit(this->Window_, ColorUnit, GL_TEXTURE_2D, this->Layer_.Color());
  vtkShaderProgram* program = drawing.light
                                  ? drawing.shaders.Screen(PropLight_frag, "#define DSPACE_OVER\n")
                                  : drawing.shaders.Screen(Copy_frag);
  program->SetUniformi("source", ColorUnit);
  this->EmptyVertices_.DrawScreen();
  if (encoding) {
    glEnable(GL_FRAMEBUFFER_SRGB);
  }
  gl->Pop();
}

} // namespace dspace
