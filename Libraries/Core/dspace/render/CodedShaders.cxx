#include <dspace/render/CodedShaders.h>

#include <regex>
#include <sstream>

#include "CodedLight.h"
#include "CodedTags_frag.h"
#include "CodedTags_vert.h"
#include "Coded_frag.h"
#include "Coded_vert.h"

#include "vtkShaderProgram.h"

#include <dspace/render/SurfaceShaders.h>

namespace dspace {
namespace {

// As vtkShaderProgram::Substitute.
bool Substitute(std::string& text, const std::string& what, const std::string& by, bool all) {
  bool found = false;
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos; at += by.size()) {
    text.replace(at, what.size(), by);
    found = true;
    if (!all) {
      break;
    }
  }
  return found;
}

const char* TypeName(ShaderUniform::Kind kind) {
  switch (kind) {
  case ShaderUniform::Kind::Integer:
    return "int";
  case ShaderUniform::Kind::Float:
    return "float";
  case ShaderUniform::Kind::Vector2:
    return "vec2";
  case ShaderUniform::Kind::Vector3:
    return "vec3";
  case ShaderUniform::Kind::Vector4:
    return "vec4";
  case ShaderUniform::Kind::Matrix3:
    return "mat3";
  case ShaderUniform::Kind::Matrix4:
    return "mat4";
  }
  return "";
}

std::string LightNames() {
  std::string text;
  for (int i = 0; i < SurfaceShaders::MaximumLights; ++i) {
    std::string names = CodedLight;
    Substitute(names, "{N}", std::to_string(i), true);
    text += names;
  }
  return text;
}

class Stage {
public:
  Stage(ShaderReplacement::Stage kind, const char* text) : Kind_(kind), Text_(text) {}

  void Replace(const ShaderCode& code, bool first, std::vector<std::string>& unused) {
    for (const ShaderReplacement& replacement : code.replacements) {
      if (replacement.stage == this->Kind_ && replacement.replaceFirst == first &&
          !Substitute(this->Text_, replacement.original, replacement.replacement,
                      replacement.replaceAll)) {
        unused.push_back(replacement.original);
      }
    }
  }

  // `sections`: each begins with the line of its tag, and is inserted in front of the tag.
  void Fill(const char* sections) {
    std::istringstream lines(sections);
    std::string tag;
    std::string code;
    const auto fill = [&] {
      if (!tag.empty()) {
        // Code of the user may end before the tag without a new line.
        Substitute(this->Text_, tag, "\n" + code + tag, true);
      }
    };
    for (std::string line; std::getline(lines, line);) {
      if (line.rfind("//VTK::", 0) == 0) {
        fill();
        tag = line;
        code.clear();
      } else {
        code += line + "\n";
      }
    }
    fill();
  }

  // Declares those that the code of this stage does not declare itself.
  void Declare(const ShaderCode& code) {
    std::string text;
    for (const ShaderUniform& uniform : code.uniforms) {
      const std::regex declared("\\buniform\\s+(\\w+\\s+)*" + uniform.name + "\\b");
      if (!std::regex_search(this->Text_, declared)) {
        text += std::string("uniform ") + TypeName(uniform.kind) + " " + uniform.name +
                (uniform.count > 1 ? "[" + std::to_string(uniform.count) + "]" : "") + ";\n";
      }
    }
    Substitute(this->Text_, "//VTK::CustomUniforms::Dec", text + "//VTK::CustomUniforms::Dec",
               false);
  }

  std::string& Text() { return this->Text_; }

private:
  ShaderReplacement::Stage Kind_;
  std::string Text_;
};

} // namespace

CodedSources SourcesOf(const ShaderCode& code) {
  CodedSources made;
  Stage vertex(ShaderReplacement::Stage::Vertex, Coded_vert);
  Stage fragment(ShaderReplacement::Stage::Fragment, Coded_frag);
  for (Stage* stage : {&vertex, &fragment}) {
    stage->Replace(code, true, made.unused);
    stage->Declare(code);
  }
  vertex.Fill(CodedTags_vert);
  fragment.Fill(CodedTags_frag);
  Substitute(fragment.Text(), "//VTK::Light::Dec", LightNames() + "//VTK::Light::Dec", true);
  for (Stage* stage : {&vertex, &fragment}) {
    stage->Replace(code, false, made.unused);
  }
  for (Stage* stage : {&vertex, &fragment}) {
    Substitute(stage->Text(), "//VTK::System::Dec", "", true); // VTK would put its version there
  }
  Substitute(fragment.Text(), "gl_FragData[0]", "fragOutput0", true);
  made.vertex = vertex.Text();
  made.fragment = fragment.Text();
  return made;
}

void SetCodeUniforms(vtkShaderProgram* program, const ShaderCode& code) {
  for (const ShaderUniform& uniform : code.uniforms) {
    const char* name = uniform.name.c_str();
    std::vector<float> values(uniform.values.begin(), uniform.values.end());
    switch (uniform.kind) {
    case ShaderUniform::Kind::Integer: {
      const std::vector<int> integers(uniform.values.begin(), uniform.values.end());
      program->SetUniform1iv(name, uniform.count, integers.data());
      break;
    }
    case ShaderUniform::Kind::Float:
      program->SetUniform1fv(name, uniform.count, values.data());
      break;
    case ShaderUniform::Kind::Vector2:
      program->SetUniform2fv(name, uniform.count, reinterpret_cast<float(*)[2]>(values.data()));
      break;
    case ShaderUniform::Kind::Vector3:
      program->SetUniform3fv(name, uniform.count, reinterpret_cast<float(*)[3]>(values.data()));
      break;
    case ShaderUniform::Kind::Vector4:
      program->SetUniform4fv(name, uniform.count, reinterpret_cast<float(*)[4]>(values.data()));
      break;
    case ShaderUniform::Kind::Matrix3:
      program->SetUniformMatrix3x3(name, values.data());
      break;
    case ShaderUniform::Kind::Matrix4:
      program->SetUniformMatrix4x4v(name, uniform.count, values.data());
      break;
    }
  }
}

} // namespace dspace
