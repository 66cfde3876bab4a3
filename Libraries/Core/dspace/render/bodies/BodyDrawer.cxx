#include <dspace/render/bodies/BodyDrawer.h>

#include <algorithm>
#include <cmath>

#include "vtk_glew.h"

#include "BodyAir_frag.h"
#include "BodyRays.h"
#include "BodyRing_frag.h"
#include "Body_frag.h"
#include "Body_vert.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/AstronomicalUnit.h>
#include <dspace/render/Capture.h>
#include <dspace/render/CustomDrawers.h>
#include <dspace/render/GpuStore.h>
#include <dspace/render/RenderTarget.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/scene/LinearLight.h>
#include <dspace/scene/Stretch.h>

namespace dspace {
namespace {

constexpr int MaximumRings = 16;
constexpr int AirSteps = 24; // of each ray

// Along each side of what a pixel sees of a small disc.
std::string DiscDefine(const BodyView& body, int samples) {
  const double radius = body.radius / samples; // [pixels]
  const int side = radius < 1.0 ? 48 : radius < 3.0 ? 24 : 12;
  return "#define DSPACE_DISC " + std::to_string(side) + "\n";
}

// How a body is drawn that is a point, or nearly one.
struct PointLook {
  double gain = 1.0;
  double spread = 0.0; // standard deviation of the point spread [samples]; 0: none
};

PointLook PointLookOf(const BodyShape& shape, const BodyView& body, const CustomDrawing& drawing) {
  PointLook look;
  if (shape.sun) {
    return look;
  }
  const double radius = body.radius / drawing.samples;
  const double part = std::clamp((radius - CelestialBody::PointRadius) /
                                     (CelestialBody::DiscRadius - CelestialBody::PointRadius),
                                 0.0, 1.0);
  const double share = 1.0 - part * part * (3.0 - 2.0 * part);
  look.gain = drawing.list.Filter().physicalOnly ? 1.0 : std::pow(shape.pointGain, share);
  look.spread = share * shape.pointSpread * drawing.samples;
  return look;
}

// From the disc to where its light makes no difference [samples].
double ReachOf(const BodyView& body, const CustomDrawing& drawing, double brightness,
               double variance) {
  constexpr double LeastLight = 1.0 / 16384.0;
  constexpr double MostReach = 256.0;
  constexpr double SunAtMercury = 11.0; // against that at 1 au
  // What is exposed later keeps at least a thousandth of the brightest sample.
  const double exposure = drawing.light ? 1.0 : drawing.view.look.exposure;
  const double least = drawing.light ? 1e3 : 2.0;
  const double light = SunAtMercury * brightness * exposure * body.radius * body.radius / variance;
  return std::min(std::sqrt(2.0 * variance * std::log(std::max(light / LeastLight, least))) + 1.0,
                  MostReach);
}

void SetMatrix(vtkShaderProgram* program, const char* name, const Eigen::Matrix3d& matrix) {
  Eigen::Matrix3f columns = matrix.cast<float>(); // column-major, as OpenGL reads it
  program->SetUniformMatrix3x3(name, columns.data());
}

void SetVector(vtkShaderProgram* program, const char* name, const Eigen::Vector3d& vector) {
  const Eigen::Vector3f values = vector.cast<float>();
  program->SetUniform3f(name, values.data());
}

void SetBox(vtkShaderProgram* program, const char* name, const Eigen::Vector4d& box) {
  const Eigen::Vector4f values = box.cast<float>();
  program->SetUniform4f(name, values.data());
}

Eigen::Vector3d Linear(const std::array<double, 3>& srgb) {
  const std::array<float, 3> linear = LinearColor(srgb);
  return {double(linear[0]), double(linear[1]), double(linear[2])};
}

// The bodies that may hide the Sun from some place within `radius` about `center` (view axes [m]):
// whose penumbra reaches there.
std::vector<DrawBody> BodiesBefore(const DrawList& list, const Eigen::Vector3d& center,
                                   double radius, const CelestialBody* self) {
  std::vector<DrawBody> found;
  const DrawBody& sun = *list.SunBody();
  const Eigen::Vector3d toSun = sun.center - center;
  const double away = toSun.norm();
  for (const DrawBody& body : list.Eclipsing()) {
    if (body.body == self) {
      continue;
    }
    const Eigen::Vector3d offset = body.center - center;
    const double along = offset.dot(toSun) / away;
    const double aside = (offset - along * toSun / away).norm();
    const double spread = std::max(0.0, along) * (sun.radius + radius) / std::max(away, 1.0);
    if (along > -radius && along < away && aside < radius + body.radius + 2.0 * spread) {
      found.push_back(body);
    }
  }
  return found;
}

struct PlacedSun {
  Eigen::Vector3d direction; // towards it from the body, unit, view axes
  Eigen::Vector3d light;     // its irradiance there, as linear light has it
};

// Of the directional light "sun" or the body that it comes from.
std::optional<PlacedSun> SunAt(const DrawList& list, const Eigen::Vector3d& center) {
  const auto towards = list.TowardsSun();
  if (!towards) {
    return std::nullopt;
  }
  PlacedSun sun;
  sun.direction = towards->cast<double>();
  sun.light = Eigen::Map<const Eigen::Vector3f>(list.Lights().front().color.data()).cast<double>();
  if (list.SunBody()) {
    const Eigen::Vector3d way = list.SunBody()->center - center;
    sun.direction = way.normalized();
    sun.light *= std::pow(AstronomicalUnit / way.norm(), 2);
  }
  return sun;
}

double DepthBufferOf(const DrawView& view, double depth) {
  const Eigen::Matrix4d clip = view.ClipFromView();
  return (clip(2, 2) * -depth + clip(2, 3)) / (clip(3, 2) * -depth + clip(3, 3));
}

} // namespace

void RegisterBodyDrawer(CustomDrawers& drawers) {
  drawers.Register(typeid(CelestialBody),
                   [](const std::shared_ptr<const CustomGeometry>& geometry) {
                     return std::make_unique<BodyDrawer>(
                         std::static_pointer_cast<const CelestialBody>(geometry));
                   });
}

BodyDrawer::~BodyDrawer() {
  if (this->Array_) {
    glDeleteVertexArrays(1, &this->Array_);
  }
  if (this->Air_) {
    glDeleteTextures(1, &this->Air_);
  }
}

void BodyDrawer::DrawBox() {
  if (!this->Array_) {
    glGenVertexArrays(1, &this->Array_);
  }
  glBindVertexArray(this->Array_);
  glDrawArrays(GL_TRIANGLE_STRIP, 0, 4);
  glBindVertexArray(0);
}

bool BodyDrawer::IsSmall(const BodyView& body, const CustomDrawing& drawing) {
  return body.radius < CelestialBody::SmallRadius * drawing.samples;
}

double BodyDrawer::NearestDepth(const CustomDrawing& drawing) {
  const auto body = this->Body_.lock();
  const Eigen::Affine3d& X = drawing.object.X_VO;
  const double distance = X.translation().norm() - body->Bounds().radius * LargestStretch(X);
  return std::max(distance, 0.0);
}

vtkShaderProgram* BodyDrawer::Ready(const CustomDrawing& drawing, const BodyView& body,
                                    SurfaceShaders::Features features, const std::string& defines,
                                    const char* fragment) {
  ShaderPages pages;
  pages.vertex = Body_vert;
  pages.fragment = BodyRays;
  pages.whole = fragment;
  pages.defines = defines;
  const auto shape = this->Body_.lock();
  const DrawView& view = drawing.view;
  std::vector<DrawBody> before;
  const Eigen::Affine3d& X_VO = drawing.object.X_VO;
  if (features & SurfaceShaders::Eclipses) {
    before = BodiesBefore(
        drawing.list, X_VO.translation(), shape->Bounds().radius * LargestStretch(X_VO),
        shape->Shape().rings.empty() || fragment == Body_frag ? shape.get() : nullptr);
    features &= before.empty() ? ~SurfaceShaders::Features(SurfaceShaders::Eclipses)
                               : ~SurfaceShaders::Features(0);
  }
  vtkShaderProgram* program = drawing.shaders.Surface(features, pages);
  drawing.shaders.SetView(program, drawing.list, view, drawing.samples);
  SetBox(program, "boxNDC", body.BoxNDC(view));
  const float pivot[2] = {float(body.pivot.x()), float(body.pivot.y())};
  program->SetUniform2f("pivot", pivot);
  SetMatrix(program, "viewOrigin", body.viewOrigin);
  SetMatrix(program, "viewDirection", body.viewDirection);
  SetMatrix(program, "rayOrigin", body.rayOrigin);
  SetMatrix(program, "rayDirection", body.rayDirection);
  program->SetUniformf("gap", body.near ? float(body.gap) : -2.0f);
  const Eigen::Matrix4d clip = view.ClipFromView();
  const float rows[2][2] = {{float(-clip(2, 2)), float(clip(2, 3))},
                            {float(-clip(3, 2)), float(clip(3, 3))}};
  program->SetUniform2fv("depthRows", 2, rows);
  if (features & SurfaceShaders::Eclipses) {
    SurfaceShaders::SetEclipses(program, before, *drawing.list.SunBody(), X_VO.inverse());
  }
  return program;
}

void BodyDrawer::DrawSurface(const CustomDrawing& drawing, const BodyView& view, bool small) {
  const auto body = this->Body_.lock();
  const BodyShape& shape = body->Shape();
  const MaterialOverride& material = drawing.object.object->material;
  const bool angles = drawing.labels;
  const bool lit = material.lit.value_or(true) && !shape.sun;
  Reflectance reflectance = material.reflectance.value_or(Reflectance());
  SurfaceShaders::Features features = 0;
  if (angles) {
    features =
        SurfaceShaders::WithoutMaps(SurfaceShaders::AngleFeatures(drawing.list, drawing.view, lit));
  } else {
    if (lit) {
      features |= SurfaceShaders::LightFeatures(drawing.list, drawing.view);
      features |= SurfaceShaders::ReflectanceFeature(reflectance);
      features = small ? SurfaceShaders::WithoutMaps(features) : features;
    } else if (drawing.light && !shape.sun) {
      features |= SurfaceShaders::DisplayColor;
    }
  }
  const std::shared_ptr<const Image> texture = material.texture.value_or(nullptr);
  features |= texture && !angles ? SurfaceShaders::Texture : 0u;
  std::string defines;
  if (small) {
    defines = DiscDefine(view, drawing.samples);
  }
  const PointLook point = small ? PointLookOf(shape, view, drawing) : PointLook();
  if (point.spread > 0.0) {
    defines = "#define DSPACE_DISC 16\n#define DSPACE_SPREAD\n";
  }
  vtkShaderProgram* program = this->Ready(drawing, view, features, defines, Body_frag);
  if (point.spread > 0.0) {
    // That of a sample's square is added.
    const double variance = point.spread * point.spread + 1.0 / 12.0;
    const double brightness = point.gain * std::max(shape.brightness, 1.0);
    const float values[2] = {float(0.5 / variance), float(0.5 / (M_PI * variance))};
    program->SetUniform2f("discSpread", values);
    SetBox(program, "boxNDC",
           view.BoxNDC(drawing.view, ReachOf(view, drawing, brightness, variance)));
  }
  const Eigen::Matrix3d linear = drawing.object.X_VO.linear();
  SetVector(program, "bodyRadii", shape.radii);
  SetMatrix(program, "viewFromNormal",
            linear.inverse().transpose() * std::cbrt(std::abs(linear.determinant())));
  Eigen::Vector3d color = Linear(material.color.value_or(std::array<double, 3>{1, 1, 1}));
  SetVector(program, "bodyColor", color * (shape.sun ? 0.0 : shape.brightness * point.gain));
  Eigen::Vector3d emission = Linear(material.emissive.value_or(std::array<double, 3>{0, 0, 0}));
  emission *= point.gain * (drawing.light ? 1.0 : drawing.view.look.exposure);
  if (shape.sun) {
    // A disc of even radiance whose irradiance at 1 au is the light's.
    const double sine = shape.radii.maxCoeff() / AstronomicalUnit;
    Eigen::Vector3d light =
        Eigen::Vector3d::Ones() * (drawing.light ? 1.0 : drawing.view.look.exposure);
    if (!drawing.list.Lights().empty() && drawing.list.Lights().front().sun) {
      light = Eigen::Map<const Eigen::Vector3f>(drawing.list.Lights().front().color.data())
                  .cast<double>();
    }
    emission = light / (sine * sine);
  }
  SetVector(program, "bodyEmission", emission);
  if (SurfaceShaders::ReflectanceFeature(reflectance) != 0 && lit && !angles) {
    SurfaceShaders::SetReflectance(program, reflectance);
  }
  if (texture && !angles) {
    BindTextureUnit(drawing.window, ColorUnit, GL_TEXTURE_2D,
                    drawing.store.TextureOf(texture, true));
    const float rows[3] = {float(shape.leftEdge_deg / 360.0), float(texture->height),
                           shape.geodetic ? 1.0f : 0.0f};
    program->SetUniform3f("textureRows", rows);
  }
  if (small) {
    SetBox(program, "discBox", view.box);
    program->SetUniformf("discDepth", float(DepthBufferOf(drawing.view, view.nearest)));
  }
  this->DrawBox();
  ++drawing.statistics.drawCalls;
}

void BodyDrawer::SetBoxWithin(const CustomDrawing& drawing, vtkShaderProgram* program,
                              const Eigen::Vector3d& radii) {
  const BodyView around(drawing.object.X_VO, radii, drawing.view);
  SetBox(program, "boxNDC",
         around.seen ? around.BoxNDC(drawing.view) : Eigen::Vector4d(-1.0, -1.0, 1.0, 1.0));
}

void BodyDrawer::DrawRings(const CustomDrawing& drawing, const BodyView& view) {
  const auto body = this->Body_.lock();
  const BodyShape& shape = body->Shape();
  const auto sun = SunAt(drawing.list, drawing.object.X_VO.translation());
  const int count = std::min<int>(int(shape.rings.size()), MaximumRings);
  SurfaceShaders::Features features = 0;
  if (sun) {
    features = SurfaceShaders::LightFeatures(drawing.list, drawing.view) &
               SurfaceShaders::Features(SurfaceShaders::Eclipses);
  }
  vtkShaderProgram* program =
      this->Ready(drawing, view, features,
                  "#define DSPACE_RINGS " + std::to_string(MaximumRings) + "\n", BodyRing_frag);
  this->SetBoxWithin(drawing, program, Eigen::Vector3d::Constant(shape.rings.back().outer));
  float band[MaximumRings][3] = {};
  float color[MaximumRings][3] = {};
  for (int i = 0; i < count; ++i) {
    const RingBand& ring = shape.rings[std::size_t(i)];
    band[i][0] = float(ring.inner);
    band[i][1] = float(ring.outer);
    band[i][2] = float(ring.opticalDepth);
    const Eigen::Vector3d linear = Linear(ring.color);
    for (int k = 0; k < 3; ++k) {
      color[i][k] = float(linear[k]);
    }
  }
  program->SetUniformi("opaqueDepth", OpaqueDepthUnit);
  program->SetUniformi("ringCount", count);
  program->SetUniform3fv("ringBand", MaximumRings, band);
  program->SetUniform3fv("ringColor", MaximumRings, color);
  SetVector(program, "bodyRadii", shape.radii);
  const Eigen::Matrix3d back = drawing.object.X_VO.linear().inverse();
  const Eigen::Vector3d inBody =
      sun ? (back * sun->direction).normalized() : Eigen::Vector3d(0, 0, 1);
  SetVector(program, "sunBody", inBody);
  SetVector(program, "sunRay", inBody.cwiseQuotient(shape.radii).normalized());
  SetVector(program, "sunLight", sun ? sun->light : Eigen::Vector3d::Zero());
  this->DrawBox();
  ++drawing.statistics.drawCalls;
}

void BodyDrawer::DrawAir(const CustomDrawing& drawing, const BodyView& view) {
  const auto body = this->Body_.lock();
  const BodyShape& shape = body->Shape();
  const Atmosphere& air = *shape.atmosphere;
  const auto sun = SunAt(drawing.list, drawing.object.X_VO.translation());
  if (!this->Air_) {
    const AirTable table(air, shape.radii.x());
    glGenTextures(1, &this->Air_);
    BindTextureUnit(drawing.window, ColorUnit, GL_TEXTURE_2D, this->Air_);
    glTexImage2D(GL_TEXTURE_2D, 0, GL_RGB32F, AirTable::Columns, AirTable::Rows, 0, GL_RGB,
                 GL_FLOAT, table.values.data());
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, GL_LINEAR);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
  }
  SurfaceShaders::Features features = 0;
  if (sun) {
    features = SurfaceShaders::LightFeatures(drawing.list, drawing.view) &
               SurfaceShaders::Features(SurfaceShaders::Eclipses);
  }
  vtkShaderProgram* program =
      this->Ready(drawing, view, features,
                  "#define DSPACE_AIR_STEPS " + std::to_string(AirSteps) + "\n", BodyAir_frag);
  this->SetBoxWithin(drawing, program, shape.radii + Eigen::Vector3d::Constant(air.top * 1.01));
  BindTextureUnit(drawing.window, ColorUnit, GL_TEXTURE_2D, this->Air_);
  program->SetUniformi("airTable", ColorUnit);
  program->SetUniformi("opaqueDepth", OpaqueDepthUnit);
  SetVector(program, "bodyRadii", shape.radii);
  program->SetUniformf("airTop", float(air.top / shape.radii.x()));
  SetVector(program, "airRayleigh", air.rayleigh);
  SetVector(program, "airMie", air.mie);
  SetVector(program, "airMieExtinction", air.mieExtinction);
  SetVector(program, "airHeights", {air.rayleighHeight, air.mieHeight, air.mieAsymmetry});
  const Eigen::Matrix3d back = drawing.object.X_VO.linear().inverse();
  const Eigen::Vector3d toSun = sun ? sun->direction : Eigen::Vector3d(0, 0, 1);
  SetVector(program, "sunVC", toSun);
  SetVector(program, "sunRay", (back * toSun).cwiseQuotient(shape.radii).normalized());
  SetVector(program, "sunLight",
            sun ? Eigen::Vector3d(M_PI * sun->light) : Eigen::Vector3d::Zero());
  this->DrawBox();
  ++drawing.statistics.drawCalls;
}

