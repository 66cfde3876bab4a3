#include <dspace/render/SurfaceShaders.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <limits>

#include "vtk_glew.h"

#include "DepthPeel.h"
#include "Eclipse.h"
#include "Instance_vert.h"
#include "Label_frag.h"
#include "Lighting.h"
#include "Photometry.h"
#include "Plane_frag.h"
#include "Screen_vert.h"
#include "Shadow.h"
#include "SunMask_frag.h"
#include "Surface_frag.h"
#include "Tone.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/Error.h>
#include <dspace/render/CodedShaders.h>

namespace dspace {
namespace {

void Replace(std::string& text, const std::string& marker, const std::string& by) {
  const auto at = text.find(marker);
  if (at != std::string::npos) {
    text.replace(at, marker.size(), by);
  }
}

// One definition a feature, in place of the marker.
std::string WithDefines(const char* source, const std::string& defines) {
  std::string text = source;
  Replace(text, "//DSPACE::Defines", defines);
  return text;
}
vtkShaderProgram* Ready(vtkDspaceHubWindow* window, const std::string& vertex,
                        const std::string& fragment) {
  vtkShaderProgram* program =
      window->GetShaderCache()->ReadyShaderProgram(vertex.c_str(), fragment.c_str(), "");
  if (!program) {
    throw Error(Error::Kind::Internal, "shader", "the OpenGL driver failed to compile it");
  }
  return program;
}

} // namespace

void BindTextureUnit(vtkDspaceHubWindow* window, int unit, unsigned int target, unsigned int name) {
  window->GetState()->vtkglActiveTexture(GL_TEXTURE0 + unit);
  glBindTexture(target, name);
}

SurfaceShaders::Features SurfaceShaders::ShadowFeatures(const DrawView& view) {
  const std::size_t cascades = view.shadows ? view.shadows->cascades.size() : 0;
  const std::size_t grounds = cascades > 0 && view.shadowGrounds ? view.shadowGrounds->size() : 0;
  return Lit | static_cast<unsigned>(cascades << CascadeShift) |
         static_cast<unsigned>(grounds << GroundShift);
}

namespace {

// The Sun's own disc is that of its shadows.
bool IsDisc(const DrawLight& light) {
  constexpr float Narrow = 0.005f; // [rad], about the Sun's: its Lambertian cosine is enough
  return light.kind == Light::Kind::Directional && !light.sun && light.radius > Narrow;
}

} // namespace

SurfaceShaders::Features SurfaceShaders::LightFeatures(const DrawList& list, const DrawView& view) {
  const auto lights = std::min<std::size_t>(list.Lights().size(), MaximumLights);
  Features features = ShadowFeatures(view) | static_cast<unsigned>(lights << LightShift);
  for (std::size_t i = 0; i < lights; ++i) {
    features |= list.Lights()[i].kind == Light::Kind::Directional ? 0u : PlacedLights;
    features |= IsDisc(list.Lights()[i]) ? DiscLights : 0u;
  }
  if (list.SunBody() && list.TowardsSun()) {
    features |= SunPlace | (list.Eclipsing().empty() ? 0u : Features(Eclipses));
  }
  return features;
}

SurfaceShaders::Features SurfaceShaders::AngleFeatures(const DrawList& list, const DrawView& view,
                                                       bool lit) {
  if (!lit) {
    return Angles;
  }
  return Angles | ShadowFeatures(view) | (LightFeatures(list, view) & Features(Eclipses));
}

SurfaceShaders::Features SurfaceShaders::ReflectanceFeature(const Reflectance& reflectance) {
  const auto model = static_cast<unsigned>(reflectance.model);
  return model > static_cast<unsigned>(Reflectance::Model::Lambert) ? model << ReflectanceShift : 0;
}

void SurfaceShaders::SetReflectance(vtkShaderProgram* program, const Reflectance& reflectance) {
  float values[2][4] = {};
  if (reflectance.model == Reflectance::Model::LunarLambert) {
    const std::array<double, 4> powers = LunarWeightPowers(reflectance);
    std::copy(powers.begin(), powers.end(), values[0]);
  } else if (reflectance.model == Reflectance::Model::Hapke) {
    const double gamma = std::sqrt(1.0 - reflectance.singleScatteringAlbedo);
    // Cotangents stay finite: what differs is seen in the last hundredth of a degree.
    const double tangent = std::tan(std::max(reflectance.roughness_deg, 0.01) * M_PI / 180.0);
    values[0][0] = float(reflectance.singleScatteringAlbedo);
    values[0][1] = float(reflectance.phaseAsymmetry);
    values[0][2] = float(reflectance.phasePartition);
    values[0][3] = float(reflectance.oppositionAmplitude);
    values[1][0] = float(reflectance.oppositionWidth);
    values[1][1] = float(tangent);
    values[1][2] = float(1.0 / std::sqrt(1.0 + M_PI * tangent * tangent));
    values[1][3] = float((1.0 - gamma) / (1.0 + gamma));
  }
  program->SetUniform4fv("reflectanceValues", 2, values);
}

void SurfaceShaders::Release() {
  this->Surfaces_.clear();
  this->Coded_.clear();
  this->Screens_.clear();
  this->Programs_.clear();
  this->SunMasks_.clear();
  this->Uniforms_.clear();
}

bool SurfaceShaders::HasUniforms(vtkShaderProgram* program, const void* bytes, std::size_t size) {
  if (!this->Window_->NoteUniformsOf(this)) {
    this->Uniforms_.clear();
  }
  std::vector<unsigned char>& last = this->Uniforms_[program];
  if (last.size() == size && std::memcmp(last.data(), bytes, size) == 0) {
    return true;
  }
  const auto* first = static_cast<const unsigned char*>(bytes);
  last.assign(first, first + size);
  return false;
}

namespace {

// How many shadow maps there are, and what reading them needs.
std::string ShadowDefines(SurfaceShaders::Features features) {
  const unsigned cascades = features >> SurfaceShaders::CascadeShift & 15u;
  return std::string(cascades != 0 ? "#extension GL_ARB_texture_gather : require\n" : "") +
         "#define DSPACE_CASCADES " + std::to_string(cascades) + "\n#define DSPACE_GROUNDS " +
         std::to_string(features >> SurfaceShaders::GroundShift & 3u) + "\n";
}

} // namespace

SurfaceShaders::Features SurfaceShaders::CodeFeatures(const Mesh& mesh, bool textured) {
  const bool triangles = mesh.primitive == Mesh::Primitive::Triangles;
  return (textured ? Texture : 0u) | (mesh.colors.empty() ? 0u : VertexColor) |
         (!mesh.normals.empty() ? Normals
          : triangles           ? Flat
                                : 0u);
}

SurfaceShaders::Sources SurfaceShaders::SourcesFor(Features features, const ShaderPages& pages,
                                                   const ShaderCode* code) {
  std::string defines = pages.defines;
  const auto define = [&](Features feature, const char* name) {
    if (features & feature) {
      defines += std::string("#define ") + name + "\n";
    }
  };
  define(Lit, "DSPACE_LIT");
  define(Texture, "DSPACE_TEXTURE");
  define(VertexColor, "DSPACE_VERTEX_COLOR");
  define(Billboard, "DSPACE_BILLBOARD");
  define(Peel, "DSPACE_PEEL");
  define(Label, "DSPACE_LABEL");
  define(Emissive, "DSPACE_EMISSIVE");
  define(Specular, "DSPACE_SPECULAR");
  define(PlacedLights, "DSPACE_PLACED_LIGHTS");
  define(Mixed, "DSPACE_MIXED");
  define(NormalMap, "DSPACE_NORMAL_MAP");
  define(ObjectNormals, "DSPACE_OBJECT_NORMALS");
  define(Normals, "DSPACE_NORMALS");
  define(Flat, "DSPACE_FLAT");
  define(DiscLights, "DSPACE_DISC_LIGHTS");
  define(SunPlace, "DSPACE_SUN_PLACE");
  define(Angles, "DSPACE_ANGLES");
  define(DisplayColor, "DSPACE_DISPLAY_COLOR");
  define(LitMask, "DSPACE_LIT_MASK");
  if (features & Eclipses) {
    defines += "#define DSPACE_ECLIPSES " + std::to_string(MaximumEclipsing) + "\n";
  }
  defines += "#define DSPACE_LIGHT_COUNT " + std::to_string(features >> LightShift & 15u) + "\n";
  const unsigned model = features >> ReflectanceShift & 7u;
  if (model != 0) {
    defines += "#define DSPACE_REFLECTANCE " + std::to_string(model) + "\n";
  }
  defines = ShadowDefines(features) + defines; // an extension stands first
  Sources made;
  if (code) {
    const CodedSources coded = SourcesOf(*code);
    made.vertex = WithDefines(coded.vertex.c_str(), defines);
    made.fragment = WithDefines(coded.fragment.c_str(), defines);
  } else {
    made.vertex = WithDefines(pages.vertex ? pages.vertex : Instance_vert, defines);
    const char* whole = features & Label    ? Label_frag
                        : features & Planes ? Plane_frag
                                            : Surface_frag;
    made.fragment = WithDefines(pages.whole ? pages.whole : whole, defines);
    Replace(made.fragment, "//DSPACE::Functions", pages.fragment ? pages.fragment : "");
  }
  Replace(made.fragment, "//DSPACE::Lighting",
          std::string(Shadow) + Eclipse + Photometry + Lighting);
  Replace(made.fragment, "//DSPACE::Peeling", DepthPeel);
  Replace(made.fragment, "//DSPACE::Tone", Tone);
  return made;
}

vtkShaderProgram* SurfaceShaders::Surface(Features features, const ShaderPages& pages,
                                          const std::shared_ptr<const ShaderCode>& code) {
  if (code && this->Coded_.count(code.get()) == 0) {
    for (auto it = this->Coded_.begin(); it != this->Coded_.end();) { // code that no object has
      it = it->second.code.use_count() == 1 ? this->Coded_.erase(it) : std::next(it);
    }
    this->Coded_[code.get()].code = code;
  }
  vtkShaderProgram*& program =
      code ? this->Coded_[code.get()].programs[features]
           : this->Surfaces_[{features, pages.vertex, pages.fragment, pages.whole, pages.defines}];
  if (program) {
    this->Window_->GetShaderCache()->ReadyShaderProgram(program);
  } else {
    const Sources sources = SourcesFor(features, pages, code.get());
    program = Ready(this->Window_, sources.vertex, sources.fragment);
  }
  return program;
}

vtkShaderProgram* SurfaceShaders::Program(const char* vertex, const char* fragment) {
  vtkShaderProgram*& program = this->Programs_[{vertex, fragment}];
  if (program) {
    this->Window_->GetShaderCache()->ReadyShaderProgram(program);
  } else {
    program = Ready(this->Window_, WithDefines(vertex, ""), WithDefines(fragment, ""));
  }
  return program;
}

vtkShaderProgram* SurfaceShaders::Screen(const char* fragment, const std::string& defines) {
  vtkShaderProgram*& program = this->Screens_[{fragment, defines}];
  if (program) {
    this->Window_->GetShaderCache()->ReadyShaderProgram(program);
  } else {
    std::string text = WithDefines(fragment, defines);
    Replace(text, "//DSPACE::Tone", Tone);
    program = Ready(this->Window_, WithDefines(Screen_vert, ""), text);
  }
  return program;
}

SurfaceShaders::Sources SurfaceShaders::SunMaskSources(Features features) {
  Sources made{WithDefines(Screen_vert, ""), WithDefines(SunMask_frag, ShadowDefines(features))};
  Replace(made.fragment, "//DSPACE::Shadow", Shadow);
  return made;
}

vtkShaderProgram* SurfaceShaders::SunMask(const DrawList& list, const DrawView& view,
                                          unsigned int planes) {
  const Features features = ShadowFeatures(view);
  vtkShaderProgram*& program = this->SunMasks_[features];
  if (program) {
    this->Window_->GetShaderCache()->ReadyShaderProgram(program);
  } else {
    const Sources sources = SunMaskSources(features);
    program = Ready(this->Window_, sources.vertex, sources.fragment);
  }
  this->SetView(program, list, view, 1);
  const float size[2] = {float(view.width), float(view.height)};
  program->SetUniform2f("viewSize", size);
  BindTextureUnit(this->Window_, ColorUnit, GL_TEXTURE_2D, planes);
  program->SetUniformi("planes", ColorUnit);
  return program;
}

void SurfaceShaders::SetView(vtkShaderProgram* program, const DrawList& list, const DrawView& view,
                             int samples, bool firstLayer) {
  const Eigen::Matrix4f clip = view.ClipFromView().cast<float>();
  Eigen::Matrix4f columns = clip; // column-major, as OpenGL reads it
  program->SetUniformMatrix4x4("VCDCMatrix", columns.data());
  // Of the picture, not of the n x n samples that are drawn of it.
  const float pixel[2] = {2.0f * static_cast<float>(samples) / static_cast<float>(view.width),
                          2.0f * static_cast<float>(samples) / static_cast<float>(view.height)};
  program->SetUniform2f("pixelNDC", pixel);
  program->SetUniformi("colorTexture", ColorUnit);
  program->SetUniformi("normalTexture", NormalUnit);
  program->SetUniformi("opaqueDepth", OpaqueDepthUnit);
  program->SetUniformi("peeledDepth", PeeledDepthUnit);
  program->SetUniformi("firstLayer", firstLayer ? 1 : 0);
  program->SetUniformi("cameraParallel",
                       view.projection.kind == Projection::Kind::Orthographic ? 1 : 0);
  program->SetUniform3f("ambientLight", list.Ambient().data());
  if (program->IsUniformUsed("towardsSunVC")) {
    const Eigen::Vector3f toSun = list.TowardsSun().value_or(Eigen::Vector3f::Zero());
    program->SetUniform3f("towardsSunVC", toSun.data());
  }
  if (program->IsUniformUsed("writeNormals")) {
    program->SetUniformi("writeNormals", view.normals ? 1 : 0);
  }

  if (list.SunBody() && program->IsUniformUsed("sunPlaceVC")) {
    const Eigen::Vector3f place = list.SunBody()->center.cast<float>();
    program->SetUniform3f("sunPlaceVC", place.data());
  }
  if (list.SunBody() && program->IsUniformUsed("eclipsingCount")) {
    SetEclipses(program, list.Eclipsing(), *list.SunBody(), Eigen::Affine3d::Identity());
  }

  if (program->IsUniformUsed("litColors")) {
    program->SetUniformi("litColors", view.look.shadows.litColors ? 1 : 0);
  }
  if (program->IsUniformUsed("litMask")) {
    BindTextureUnit(this->Window_, ShadowUnit, GL_TEXTURE_2D, this->LitMask_);
    program->SetUniformi("litMask", ShadowUnit);
  }
  if (view.shadows && program->IsUniformUsed("shadowMaps")) {
    this->SetShadows(program, *view.shadows);
    program->SetUniformi("cascadeColors", view.look.shadows.cascadeColors ? 1 : 0);
  }

  const int count = std::min<int>(static_cast<int>(list.Lights().size()), MaximumLights);
  if (count == 0 || !program->IsUniformUsed("lightColor")) {
    return;
  }
  int kind[MaximumLights] = {};
  float color[MaximumLights][3] = {};
  float direction[MaximumLights][3] = {};
  float position[MaximumLights][3] = {};
  float attenuation[MaximumLights][3] = {};
  float cosCone[MaximumLights] = {};
  float disc[MaximumLights][2] = {};
  for (int i = 0; i < count; ++i) {
    const DrawLight& light = list.Lights()[i];
    kind[i] = static_cast<int>(light.kind);
    cosCone[i] = light.cosCone;
    if (IsDisc(light)) {
      disc[i][0] = std::sin(light.radius);
      disc[i][1] = std::max(0.0f, std::cos(light.radius) / disc[i][0]);
    }
    std::copy(light.color.begin(), light.color.end(), color[i]);
    std::copy(light.direction.begin(), light.direction.end(), direction[i]);
    std::copy(light.position.begin(), light.position.end(), position[i]);
    std::copy(light.attenuation.begin(), light.attenuation.end(), attenuation[i]);
  }
  program->SetUniform1iv("lightKind", count, kind);
  program->SetUniform3fv("lightColor", count, color);
  program->SetUniform3fv("lightDirectionVC", count, direction);
  program->SetUniform3fv("lightPositionVC", count, position);
  program->SetUniform3fv("lightAttenuation", count, attenuation);
  program->SetUniform1fv("lightCosCone", count, cosCone);
  if (program->IsUniformUsed("lightDisc")) {
    program->SetUniform2fv("lightDisc", count, disc);
  }
}

void SurfaceShaders::SetEclipses(vtkShaderProgram* program, const std::vector<DrawBody>& bodies,
                                 const DrawBody& sun, const Eigen::Affine3d& X) {
  const int count = std::min<int>(int(bodies.size()), MaximumEclipsing);
  float place[MaximumEclipsing][3] = {};
  float unit[3 * MaximumEclipsing][3] = {};
  const Eigen::Matrix3d back = X.linear().inverse();
  for (int i = 0; i < count; ++i) {
    const Eigen::Vector3d center = X * bodies[std::size_t(i)].center;
    const Eigen::Matrix3d axes = bodies[std::size_t(i)].unit * back;
    for (int k = 0; k < 3; ++k) {
      place[i][k] = float(center[k]);
    }
    for (int k = 0; k < 9; ++k) {
      unit[3 * i + k / 3][k % 3] = float(axes(k / 3, k % 3));
    }
  }
  const Eigen::Vector3d center = X * sun.center;
  const double scale = std::cbrt(std::abs(X.linear().determinant()));
  const float disc[4] = {float(center.x()), float(center.y()), float(center.z()),
                         float(sun.radius * scale)};
  program->SetUniformi("eclipsingCount", count);
  program->SetUniform3fv("eclipsingPlace", SurfaceShaders::MaximumEclipsing, place);
  program->SetUniform3fv("eclipsingUnit", 3 * SurfaceShaders::MaximumEclipsing, unit);
  program->SetUniform4f("sunDisc", disc);
}

void SurfaceShaders::SetShadows(vtkShaderProgram* program, const CascadeFit& fit) const {
  constexpr int Most = ShadowLook::MaximumCascades;
  float place[Most][4] = {};
  float range[Most][2] = {};
  float reaches[Most][3] = {};
  const int count = int(fit.cascades.size());
  for (int k = 0; k < count; ++k) {
    const CascadeFit::Cascade& cascade = fit.cascades[k];
    place[k][0] = float(cascade.center.x());
    place[k][1] = float(cascade.center.y());
    place[k][2] = float(cascade.radius);
    place[k][3] = float(cascade.end);
    range[k][0] = float(cascade.low);
    range[k][1] = float(cascade.high - cascade.low);
    reaches[k][0] = float(fit.Reach(cascade));
    reaches[k][1] = float(fit.Beginning(std::size_t(k)));
    reaches[k][2] = k > 0 ? place[k - 1][3] : -std::numeric_limits<float>::max();
  }
  Eigen::Matrix3f axes = fit.sun.axes.cast<float>(); // column-major, as OpenGL reads it
  program->SetUniformMatrix3x3("sunAxesVC", axes.data());
  program->SetUniform4fv("shadowPlace", count, place);
  program->SetUniform2fv("shadowRange", count, range);
  program->SetUniform3fv("shadowReaches", count, reaches);
  program->SetUniformf("sunRadius", float(std::tan(std::min(fit.sun.radius, 1.5))));
  program->SetUniformi("shadowSize", fit.size);
  program->SetUniformi("groundSize", fit.GroundSize());
  program->SetUniformi("ownGround", -1);
  program->SetUniformi("shadowMaps", ShadowUnit);
  BindTextureUnit(this->Window_, ShadowUnit, GL_TEXTURE_2D_ARRAY, this->ShadowMaps_);
  program->SetUniformi("shadowTops", ShadowUnit + 1);
  BindTextureUnit(this->Window_, ShadowUnit + 1, GL_TEXTURE_2D_ARRAY, this->ShadowTiles_);
}

} // namespace dspace
