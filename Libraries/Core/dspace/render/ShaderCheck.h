// Whether the driver accepts the shader code of an object.
#ifndef DSPACE_RENDER_SHADER_CHECK_H
#define DSPACE_RENDER_SHADER_CHECK_H

#include <string>
#include <vector>

#include <dspace/scene/GraphicsObject.h>

class vtkDspaceHubWindow;

namespace dspace {

// Compiles and links `code` for the meshes of `object`, in colour and in labels. Returns warnings.
// Throws Error(InvalidArgument) naming the object with the driver's messages, and Unsupported for
// an object that is not drawn by the surface shader (labels, terrain that is drawn as a clipmap).
// The context must be current.
std::vector<std::string> CheckShaderCode(vtkDspaceHubWindow* window, const GraphicsObject& object,
                                         const ShaderCode& code);

} // namespace dspace

#endif