void BodyDrawer::DrawColor(const CustomDrawing& drawing) {
  const auto body = this->Body_.lock();
  const BodyView view(drawing.object.X_VO, body->Shape().radii, drawing.view);
  if (view.seen && !drawing.object.covered && !IsSmall(view, drawing)) {
    this->DrawSurface(drawing, view, false);
  }
}

void BodyDrawer::DrawLabels(const CustomDrawing& drawing) {
  if (drawing.view.clip || drawing.object.covered) {
    return; // a shadow map, or its ground has the label
  }
  const auto body = this->Body_.lock();
  const BodyView view(drawing.object.X_VO, body->Shape().radii, drawing.view);
  if (!view.seen) {
    return;
  }
  const bool small = IsSmall(view, drawing);
  const std::string defines = small ? DiscDefine(view, drawing.samples) : "";
  vtkShaderProgram* program = this->Ready(drawing, view, SurfaceShaders::Label, defines, Body_frag);
  program->SetUniformi("objectLabel", int(drawing.object.object->id));
  if (small) {
    SetBox(program, "discBox", view.box);
    program->SetUniformf("discDepth", float(DepthBufferOf(drawing.view, view.nearest)));
  }
  this->DrawBox();
}

bool BodyDrawer::DrawAngles(const CustomDrawing& drawing) {
  if (drawing.object.covered) {
    return true; // those of its ground
  }
  const auto body = this->Body_.lock();
  const BodyView view(drawing.object.X_VO, body->Shape().radii, drawing.view);
  if (body->Shape().sun || (view.seen && IsSmall(view, drawing))) {
    return false;
  }
  if (view.seen) {
    CustomDrawing angles = drawing;
    angles.labels = true; // no colours
    this->DrawSurface(angles, view, false);
  }
  return true;
}

