// Programs of objects with shader code of their own: VTK's tags with replacements.
#ifndef DSPACE_RENDER_CODED_SHADERS_H
#define DSPACE_RENDER_CODED_SHADERS_H

#include <string>
#include <vector>

#include <dspace/scene/GraphicsObject.h>

class vtkShaderProgram;

namespace dspace {

// Sources of a program, without its defines.
struct CodedSources {
  std::string vertex;
  std::string fragment;
  std::vector<std::string> unused; // tags of replacements that are nowhere in their stage
};

// As vtkOpenGLPolyDataMapper does: replacements that come first, then what stands at the tags
// otherwise, then the other replacements.
CodedSources SourcesOf(const ShaderCode& code);

// Into the program that is in use. A uniform that it does not use is ignored.
void SetCodeUniforms(vtkShaderProgram* program, const ShaderCode& code);

} // namespace dspace

#endif
