#include <dspace/render/ShaderCheck.h>

#include <cstdlib>
#include <memory>
#include <regex>
#include <set>

#include "vtk_glew.h"

#include "vtkDspaceHubWindow.h"

#include <dspace/Error.h>
#include <dspace/render/CodedShaders.h>
#include <dspace/render/SurfaceShaders.h>
#include <dspace/scene/PartLook.h>

namespace dspace {
namespace {

// An object of OpenGL.
class GlName {
public:
  GlName(GLuint name, void (*free)(GLuint)) : Name_(name), Free_(free) {}
  GlName(const GlName&) = delete;
  GlName& operator=(const GlName&) = delete;
  ~GlName() { this->Free_(this->Name_); }
  operator GLuint() const { return this->Name_; }

private:
  GLuint Name_;
  void (*Free_)(GLuint);
};

void FreeShader(GLuint name) {
  glDeleteShader(name);
}

void FreeProgram(GLuint name) {
  glDeleteProgram(name);
}

std::string LineOf(const std::string& text, int number) {
  std::size_t at = 0;
  for (int i = 1; i < number && at != std::string::npos; ++i) {
    at = text.find('\n', at);
    at = at == std::string::npos ? at : at + 1;
  }
  return at == std::string::npos ? "" : text.substr(at, text.find('\n', at) - at);
}

// The driver's messages, and the line that the first of them names.
std::string Message(const std::string& log, const std::string& source) {
  std::string text = log;
  while (!text.empty() && (text.back() == '\n' || text.back() == '\0')) {
    text.pop_back();
  }
  std::smatch place;
  if (std::regex_search(text, place, std::regex("0[:(](\\d+)[(:)]"))) {
    text += "; line " + place.str(1) + " is: " + LineOf(source, std::atoi(place.str(1).c_str()));
  }
  return text;
}

[[noreturn]] void Fail(const std::string& object, const std::string& what,
                       const std::string& message) {
  throw Error(Error::Kind::InvalidArgument, object,
              "the driver rejects its " + what + ": " + message);
}

void Compile(GLuint shader, const std::string& text, const std::string& object, const char* stage) {
  const char* source = text.c_str();
  glShaderSource(shader, 1, &source, nullptr);
  glCompileShader(shader);
  GLint good = 0;
  glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
  if (!good) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(std::size_t(length) + 1, '\0');
    glGetShaderInfoLog(shader, length, nullptr, &log[0]);
    Fail(object, std::string(stage) + " shader", Message(log.c_str(), text));
  }
}

void CompileProgram(const SurfaceShaders::Sources& sources, const std::string& object) {
  const GlName vertex(glCreateShader(GL_VERTEX_SHADER), FreeShader);
  const GlName fragment(glCreateShader(GL_FRAGMENT_SHADER), FreeShader);
  Compile(vertex, sources.vertex, object, "vertex");
  Compile(fragment, sources.fragment, object, "fragment");
  const GlName program(glCreateProgram(), FreeProgram);
  glAttachShader(program, vertex);
  glAttachShader(program, fragment);
  glLinkProgram(program);
  GLint good = 0;
  glGetProgramiv(program, GL_LINK_STATUS, &good);
  if (!good) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(std::size_t(length) + 1, '\0');
    glGetProgramInfoLog(program, length, nullptr, &log[0]);
    Fail(object, "program", Message(log.c_str(), ""));
  }
}

} // namespace

std::vector<std::string> CheckShaderCode(vtkDspaceHubWindow* window, const GraphicsObject& object,
                                         const ShaderCode& code) {
  const std::string label = "object '" + object.name + "'";
  if (object.custom || object.billboard) {
    throw Error(Error::Kind::Unsupported, label,
                "it takes no shader code; accepted: an object of meshes");
  }
  SurfaceShaders shaders(window);
  const auto shared = std::make_shared<const ShaderCode>(code);
  std::set<SurfaceShaders::Features> checked;
  const auto check = [&](SurfaceShaders::Features features) {
    if (checked.insert(features).second) {
      CompileProgram(shaders.SourcesFor(features, {}, shared.get()), label);
    }
  };
  for (const DetailLevel& level : object.levels) {
    for (const Part& part : level.parts) {
      const Material look = LookOf(object, part);
      const SurfaceShaders::Features plain =
          SurfaceShaders::CodeFeatures(*part.mesh, look.texture != nullptr);
      const SurfaceShaders::Features lit =
          look.lit ? SurfaceShaders::Lit | SurfaceShaders::Specular | SurfaceShaders::PlacedLights |
                         (1u << SurfaceShaders::LightShift)
                   : 0u;
      check(plain | lit);
      check(plain | lit | SurfaceShaders::Peel);
      check(plain | SurfaceShaders::Label);
    }
  }
  std::vector<std::string> warnings;
  for (const std::string& tag : SourcesOf(code).unused) {
    warnings.push_back(label + ": the shader does not contain '" + tag +
                       "'; its replacement has no effect");
  }
  return warnings;
}

} // namespace dspace
