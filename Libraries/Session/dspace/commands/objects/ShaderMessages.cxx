#include <dspace/commands/objects/ShaderMessages.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include <dspace/Checks.h>

namespace dspace::session {
namespace {

using Kind = ShaderUniform::Kind;

constexpr std::uint32_t MostElements = 1024;

struct KindOfUniform {
  v1::SetShader::Uniform::Type type;
  Kind kind;
  int numbers;
};
constexpr std::array<KindOfUniform, 7> Kinds = {{
    {v1::SetShader::Uniform::FLOAT, Kind::Float, 1},
    {v1::SetShader::Uniform::INTEGER, Kind::Integer, 1},
    {v1::SetShader::Uniform::VECTOR2, Kind::Vector2, 2},
    {v1::SetShader::Uniform::VECTOR3, Kind::Vector3, 3},
    {v1::SetShader::Uniform::VECTOR4, Kind::Vector4, 4},
    {v1::SetShader::Uniform::MATRIX3, Kind::Matrix3, 9},
    {v1::SetShader::Uniform::MATRIX4, Kind::Matrix4, 16},
}};

bool IsIdentifier(const std::string& name) {
  const auto letter = [](char c) {
    return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_';
  };
  const auto good = [&](char c) { return letter(c) || (c >= '0' && c <= '9'); };
  return !name.empty() && name.size() <= 255 && letter(name[0]) &&
         std::all_of(name.begin(), name.end(), good);
}

ShaderUniform ToUniform(const v1::SetShader::Uniform& from, const std::string& object) {
  const std::string& name = from.name();
  if (!IsIdentifier(name) || name.rfind("gl_", 0) == 0 || name.rfind("dspace", 0) == 0 ||
      name.find("__") != std::string::npos) {
    Reject(object, "a uniform's name is '" + name +
                       "'; accepted: letters, digits and _, not beginning with a digit, \"gl_\" or "
                       "\"dspace\", without \"__\"");
  }
  const std::string what = object + ", uniform '" + name + "'";
  const auto* kind = std::find_if(Kinds.begin(), Kinds.end(), [&](const KindOfUniform& each) {
    return each.type == from.type();
  });
  if (kind == Kinds.end()) {
    Reject(what, "its type is " + std::to_string(from.type()) + "; accepted: 0 to 6");
  }
  const std::uint32_t count = std::max(1u, from.count());
  if (count > MostElements || (count > 1 && kind->kind == Kind::Matrix3)) {
    Reject(what, "it has " + std::to_string(count) +
                     " elements; accepted: up to 1024, of 3 x 3 matrices 1");
  }
  if (std::uint64_t(from.value_size()) != std::uint64_t(count) * std::uint64_t(kind->numbers)) {
    Reject(what, "it has " + std::to_string(from.value_size()) +
                     " numbers; accepted: " + std::to_string(kind->numbers) + " for each of its " +
                     std::to_string(count) + " elements");
  }
  for (const double value : from.value()) {
    if (kind->kind == Kind::Integer) {
      Require(value == std::floor(value) && std::abs(value) <= 2147483647.0, what, "a value", value,
              "an integer of 32 bits");
    } else {
      Require(std::abs(value) <= double(std::numeric_limits<float>::max()), what, "a value", value,
              "a finite float");
    }
  }
  return {name, kind->kind, int(count), {from.value().begin(), from.value().end()}};
}

} // namespace

std::shared_ptr<const ShaderCode> ToShaderCode(const v1::SetShader& from,
                                               const std::string& object) {
  if (from.replacement_size() == 0 && from.uniform_size() == 0) {
    return nullptr;
  }
  auto made = std::make_shared<ShaderCode>();
  for (const v1::SetShader::Replacement& each : from.replacement()) {
    if (each.original().empty()) {
      Reject(object,
             "a replacement of its shader has no tag; accepted: \"//VTK::Color::Impl\", ...");
    }
    if (each.stage() != v1::SetShader::Replacement::VERTEX &&
        each.stage() != v1::SetShader::Replacement::FRAGMENT) {
      Reject(object, "a replacement of its shader has stage " + std::to_string(each.stage()) +
                         "; accepted: 0 (vertex), 1 (fragment)");
    }
    ShaderReplacement replacement;
    replacement.stage = each.stage() == v1::SetShader::Replacement::VERTEX
                            ? ShaderReplacement::Stage::Vertex
                            : ShaderReplacement::Stage::Fragment;
    replacement.original = each.original();
    replacement.replaceFirst = !each.after();
    replacement.replacement = each.replacement();
    replacement.replaceAll = !each.first_only();
    made->replacements.push_back(std::move(replacement));
  }
  std::set<std::string> names;
  for (const v1::SetShader::Uniform& each : from.uniform()) {
    made->uniforms.push_back(ToUniform(each, object));
    if (!names.insert(each.name()).second) {
      Reject(object, "its shader has two uniforms '" + each.name() + "'; accepted: each name once");
    }
  }
  return made;
}

void PutShader(const ShaderCode& from, v1::SetShader* to) {
  for (const ShaderReplacement& each : from.replacements) {
    v1::SetShader::Replacement* replacement = to->add_replacement();
    replacement->set_stage(each.stage == ShaderReplacement::Stage::Vertex
                               ? v1::SetShader::Replacement::VERTEX
                               : v1::SetShader::Replacement::FRAGMENT);
    replacement->set_original(each.original);
    replacement->set_after(!each.replaceFirst);
    replacement->set_replacement(each.replacement);
    replacement->set_first_only(!each.replaceAll);
  }
  for (const ShaderUniform& each : from.uniforms) {
    v1::SetShader::Uniform* uniform = to->add_uniform();
    uniform->set_name(each.name);
    for (const KindOfUniform& kind : Kinds) {
      if (kind.kind == each.kind) {
        uniform->set_type(kind.type);
      }
    }
    uniform->set_count(each.count > 1 ? std::uint32_t(each.count) : 0);
    uniform->mutable_value()->Add(each.values.begin(), each.values.end());
  }
}

bool HaveSamePrograms(const ShaderCode& a, const ShaderCode& b) {
  return std::equal(a.replacements.begin(), a.replacements.end(), b.replacements.begin(),
                    b.replacements.end(),
                    [](const ShaderReplacement& x, const ShaderReplacement& y) {
                      return x.stage == y.stage && x.original == y.original &&
                             x.replaceFirst == y.replaceFirst && x.replacement == y.replacement &&
                             x.replaceAll == y.replaceAll;
                    }) &&
         std::equal(a.uniforms.begin(), a.uniforms.end(), b.uniforms.begin(), b.uniforms.end(),
                    [](const ShaderUniform& x, const ShaderUniform& y) {
                      return x.name == y.name && x.kind == y.kind && x.count == y.count;
                    });
}

} // namespace dspace::session
