#include "VtkShaderCode.h"

#include <set>
#include <string>
#include <vector>

#include <dspace/Error.h>

#include "vtkShaderProperty.h"
#include "vtkUniforms.h"

namespace dspace::session {
namespace {

using Uniform = v1::SetShader::Uniform;

[[noreturn]] void Refuse(const std::string& message) {
  throw Error(Error::Kind::Unsupported, "shader", message);
}

void Put(Uniform* to, Uniform::Type type, int tuples, const std::vector<float>& values) {
  to->set_type(type);
  to->set_count(tuples > 1 ? std::uint32_t(tuples) : 0);
  to->mutable_value()->Add(values.begin(), values.end());
}

void PutUniform(vtkUniforms* from, const std::string& given, Uniform* to) {
  const char* name = given.c_str();
  to->set_name(given);
  const int tuples = from->GetUniformNumberOfTuples(name);
  const int components = from->GetUniformNumberOfComponents(name);
  const bool integers = from->GetUniformScalarType(name) == VTK_INT;
  std::vector<float> values(static_cast<std::size_t>(tuples * components));
  switch (from->GetUniformTupleType(name)) {
  case vtkUniforms::TupleTypeScalar:
    if (integers) {
      std::vector<int> numbers(values.size());
      if (tuples > 1 || !from->GetUniformi(name, numbers[0])) {
        from->GetUniform1iv(name, numbers);
      }
      Put(to, Uniform::INTEGER, tuples, {numbers.begin(), numbers.end()});
      to->clear_value(); // floats hold 24 bits
      to->mutable_value()->Add(numbers.begin(), numbers.end());
      return;
    }
    if (tuples > 1 || !from->GetUniformf(name, values[0])) {
      from->GetUniform1fv(name, values);
    }
    Put(to, Uniform::FLOAT, tuples, values);
    return;
  case vtkUniforms::TupleTypeVector:
    if (integers) {
      Refuse("uniform '" + given +
             "' is a vector of integers; accepted: integers, floats, vectors "
             "and matrices of floats");
    }
    if (components == 2) {
      if (tuples > 1 || !from->GetUniform2f(name, values.data())) {
        from->GetUniform2fv(name, values);
      }
    } else if (components == 3) {
      if (tuples > 1 || !from->GetUniform3f(name, values.data())) {
        from->GetUniform3fv(name, values);
      }
    } else {
      if (tuples > 1 || !from->GetUniform4f(name, values.data())) {
        from->GetUniform4fv(name, values);
      }
    }
    Put(to,
        components == 2   ? Uniform::VECTOR2
        : components == 3 ? Uniform::VECTOR3
                          : Uniform::VECTOR4,
        tuples, values);
    return;
  case vtkUniforms::TupleTypeMatrix:
    if (components == 9) {
      from->GetUniformMatrix3x3(name, values.data());
    } else if (tuples > 1 || !from->GetUniformMatrix4x4(name, values.data())) {
      from->GetUniformMatrix4x4v(name, values);
    }
    Put(to, components == 9 ? Uniform::MATRIX3 : Uniform::MATRIX4, tuples, values);
    return;
  default:
    Refuse("uniform '" + given + "' has no value");
  }
}

} // namespace

v1::SetShader ToSetShader(vtkShaderProperty* property) {
  if (property->HasVertexShaderCode() || property->HasFragmentShaderCode() ||
      property->HasGeometryShaderCode()) {
    Refuse("it replaces a whole shader; accepted: replacements at the tags, as "
           "AddFragmentShaderReplacement makes them");
  }
  v1::SetShader made;
  for (int i = 0; i < property->GetNumberOfShaderReplacements(); ++i) {
    const std::string stage = property->GetNthShaderReplacementTypeAsString(i);
    if (stage != "Vertex" && stage != "Fragment") {
      Refuse("it has a replacement in the " + stage +
             " shader; accepted: vertex and fragment shaders");
    }
    std::string original;
    std::string replacement;
    bool first = true;
    bool all = true;
    property->GetNthShaderReplacement(i, original, first, replacement, all);
    v1::SetShader::Replacement* to = made.add_replacement();
    to->set_stage(stage == "Vertex" ? v1::SetShader::Replacement::VERTEX
                                    : v1::SetShader::Replacement::FRAGMENT);
    to->set_original(original);
    to->set_after(!first);
    to->set_replacement(replacement);
    to->set_first_only(!all);
  }
  std::set<std::string> names; // a uniform of both shaders is one
  for (vtkUniforms* uniforms :
       {property->GetVertexCustomUniforms(), property->GetFragmentCustomUniforms()}) {
    for (int i = 0; i < uniforms->GetNumberOfUniforms(); ++i) {
      const std::string name = uniforms->GetNthUniformName(i);
      if (names.insert(name).second) {
        PutUniform(uniforms, name, made.add_uniform());
      }
    }
  }
  return made;
}

} // namespace dspace::session