void BodyDrawer::DrawTranslucent(const CustomDrawing& drawing, const RenderTarget& target) {
  const auto body = this->Body_.lock();
  const BodyView view(drawing.object.X_VO, body->Shape().radii, drawing.view);
  // The target's depth is read, not written.
  vtkOpenGLState* state = drawing.window->GetState();
  state->vtkglDisable(GL_DEPTH_TEST);
  state->vtkglDepthMask(GL_FALSE);
  state->vtkglEnable(GL_BLEND);
  BindTextureUnit(drawing.window, OpaqueDepthUnit, GL_TEXTURE_2D, target.Depth());
  if (view.seen && !drawing.object.covered && IsSmall(view, drawing)) {
    state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    this->DrawSurface(drawing, view, true);
  }
  if (!body->Shape().rings.empty()) {
    state->vtkglBlendFuncSeparate(GL_ONE, GL_ONE_MINUS_SRC_ALPHA, GL_ONE_MINUS_DST_ALPHA, GL_ONE);
    this->DrawRings(drawing, view);
  }
  if (body->Shape().atmosphere && !IsSmall(view, drawing)) {
    // What is behind, times a colour; its alpha stays, and what is only background is exposed now.
    state->vtkglBlendFuncSeparate(GL_ONE, GL_SRC1_COLOR, GL_ONE, GL_ONE);
    this->DrawAir(drawing, view);
  }
  state->vtkglDisable(GL_BLEND);
  state->vtkglBlendFuncSeparate(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA, GL_ONE,
                                GL_ONE_MINUS_SRC_ALPHA);
  state->vtkglDepthMask(GL_TRUE);
  state->vtkglEnable(GL_DEPTH_TEST);
}

} // namespace dspace
