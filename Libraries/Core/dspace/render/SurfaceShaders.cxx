#include <dspace/render/SurfaceShaders.h>

#include <algorithm>

#include "vtk_glew.h"

#include "Instance_vert.h"
#include "Label_frag.h"
#include "Screen_vert.h"
#include "Surface_frag.h"

#include "vtkDspaceHubWindow.h"
#include "vtkOpenGLShaderCache.h"
#include "vtkOpenGLState.h"
#include "vtkShaderProgram.h"

#include <dspace/Error.h>

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

unsigned SurfaceShaders::LightFeatures(const DrawList& list) {
  const auto lights = std::min<std::size_t>(list.Lights().size(), MaximumLights);
  unsigned features = Lit | static_cast<unsigned>(lights << LightShift);
  for (std::size_t i = 0; i < lights; ++i) {
    features |= list.Lights()[i].kind == Light::Kind::Directional ? 0u : PlacedLights;
  }
  return features;
}

void SurfaceShaders::Release() {
  this->Surfaces_.clear();
  this->Screens_.clear();
}

vtkShaderProgram* SurfaceShaders::Surface(unsigned features, const ShaderPages& pages) {
  vtkShaderProgram*& program =
      this->Surfaces_[{features, pages.vertex, pages.fragment, pages.defines}];
  if (program) {
    this->Window_->GetShaderCache()->ReadyShaderProgram(program);
    return program;
  }
  std::string defines = pages.defines;
  const auto define = [&](Feature feature, const char* name) {
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
  defines += "#define DSPACE_LIGHT_COUNT " + std::to_string(features >> LightShift) + "\n";
  std::string fragment = WithDefines(features & Label ? Label_frag : Surface_frag, defines);
  Replace(fragment, "//DSPACE::Functions", pages.fragment ? pages.fragment : "");
  program = Ready(this->Window_, WithDefines(pages.vertex ? pages.vertex : Instance_vert, defines),
                  fragment);
  return program;
}

vtkShaderProgram* SurfaceShaders::Screen(const char* fragment, const std::string& defines) {
  vtkShaderProgram*& program = this->Screens_[{fragment, defines}];
  if (program) {
    this->Window_->GetShaderCache()->ReadyShaderProgram(program);
  } else {
    program = Ready(this->Window_, WithDefines(Screen_vert, ""), WithDefines(fragment, defines));
  }
  return program;
}

void SurfaceShaders::SetView(vtkShaderProgram* program, const DrawList& list, const DrawView& view,
                             int samples, bool firstLayer) {
  const Eigen::Matrix4f clip = view.projection.ClipFromView(view.width, view.height).cast<float>();
  Eigen::Matrix4f columns = clip; // column-major, as OpenGL reads it
  program->SetUniformMatrix4x4("VCDCMatrix", columns.data());
  // Of the picture, not of the n x n samples that are drawn of it.
  const float pixel[2] = {2.0f * static_cast<float>(samples) / static_cast<float>(view.width),
                          2.0f * static_cast<float>(samples) / static_cast<float>(view.height)};
  program->SetUniform2f("pixelNDC", pixel);
  program->SetUniformi("colorTexture", ColorUnit);
  program->SetUniformi("opaqueDepth", OpaqueDepthUnit);
  program->SetUniformi("peeledDepth", PeeledDepthUnit);
  program->SetUniformi("firstLayer", firstLayer ? 1 : 0);
  program->SetUniformi("cameraParallel",
                       view.projection.kind == Projection::Kind::Orthographic ? 1 : 0);
  program->SetUniform3f("ambientLight", list.Ambient().data());

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
  for (int i = 0; i < count; ++i) {
    const DrawLight& light = list.Lights()[i];
    kind[i] = static_cast<int>(light.kind);
    cosCone[i] = light.cosCone;
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
}

} // namespace dspace
