// Code of a user in the surface shader of an object.
#ifndef DSPACE_SCENE_SHADER_CODE_H
#define DSPACE_SCENE_SHADER_CODE_H

#include <string>
#include <vector>

namespace dspace {

// Replaces a tag of the shader by code, as vtkShaderProperty does. The tags are VTK's:
// "//VTK::Color::Impl", "//VTK::Normal::Impl", "//VTK::PositionVC::Impl", ...
struct ShaderReplacement {
  enum class Stage { Vertex, Fragment };
  Stage stage = Stage::Fragment;
  std::string original;
  bool replaceFirst = true; // before the shader's own code goes in at the tags, else after
  std::string replacement;
  bool replaceAll = true; // else the first occurrence only
};

// A uniform that the code declares. The number of values and `kind` give its type.
struct ShaderUniform {
  enum class Kind { Integer, Float, Vector2, Vector3, Vector4, Matrix3, Matrix4 };
  std::string name;
  Kind kind = Kind::Float;
  int count = 1;              // elements of an array
  std::vector<double> values; // `count` times 1, 1, 2, 3, 4, 9 or 16; matrices column by column
};

struct ShaderCode {
  std::vector<ShaderReplacement> replacements; // in their order
  std::vector<ShaderUniform> uniforms;
};

} // namespace dspace

#endif
